//! The JSON Schema of `picks.json`, made from the types of the record and compared with the copy in `docs/`.

use super::PicksRecord;
use pomona_approach::Stage;
use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::path::Path;

/// Set, the test writes the schema in place of comparing it.
const UPDATE: &str = "UPDATE_SCHEMAS";

/// How far a component of a unit vector may leave -1 to 1 by rounding.
const UNIT: f64 = 1.000_001;

/// Three components of length 1.
pub(super) struct UnitVector;

impl JsonSchema for UnitVector {
    fn schema_name() -> Cow<'static, str> {
        "UnitVector".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A vector of length 1.", "type": "array", "minItems": 3, "maxItems": 3,
            "items": { "type": "number", "minimum": -UNIT, "maximum": UNIT }
        })
    }
}

/// A rotation as x y z w.
pub(super) struct UnitQuaternion;

impl JsonSchema for UnitQuaternion {
    fn schema_name() -> Cow<'static, str> {
        "UnitQuaternion".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A rotation, x y z w.", "type": "array", "minItems": 4, "maxItems": 4,
            "items": { "type": "number", "minimum": -UNIT, "maximum": UNIT }
        })
    }
}

/// Which part of a path.
pub(super) struct StageName;

impl JsonSchema for StageName {
    fn schema_name() -> Cow<'static, str> {
        "StageName".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let names = [Stage::Transit, Stage::Approach, Stage::Retreat].map(Stage::name);
        json_schema!({ "description": "Part of a path.", "enum": names })
    }
}

/// Takes out what says nothing about the files: that absent values could be null, Rust's number formats, line breaks
/// and links of the doc comments.
fn plain(schema: &mut Schema) {
    let Some(object) = schema.as_object_mut() else {
        return;
    };
    object.remove("format");
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|t| t != "null");
        if let [one] = &types[..] {
            let one = one.clone();
            object.insert("type".to_owned(), one);
        }
    }
    if let Some(Value::Array(kinds)) = object.get_mut("anyOf") {
        kinds.retain(|kind| kind != &json!({"type": "null"}));
        if let [Value::Object(one)] = &kinds[..] {
            let one = one.clone();
            object.remove("anyOf");
            object.extend(one);
        }
    }
    if let Some(Value::String(text)) = object.get_mut("description") {
        *text = text.replace('\n', " ").replace(['`', '[', ']'], "");
    }
}

fn schema() -> Value {
    let generator = SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator();
    let mut schema = generator.into_root_schema_for::<PicksRecord>();
    RecursiveTransform(plain).transform(&mut schema);
    schema.insert("title".to_owned(), json!(super::SCHEMA));
    let id = "https://github.com/pomona-rs/pomona/blob/main/docs/picks.schema.json";
    schema.insert("$id".to_owned(), json!(id));
    schema.to_value()
}

#[test]
fn the_schema_in_the_docs_is_that_of_the_types() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/picks.schema.json");
    let made = schema();
    if std::env::var_os(UPDATE).is_some() {
        let text = serde_json::to_string_pretty(&made).unwrap() + "\n";
        std::fs::write(&path, text).unwrap();
        return;
    }
    let kept: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    assert!(
        kept == made,
        "{}: not what the types say; run the test again with {UPDATE}=1 and look at the difference",
        path.display()
    );
}
