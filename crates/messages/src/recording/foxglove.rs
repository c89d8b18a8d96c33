//! Foxglove's messages, as JSON. Names of messages, fields and types, and what they mean:
//! <https://docs.foxglove.dev/docs/sdk/schemas>.
//!
//! A message's fields are declared once: what is written and the JSON Schema beside it come from the same type.

use nalgebra::{Isometry3, UnitQuaternion};
use schemars::{JsonSchema, SchemaGenerator};
use serde::Serialize;
use serde_json::Value;

/// The schema of a message with everything that it consists of, under the name by which readers know it.
pub(super) fn schema<T: JsonSchema>() -> Value {
    let mut settings = schemars::generate::SchemaSettings::draft2020_12();
    settings.inline_subschemas = true;
    SchemaGenerator::from(settings)
        .into_root_schema_for::<T>()
        .to_value()
}

/// A time or a duration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub(super) struct Time {
    pub(super) sec: u64,
    pub(super) nsec: u32,
}

impl Time {
    /// Rounded to the nanosecond; negative seconds become 0.
    pub(super) fn from_seconds(seconds: f64) -> Self {
        const NANOSECONDS: u64 = 1_000_000_000;
        let total = (seconds * 1e9).round() as u64;
        Self {
            sec: total / NANOSECONDS,
            nsec: (total % NANOSECONDS) as u32,
        }
    }

    /// All of it in nanoseconds.
    pub(super) fn nanoseconds(self) -> u64 {
        self.sec * 1_000_000_000 + u64::from(self.nsec)
    }
}

#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub(super) struct Vector3 {
    x: f64,
    y: f64,
    z: f64,
}

impl From<nalgebra::Vector3<f64>> for Vector3 {
    fn from(v: nalgebra::Vector3<f64>) -> Self {
        let [x, y, z] = v.into();
        Self { x, y, z }
    }
}

#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub(super) struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

impl From<UnitQuaternion<f64>> for Quaternion {
    fn from(q: UnitQuaternion<f64>) -> Self {
        let [x, y, z, w] = q.coords.into();
        Self { x, y, z, w }
    }
}

#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub(super) struct Pose {
    position: Vector3,
    orientation: Quaternion,
}

impl From<&Isometry3<f64>> for Pose {
    fn from(pose: &Isometry3<f64>) -> Self {
        Self {
            position: pose.translation.vector.into(),
            orientation: pose.rotation.into(),
        }
    }
}

/// Red, green, blue and opacity, each 0 to 1.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub(super) struct Color {
    pub(super) r: f64,
    pub(super) g: f64,
    pub(super) b: f64,
    pub(super) a: f64,
}

/// The pose of a frame in another.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "foxglove.FrameTransform")]
pub(super) struct FrameTransform {
    pub(super) timestamp: Time,
    pub(super) parent_frame_id: String,
    pub(super) child_frame_id: String,
    pub(super) translation: Vector3,
    pub(super) rotation: Quaternion,
}

/// Poses in one frame.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "foxglove.PosesInFrame")]
pub(super) struct PosesInFrame {
    pub(super) timestamp: Time,
    pub(super) frame_id: String,
    pub(super) poses: Vec<Pose>,
}

/// Packed points.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "foxglove.PointCloud")]
pub(super) struct PointCloud {
    pub(super) timestamp: Time,
    pub(super) frame_id: String,
    pub(super) pose: Pose,
    /// Bytes of one point.
    pub(super) point_stride: u32,
    pub(super) fields: Vec<PackedElementField>,
    #[schemars(extend("contentEncoding" = "base64"))]
    pub(super) data: String,
}

/// One number of a packed point.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct PackedElementField {
    pub(super) name: String,
    /// Bytes from the beginning of the point.
    pub(super) offset: u32,
    #[serde(rename = "type")]
    pub(super) numeric_type: NumericType,
}

/// Type of a packed number, written as its code.
#[derive(Clone, Copy, Debug)]
pub(super) enum NumericType {
    Uint8 = 1,
    Float32 = 7,
}

impl Serialize for NumericType {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(*self as u8)
    }
}

impl JsonSchema for NumericType {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "foxglove.NumericType".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> schemars::Schema {
        u8::json_schema(generator)
    }
}

/// Shapes to show.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[schemars(rename = "foxglove.SceneUpdate")]
pub(super) struct SceneUpdate {
    pub(super) deletions: Vec<Unused>,
    pub(super) entities: Vec<SceneEntity>,
}

/// Shapes that appear together.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub(super) struct SceneEntity {
    pub(super) timestamp: Time,
    pub(super) frame_id: String,
    pub(super) id: String,
    /// 0: until it is replaced.
    pub(super) lifetime: Time,
    /// Whether it moves with its frame.
    pub(super) frame_locked: bool,
    pub(super) metadata: Vec<Unused>,
    pub(super) arrows: Vec<Unused>,
    pub(super) cubes: Vec<Solid>,
    pub(super) spheres: Vec<Solid>,
    pub(super) cylinders: Vec<Cylinder>,
    pub(super) lines: Vec<Line>,
    pub(super) triangles: Vec<Unused>,
    pub(super) texts: Vec<Unused>,
    pub(super) models: Vec<Unused>,
}

/// An element of a list that stays empty here.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct Unused {}

/// A cube or a sphere.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct Solid {
    pub(super) pose: Pose,
    /// Lengths along the axes, metres.
    pub(super) size: Vector3,
    pub(super) color: Color,
}

/// A cylinder along z.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct Cylinder {
    pub(super) pose: Pose,
    /// Diameters and height, metres.
    pub(super) size: Vector3,
    /// Size of the bottom; 1 is a full disc.
    pub(super) bottom_scale: f64,
    /// Size of the top; 1 is a full disc.
    pub(super) top_scale: f64,
    pub(super) color: Color,
}

/// A polyline.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct Line {
    /// 0: each point is connected with the next.
    #[serde(rename = "type")]
    pub(super) kind: u8,
    pub(super) pose: Pose,
    /// Metres, unless it is invariant to scale.
    pub(super) thickness: f64,
    pub(super) scale_invariant: bool,
    pub(super) points: Vec<Vector3>,
    pub(super) color: Color,
    pub(super) colors: Vec<Unused>,
    pub(super) indices: Vec<u32>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_split_into_seconds_and_nanoseconds() {
        let time = Time::from_seconds(1.25);
        assert_eq!((time.sec, time.nsec), (1, 250_000_000));
        assert_eq!(time.nanoseconds(), 1_250_000_000);
        assert_eq!(Time::from_seconds(0.999_999_999_9).sec, 1);
    }

    #[test]
    fn a_schema_is_whole_and_has_the_name_that_readers_know() {
        let schema = schema::<FrameTransform>();
        assert_eq!(schema["title"], "foxglove.FrameTransform");
        let rotation = &schema["properties"]["rotation"];
        assert_eq!(rotation["properties"]["w"]["type"], "number");
        assert!(!schema.to_string().contains("$ref"));
    }
}
