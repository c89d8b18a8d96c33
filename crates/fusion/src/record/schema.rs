//! Forms that recur in the schema.

use schemars::{Schema, SchemaGenerator, json_schema};

/// Rounding may take a component of a unit vector this far outside −1 to 1.
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
