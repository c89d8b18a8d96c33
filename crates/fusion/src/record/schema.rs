//! The JSON Schema of `fused.json`, made from the types of the record and compared with the copy in `docs/`.

use super::{FUSED_SCHEMA, FusedRecord};
use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::Value;
use std::path::Path;

/// Set, the test writes the schema in place of comparing it.
const UPDATE: &str = "UPDATE_SCHEMAS";

/// Rounding may take a component of a unit vector this far outside -1 to 1.
const LARGEST_COMPONENT: f64 = 1.000_001;

fn components(count: usize) -> Schema {
    json_schema!({
        "type": "array",
        "minItems": count,
        "maxItems": count,
        "items": {"type": "number", "minimum": -LARGEST_COMPONENT, "maximum": LARGEST_COMPONENT}
    })
}

pub(super) fn unit_vector(_: &mut SchemaGenerator) -> Schema {
    components(3)
}

pub(super) fn unit_vectors(_: &mut SchemaGenerator) -> Schema {
    json_schema!({"type": "array", "items": components(3)})
}

pub(super) fn quaternion(_: &mut SchemaGenerator) -> Schema {
    components(4)
}

/// Takes out what says nothing about the file: Rust's number formats, and the marks and line breaks of doc comments.
fn plain(schema: &mut Schema) {
    schema.remove("format");
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = text.replace('\n', " ").replace(['`', '[', ']'], "");
    }
}

fn schema() -> Value {
    let generator = SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator();
    let mut schema = generator.into_root_schema_for::<FusedRecord>();
    RecursiveTransform(plain).transform(&mut schema);
    schema.insert("title".into(), FUSED_SCHEMA.into());
    let id = "https://github.com/pomona-rs/pomona/blob/main/docs/fused.schema.json";
    schema.insert("$id".into(), id.into());
    schema.to_value()
}

#[test]
fn the_schema_in_the_docs_is_that_of_the_types() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/fused.schema.json");
    let text = serde_json::to_string_pretty(&schema()).unwrap() + "\n";
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(&path, text).unwrap();
        return;
    }
    let kept = std::fs::read_to_string(&path).unwrap();
    assert!(
        kept == text,
        "{}: not what the types say; run the test again with {UPDATE}=1 and look at the difference",
        path.display()
    );
}
