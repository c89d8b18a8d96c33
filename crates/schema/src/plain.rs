use schemars::Schema;
use schemars::transform::Transform;
use serde_json::{Value, json};

/// Takes out what says nothing about the files: that absent values could be null, Rust's number formats, line breaks
/// and links of the doc comments.
pub(crate) struct Plain;

impl Transform for Plain {
    fn transform(&mut self, schema: &mut Schema) {
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
}
