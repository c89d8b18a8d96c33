use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::marker::PhantomData;

/// How far a component of a unit vector may leave -1 to 1 by rounding.
const UNIT: f64 = 1.000_001;

/// How far a share may exceed 1 by rounding, where it is a sum or a quotient of sums.
const WHOLE: f64 = 1.000_000_001;

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

/// A number from 0 to 1.
pub struct Share;

impl JsonSchema for Share {
    fn schema_name() -> Cow<'static, str> {
        "Share".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A share from 0 to 1, but for rounding.",
            "type": "number", "minimum": 0, "maximum": WHOLE
        })
    }
}

/// A value that is always there, and `null` where it does not exist. (An `Option` is one that is left out.)
pub struct Nullable<T>(PhantomData<T>);

impl<T: JsonSchema> JsonSchema for Nullable<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Nullable{}", T::schema_name()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "oneOf": [{ "type": "null" }, generator.subschema_for::<T>()] })
    }
}
