//! Settings as a JSON Schema, for editors of TOML files.

use crate::{Description, Kind, Range, Rule, Setting};
use serde_json::{Map, Value, json};

const DRAFT: &str = "https://json-schema.org/draft/2020-12/schema";

impl Description {
    /// A JSON Schema of the file. Rules on several settings at once stand in the descriptions only.
    pub fn json_schema(&self, title: &str) -> Value {
        let mut schema = json!({
            "$schema": DRAFT,
            "title": title,
            "type": "object",
            "additionalProperties": false,
            "properties": {},
        });
        for section in &self.sections {
            let inner = json!({
                "description": section.meaning,
                "type": "object",
                "additionalProperties": false,
                "properties": {},
            });
            insert(&mut schema, &section.path, inner);
        }
        for setting in &self.settings {
            insert(&mut schema, &setting.path, of(setting));
        }
        schema
    }
}

fn insert(schema: &mut Value, path: &str, inner: Value) {
    let properties = &mut schema["properties"];
    match path.split_once('.') {
        Some((section, rest)) => insert(&mut properties[section], rest, inner),
        None => properties[path] = inner,
    }
}

fn of(setting: &Setting) -> Value {
    let mut schema = match setting.kind {
        Kind::Flag => Map::from_iter([("type".to_owned(), json!("boolean"))]),
        Kind::Count => number("integer", setting.rule.range(), true),
        Kind::Number => number("number", setting.rule.range(), false),
        Kind::Numbers(length) => Map::from_iter([
            ("type".to_owned(), json!("array")),
            ("minItems".to_owned(), json!(length)),
            ("maxItems".to_owned(), json!(length)),
            (
                "items".to_owned(),
                number("number", setting.rule.range(), false).into(),
            ),
        ]),
        Kind::Choice(choices) => {
            let one = |c: &crate::Choice| json!({"const": c.name, "description": c.meaning()});
            let all: Vec<Value> = choices.iter().map(one).collect();
            Map::from_iter([("oneOf".to_owned(), all.into())])
        }
    };
    let mut description = format!("{} Unit: {}.", setting.meaning, setting.unit);
    let in_words = setting.relations.clone();
    let own = match setting.rule {
        Rule::Unit | Rule::Norm(_) => Some(setting.rule.to_string()),
        Rule::Any | Rule::Numbers(_) => None,
    };
    let in_words: Vec<String> = own.into_iter().chain(in_words).collect();
    if !in_words.is_empty() {
        description = format!("{description} It must be {}.", in_words.join(", and "));
    }
    schema.insert("description".to_owned(), description.into());
    if let Some(default) = setting.default.clone() {
        // TOML's numbers, words, flags and lists are those of JSON.
        let default = serde_json::to_value(default).unwrap_or_default();
        schema.insert("default".to_owned(), default);
    }
    schema.into()
}

fn number(kind: &str, range: Option<Range>, count: bool) -> Map<String, Value> {
    let mut schema = Map::from_iter([("type".to_owned(), json!(kind))]);
    let bound = |x: f64| {
        if x.fract() == 0.0 {
            json!(x as i64)
        } else {
            json!(x)
        }
    };
    if let Some(range) = range {
        if let Some(least) = range.lower() {
            let name = if range.least_allowed {
                "minimum"
            } else {
                "exclusiveMinimum"
            };
            schema.insert(name.to_owned(), bound(least));
        }
        if let Some(most) = range.upper() {
            let name = if range.most_allowed {
                "maximum"
            } else {
                "exclusiveMaximum"
            };
            schema.insert(name.to_owned(), bound(most));
        }
    }
    if count && !schema.contains_key("minimum") {
        schema.insert("minimum".to_owned(), json!(0));
    }
    schema
}
