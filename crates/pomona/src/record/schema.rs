//! The JSON Schema of `picks.json`, made from the types of the record and compared with the copy in `docs/`.

use super::{PicksRecord, SCHEMA};

#[test]
fn the_schema_in_the_docs_is_that_of_the_types() {
    pomona_schema::assert_in_docs::<PicksRecord>(SCHEMA, "picks.schema.json");
}
