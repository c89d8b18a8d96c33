#[cfg(test)]
mod schema;

use crate::error::SceneError;
use pomona_cloud::{Camera, PixelBox};
use pomona_files::write_atomically;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The schema that this crate writes and reads.
pub const TRUTH_SCHEMA: &str = "pomona.truth/1";

/// The name of the file in a frame's folder.
pub const TRUTH_FILE: &str = "truth.json";

/// The ground truth of a synthetic frame: the content of `truth.json`.
///
/// Lengths in metres, in the camera's frame. What the optional fields hold is
/// absent where nobody computed it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct Truth {
    /// Always [`TRUTH_SCHEMA`].
    #[cfg_attr(test, schemars(extend("const" = TRUTH_SCHEMA)))]
    pub schema: String,
    /// The boxed apples, in the order of the frame's boxes.
    pub apples: Vec<AppleTruth>,
    /// Seed of the frame's noise and layout.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Name of the sensor that took it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<String>,
    /// The camera that the frame was really taken with, where its own file states another.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "schema::CameraShape"))]
    pub camera: Option<Camera>,
}

/// One apple.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields, extend("dependentRequired" = { "branch": ["direction"], "direction": ["branch"] })))]
pub struct AppleTruth {
    /// Box about what shows of it in the colour image.
    #[serde(rename = "box")]
    #[cfg_attr(test, schemars(with = "schema::PixelBoxShape"))]
    pub bounds: PixelBox,
    /// Centre; for a flattened apple that of its largest circle about the stem's axis.
    pub center: [f64; 3],
    /// Radius; for a flattened apple that of its largest circle.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub radius: f64,
    /// The nearest branch that passes within 1.8 radii; absent where none does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub branch: Option<BranchTruth>,
    /// Unit vector from the centre to the nearest point of that branch's centre line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: Option<[f64; 3]>,
    /// Whether the scene was made for this apple; a neighbour is not a target.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<bool>,
    /// Visible share of the silhouette's pixels inside the image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub visible_share: Option<f64>,
    /// Leaves whose middle lies within 3 radii of the apple's centre, seen or not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaves: Option<usize>,
}

/// The branch of an apple: the tangent of its centre line where it is nearest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
pub struct BranchTruth {
    /// Nearest point of the centre line.
    pub point: [f64; 3],
    /// Unit tangent there.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: [f64; 3],
    /// Radius there.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub radius: f64,
    /// Number of the branch in its scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub index: Option<usize>,
    /// Pixels that show this branch within 3 radii of the apple's centre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visible_pixels: Option<usize>,
    /// Length of the centre line that shows within 3 radii of the apple's centre, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub visible_length: Option<f64>,
}

impl Truth {
    /// A ground truth without seed, sensor or camera.
    pub fn new(apples: Vec<AppleTruth>) -> Self {
        Self {
            schema: TRUTH_SCHEMA.into(),
            apples,
            seed: None,
            sensor: None,
            camera: None,
        }
    }

    /// Reads `truth.json`, by the file's path or by that of the frame's folder.
    ///
    /// # Errors
    ///
    /// [`SceneError::File`] where it cannot be read, [`SceneError::Truth`] where
    /// it is not a truth of the known schema.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let mut path = path.as_ref().to_path_buf();
        if path.is_dir() {
            path.push(TRUTH_FILE);
        }
        let bytes = pomona_files::read(&path)?;
        let refused = |reason: String| SceneError::Truth {
            path: path.clone(),
            reason,
        };
        let truth: Self = serde_json::from_slice(&bytes).map_err(|e| refused(e.to_string()))?;
        if truth.schema != TRUTH_SCHEMA {
            let reason = format!("its schema is `{}`, not `{TRUTH_SCHEMA}`", truth.schema);
            return Err(refused(reason));
        }
        Ok(truth)
    }

    /// Writes the truth as JSON.
    ///
    /// # Errors
    ///
    /// [`SceneError::File`] where the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), SceneError> {
        let path = path.as_ref();
        let mut text = serde_json::to_string_pretty(self).map_err(|e| SceneError::Truth {
            path: path.into(),
            reason: e.to_string(),
        })?;
        text.push('\n');
        Ok(write_atomically(path, text.as_bytes())?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        pomona_schema::assert_in_docs::<Truth>(TRUTH_SCHEMA, "truth.schema.json");
    }

    /// The contract's example, with its bare fields.
    const CONTRACT: &str = r#"{ "schema": "pomona.truth/1", "apples": [ {
        "box": {"name": "0", "x_min": 1, "y_min": 2, "x_max": 3, "y_max": 4, "score": 1.0},
        "center": [0.0, 0.0, 0.8], "radius": 0.04,
        "branch": {"point": [0.0, -0.05, 0.8], "direction": [1.0, 0.0, 0.0], "radius": 0.005},
        "direction": [0.0, -1.0, 0.0] } ] }"#;

    #[test]
    fn reads_the_contracts_fields_and_writes_them_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(TRUTH_FILE);
        std::fs::write(&path, CONTRACT).unwrap();
        let truth = Truth::read(folder.path()).unwrap();
        assert_eq!(truth.apples[0].direction, Some([0.0, -1.0, 0.0]));
        truth.write(&path).unwrap();
        assert_eq!(Truth::read(&path).unwrap(), truth);
        let json: serde_json::Value =
            serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let wanted: serde_json::Value = serde_json::from_str(CONTRACT).unwrap();
        assert_eq!(json["apples"][0]["branch"], wanted["apples"][0]["branch"]);
    }

    #[test]
    fn refuses_another_schema() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("other.json");
        std::fs::write(&path, CONTRACT.replace("truth/1", "truth/9")).unwrap();
        let error = Truth::read(&path).unwrap_err().to_string();
        assert!(
            error.contains("truth/9") && error.contains("other.json"),
            "{error}"
        );
    }
}
