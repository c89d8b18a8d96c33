//! JSON as it is shown: keys in their order, numbers rounded, what is long or differs from run to run left out.

use super::directive::Directive;
use anyhow::{Context, Result};
use serde::{
    Deserialize, Deserializer,
    de::{MapAccess, SeqAccess, Visitor},
};
use serde_json::Value;
use std::fmt;

/// Columns within which an object or an array stays in one line.
const WIDTH: usize = 110;
/// Stands for what is left out.
const LEFT_OUT: &str = "…";
/// Objects of times, which no two runs print alike.
const TIMES: &str = "timing_ms";

/// A value whose keys keep their order.
enum Json {
    Object(Vec<(String, Json)>),
    Array(Vec<Json>),
    Other(Value),
}

/// The part of the text that the directive asks for.
pub(super) fn shown(text: &str, directive: &Directive) -> Result<String> {
    let mut json: Json = serde_json::from_str(text)?;
    if let Some(pointer) = &directive.pointer {
        json = json
            .at(pointer)
            .with_context(|| format!("nothing at `{pointer}`"))?;
    }
    let mut shown = String::new();
    json.show(directive, 0, &mut shown);
    Ok(shown)
}

impl Json {
    fn at(self, pointer: &str) -> Option<Self> {
        let mut json = self;
        for key in pointer.split('/').skip(1) {
            json = match json {
                Self::Object(members) => members.into_iter().find(|(k, _)| k == key)?.1,
                Self::Array(items) => items.into_iter().nth(key.parse().ok()?)?,
                Self::Other(_) => return None,
            };
        }
        Some(json)
    }

    /// Appends it, in one line if that is short enough.
    fn show(&self, directive: &Directive, indent: usize, shown: &mut String) {
        let line = self.line(directive);
        let items: Vec<(Option<&str>, &Self)> = match self {
            _ if indent + line.chars().count() <= WIDTH => Vec::new(),
            Self::Object(members) => members
                .iter()
                .map(|(key, value)| (Some(key.as_str()), value))
                .collect(),
            Self::Array(items) => items.iter().map(|item| (None, item)).collect(),
            Self::Other(_) => Vec::new(),
        };
        if items.is_empty() {
            *shown += &line;
            return;
        }
        let (open, close) = self.brackets();
        let inner = indent + 2;
        *shown += open;
        for (i, (key, value)) in items.into_iter().enumerate() {
            *shown += if i == 0 { "\n" } else { ",\n" };
            *shown += &" ".repeat(inner);
            if let Some(key) = key {
                shown.extend(["\"", key, "\": "]);
            }
            if key.is_some_and(|key| is_omitted(key, directive)) {
                *shown += &value.mark();
            } else {
                value.show(directive, inner, shown);
            }
        }
        shown.extend(["\n", &" ".repeat(indent), close]);
    }

    fn line(&self, directive: &Directive) -> String {
        match self {
            Self::Object(members) => {
                let member = |(key, value): &(String, Self)| {
                    let value = if is_omitted(key, directive) {
                        value.mark()
                    } else {
                        value.line(directive)
                    };
                    format!("\"{key}\": {value}")
                };
                let members: Vec<String> = members.iter().map(member).collect();
                format!("{{ {} }}", members.join(", "))
            }
            Self::Array(items) => {
                let items: Vec<String> = items.iter().map(|item| item.line(directive)).collect();
                format!("[{}]", items.join(", "))
            }
            Self::Other(value) => rounded(value, directive.digits),
        }
    }

    /// What is shown in place of it.
    fn mark(&self) -> String {
        let (open, close) = self.brackets();
        format!("{open}{LEFT_OUT}{close}")
    }

    fn brackets(&self) -> (&'static str, &'static str) {
        match self {
            Self::Object(_) => ("{", "}"),
            Self::Array(_) => ("[", "]"),
            Self::Other(_) => ("", ""),
        }
    }
}

fn is_omitted(key: &str, directive: &Directive) -> bool {
    key == TIMES || directive.omit.iter().any(|omitted| omitted == key)
}

/// The value, a number that is no integer to so many significant digits.
fn rounded(value: &Value, digits: Option<usize>) -> String {
    let number = value.as_f64().filter(|_| value.is_f64()).zip(digits);
    let Some((number, digits)) = number else {
        return value.to_string();
    };
    let whole = number.abs().log10().floor().max(-300.0) as i32 + 1;
    let decimals = usize::try_from(digits as i32 - whole).unwrap_or(0);
    format!("{number:.decimals$}")
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(InOrder)
    }
}

struct InOrder;

impl<'de> Visitor<'de> for InOrder {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Json, A::Error> {
        let mut members = Vec::new();
        while let Some(member) = map.next_entry()? {
            members.push(member);
        }
        Ok(Json::Object(members))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut array: A) -> Result<Json, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = array.next_element()? {
            items.push(item);
        }
        Ok(Json::Array(items))
    }

    fn visit_bool<E>(self, value: bool) -> Result<Json, E> {
        Ok(Json::Other(value.into()))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Json, E> {
        Ok(Json::Other(value.into()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Json, E> {
        Ok(Json::Other(value.into()))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Json, E> {
        Ok(Json::Other(value.into()))
    }

    fn visit_str<E>(self, value: &str) -> Result<Json, E> {
        Ok(Json::Other(value.into()))
    }

    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json::Other(Value::Null))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RECORD: &str = r#"{"picks": [{"id": 3, "box": {"x_min": 167.912345, "name": "3"},
        "radius": 0.000146734, "candidates": [1, 2], "timing_ms": {"total": 1.5}, "none": null}]}"#;

    fn directive(options: &str) -> Directive {
        Directive::parse(&format!("pomona{options}")).unwrap()
    }

    #[test]
    fn keys_keep_their_order_and_times_are_left_out() {
        let shown = shown(
            RECORD,
            &directive("; at /picks/0; digits 3; omit candidates"),
        )
        .unwrap();
        assert_eq!(
            shown,
            "{\n  \"id\": 3,\n  \"box\": { \"x_min\": 168, \"name\": \"3\" },\n  \"radius\": 0.000147,\n  \
             \"candidates\": […],\n  \"timing_ms\": {…},\n  \"none\": null\n}"
        );
        assert!(super::shown(RECORD, &directive("; at /picks/1")).is_err());
    }

    #[test]
    fn what_is_too_wide_is_broken_at_its_members() {
        let wide = format!(
            "{{\"a\": [{}], \"b\": {{\"c\": 1}}}}",
            vec!["0.5"; 30].join(", ")
        );
        let shown = shown(&wide, &directive("")).unwrap();
        assert!(
            shown.starts_with("{\n  \"a\": [\n    0.5,\n    0.5"),
            "{shown}"
        );
        assert!(
            shown.ends_with("    0.5\n  ],\n  \"b\": { \"c\": 1 }\n}"),
            "{shown}"
        );
    }
}
