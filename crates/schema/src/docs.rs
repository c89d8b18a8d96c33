use crate::plain::Plain;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use serde_json::{Value, json};
use std::path::Path;

/// Set, schemas are written in place of compared.
const UPDATE: &str = "UPDATE_SCHEMAS";

/// Where the files in `docs/` are to be found by others.
const HOME: &str = "https://github.com/pomona-rs/pomona/blob/main/docs";

/// The schema of what `T` is written as, with a title (name and version of the form) and the name of its file.
pub fn schema_of<T: JsonSchema>(title: &str, file: &str) -> Value {
    let generator = SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator();
    let mut schema = generator.into_root_schema_for::<T>();
    RecursiveTransform(Plain).transform(&mut schema);
    schema.insert("title".to_owned(), json!(title));
    schema.insert("$id".to_owned(), json!(format!("{HOME}/{file}")));
    schema.to_value()
}

/// Asserts that `docs/FILE` of the repository is the schema of `T`.
///
/// # Panics
///
/// Where it is not, or cannot be read or written.
pub fn assert_in_docs<T: JsonSchema>(title: &str, file: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs")
        .join(file);
    let made = schema_of::<T>(title, file);
    let place = path.display();
    if std::env::var_os(UPDATE).is_some() {
        let text = format!("{made:#}\n");
        std::fs::write(&path, text).unwrap_or_else(|e| panic!("{place}: {e}"));
        return;
    }
    let kept = std::fs::read(&path).unwrap_or_else(|e| panic!("{place}: {e}"));
    let kept: Value = serde_json::from_slice(&kept).unwrap_or_else(|e| panic!("{place}: {e}"));
    assert!(
        kept == made,
        "{place}: not what the types say; run the test again with {UPDATE}=1 and look at the difference"
    );
}
