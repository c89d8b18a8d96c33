use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// How far a component of a unit vector may leave -1 to 1 by rounding.
const UNIT: f64 = 1.000_001;

/// Three numbers that are a vector of length 1.
pub struct UnitVector;

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

/// Four numbers that are a rotation, x y z w.
pub struct UnitQuaternion;

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
