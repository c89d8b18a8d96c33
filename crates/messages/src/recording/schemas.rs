//! JSON Schemas of the messages, by Foxglove's names of messages, fields and types.

use serde_json::{Map, Value, json};

type Named = (&'static str, &'static Value);

/// An object of these fields, all required.
fn object(title: &str, fields: &[(&str, Value)]) -> Value {
    let properties: Map<String, Value> = fields
        .iter()
        .map(|(name, schema)| ((*name).to_owned(), schema.clone()))
        .collect();
    let required: Vec<&str> = fields.iter().map(|(name, _)| *name).collect();
    json!({"title": title, "type": "object", "properties": properties, "required": required})
}

fn list(items: &Value) -> Value {
    json!({"type": "array", "items": items})
}

fn number() -> Value {
    json!({"type": "number"})
}

fn string() -> Value {
    json!({"type": "string"})
}

fn integer() -> Value {
    json!({"type": "integer", "minimum": 0})
}

fn boolean() -> Value {
    json!({"type": "boolean"})
}

fn time(title: &str) -> Value {
    object(title, &[("sec", integer()), ("nsec", integer())])
}

fn numbers(title: &str, names: &[&str]) -> Value {
    let fields: Vec<_> = names.iter().map(|name| (*name, number())).collect();
    object(title, &fields)
}

fn vector() -> Value {
    numbers("foxglove.Vector3", &["x", "y", "z"])
}

fn quaternion() -> Value {
    numbers("foxglove.Quaternion", &["x", "y", "z", "w"])
}

fn color() -> Value {
    numbers("foxglove.Color", &["r", "g", "b", "a"])
}

fn pose() -> Value {
    object(
        "foxglove.Pose",
        &[("position", vector()), ("orientation", quaternion())],
    )
}

/// The schema of one message, made once.
macro_rules! message {
    ($(#[$doc:meta])* $function:ident, $name:literal, $fields:expr) => {
        $(#[$doc])*
        pub(super) fn $function() -> Named {
            static SCHEMA: std::sync::LazyLock<Value> =
                std::sync::LazyLock::new(|| object($name, &$fields));
            ($name, &SCHEMA)
        }
    };
}

message!(
    /// A frame in another.
    frame_transform,
    "foxglove.FrameTransform",
    [
        ("timestamp", time("time")),
        ("parent_frame_id", string()),
        ("child_frame_id", string()),
        ("translation", vector()),
        ("rotation", quaternion()),
    ]
);

message!(
    /// Poses in one frame.
    poses_in_frame,
    "foxglove.PosesInFrame",
    [
        ("timestamp", time("time")),
        ("frame_id", string()),
        ("poses", list(&pose())),
    ]
);

message!(
    /// Packed points.
    point_cloud,
    "foxglove.PointCloud",
    [
        ("timestamp", time("time")),
        ("frame_id", string()),
        ("pose", pose()),
        ("point_stride", integer()),
        (
            "fields",
            list(&object(
                "foxglove.PackedElementField",
                &[
                    ("name", string()),
                    ("offset", integer()),
                    ("type", integer()),
                ],
            )),
        ),
        (
            "data",
            json!({"type": "string", "contentEncoding": "base64"}),
        ),
    ]
);

message!(
    /// Shapes to show.
    scene_update,
    "foxglove.SceneUpdate",
    [
        ("deletions", list(&json!({"type": "object"}))),
        ("entities", list(&entity())),
    ]
);

fn entity() -> Value {
    let solid = |title: &str| {
        object(
            title,
            &[("pose", pose()), ("size", vector()), ("color", color())],
        )
    };
    let cylinder = object(
        "foxglove.CylinderPrimitive",
        &[
            ("pose", pose()),
            ("size", vector()),
            ("bottom_scale", number()),
            ("top_scale", number()),
            ("color", color()),
        ],
    );
    let point = numbers("foxglove.Point3", &["x", "y", "z"]);
    let line = object(
        "foxglove.LinePrimitive",
        &[
            ("type", integer()),
            ("pose", pose()),
            ("thickness", number()),
            ("scale_invariant", boolean()),
            ("points", list(&point)),
            ("color", color()),
            ("colors", list(&color())),
            ("indices", list(&integer())),
        ],
    );
    let pair = object(
        "foxglove.KeyValuePair",
        &[("key", string()), ("value", string())],
    );
    let none = list(&json!({"type": "object"}));
    object(
        "foxglove.SceneEntity",
        &[
            ("timestamp", time("time")),
            ("frame_id", string()),
            ("id", string()),
            ("lifetime", time("duration")),
            ("frame_locked", boolean()),
            ("metadata", list(&pair)),
            ("arrows", none.clone()),
            ("cubes", list(&solid("foxglove.CubePrimitive"))),
            ("spheres", list(&solid("foxglove.SpherePrimitive"))),
            ("cylinders", list(&cylinder)),
            ("lines", list(&line)),
            ("triangles", none.clone()),
            ("texts", none.clone()),
            ("models", none),
        ],
    )
}
