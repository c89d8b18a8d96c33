//! Files that tell where cameras are: transforms, samples of a calibration, and its report.

use super::facts::Facts;
use anyhow::anyhow;
use pomona_calibrate::{SampleSet, Samples};
use pomona_transforms::{AnyTransform, CameraFrame, RobotFrame};
use serde_json::Value;
use std::path::Path;

/// Words in the text of a transform that is no camera.
const TRANSFORM_WORDS: [&str; 7] = [
    "translation",
    "Translation",
    "transformation",
    "static_transform_publisher",
    "eye_on_hand",
    "calibration_type",
    "<origin",
];
/// Words in the text of a camera, which may hold matrices and transforms too.
const CAMERA_WORDS: [&str; 5] = [
    "amera_matrix",
    "cameraMatrix",
    "distortion",
    "cam0:",
    "binning_x",
];
/// Words in the text of samples.
const SAMPLE_WORDS: [&str; 2] = ["effector_wrt_world", "tracking:"];

/// What a text that other programs wrote is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Foreign {
    Camera,
    Samples,
    Transform,
}

impl Foreign {
    /// Of YAML or JSON, by its words.
    pub(super) fn of(text: &str) -> Self {
        let has = |words: &[&str]| words.iter().any(|word| text.contains(word));
        if has(&SAMPLE_WORDS) {
            Self::Samples
        } else if has(&CAMERA_WORDS) {
            Self::Camera
        } else if has(&TRANSFORM_WORDS) || text.contains("opencv-matrix") {
            Self::Transform
        } else {
            Self::Camera
        }
    }
}

/// Whether a file is a transform in some known form.
pub(super) fn is_transform(path: &Path) -> bool {
    AnyTransform::read(path).is_ok()
}

/// A transform in any known form.
pub(super) fn transform(path: &Path) -> anyhow::Result<Facts> {
    let read = AnyTransform::read(path)?;
    let mut facts = Facts::new(path, "transform");
    let named = read.named::<RobotFrame, CameraFrame>("base_link", "the camera's frame")?;
    facts.warn(named.in_file(path).warnings);
    let named = read.named::<RobotFrame, CameraFrame>("-", "-")?.value;
    facts.say("to", named.to);
    facts.say("from", named.from);
    if read.leads_to_flange() {
        facts.add(
            "camera_on",
            "flange",
            "the flange: `pomona pick` needs base_from_flange.json in each frame's folder",
        );
    }
    let [x, y, z] = named.transform.translation_m().into();
    let text = format!("{:.1} {:.1} {:.1} mm", x * 1000.0, y * 1000.0, z * 1000.0);
    facts.add("translation", vec![x, y, z], text);
    let quaternion = named.transform.quaternion_xyzw();
    let text = quaternion.map(|c| format!("{c:.6}")).join(" ");
    facts.add("quaternion_xyzw", quaternion.to_vec(), text);
    Ok(facts)
}

/// Samples of a calibration.
pub(super) fn samples(path: &Path) -> anyhow::Result<Facts> {
    let set = SampleSet::read(path)?;
    let (kind, count) = match &set.samples {
        Samples::Points(points) => ("points", points.len()),
        Samples::Poses(poses) => ("poses", poses.len()),
    };
    let mut facts = Facts::new(path, "calibration samples");
    facts.say(kind, count);
    facts.warn(set.warnings);
    Ok(facts)
}

/// The report of a calibration.
pub(super) fn report(path: &Path, value: &Value) -> anyhow::Result<Facts> {
    let missing = || {
        anyhow!(
            "{}: not a report of a calibration; write the file again",
            path.display()
        )
    };
    let kind = value["kind"].as_str().ok_or_else(missing)?;
    let samples = value["samples"].as_array().ok_or_else(missing)?;
    let mut facts = Facts::new(path, "report of a calibration");
    facts.say("calibrated", kind);
    facts.say("samples", samples.len());
    let rejected = samples
        .iter()
        .filter(|s| s.get("rejected").is_some())
        .count();
    facts.say("rejected", rejected);
    if let Some(sigma_m) = value["sigma_at_fruit_m"].as_f64() {
        facts.add(
            "sigma_at_fruit",
            sigma_m,
            format!("{:.2} mm", sigma_m * 1000.0),
        );
    }
    Ok(facts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_told_by_their_words() {
        for (text, kind) in [
            ("width: 3\nk: [1]\n", Foreign::Camera),
            ("camera_matrix: !!opencv-matrix\n", Foreign::Camera),
            ("T: !!opencv-matrix\n", Foreign::Transform),
            ("transform:\n  translation: {x: 1}\n", Foreign::Transform),
            ("- effector_wrt_world: []\n", Foreign::Samples),
            ("samples:\n- robot: {}\n  tracking: {}\n", Foreign::Samples),
        ] {
            assert_eq!(Foreign::of(text), kind, "{text}");
        }
    }
}
