use super::camera;
use super::facts::{Facts, range};
use super::robot::{self, Foreign};
use crate::frame_arguments::FrameArguments;
use crate::summary::Summary;
use anyhow::{anyhow, bail};
use pomona::Config;
use pomona::record::{PicksRecord, SCHEMA};
use pomona_calibrate::{RECORD_SCHEMA, SAMPLES_SCHEMA};
use pomona_cloud::{ColorImage, read_boxes};
use pomona_scenes::{TRUTH_SCHEMA, Truth};
use pomona_transforms::SCHEMA as TRANSFORM_SCHEMA;
use serde_json::Value;
use std::path::Path;

/// Whether a file that begins so holds boxes: XML, or a text named so.
pub(super) fn is_box_file(path: &Path, start: &[u8]) -> bool {
    let start = start.trim_ascii_start();
    let is_urdf = [&b"<origin"[..], b"<joint"]
        .iter()
        .any(|tag| start.starts_with(tag));
    let is_xml = start.starts_with(b"<") && !is_urdf;
    is_xml || path.file_name().is_some_and(|name| name == "boxes.txt")
}

/// A JSON file, by its `schema`, or else by its fields.
pub(super) fn json(path: &Path, read: FrameArguments) -> anyhow::Result<Facts> {
    let bytes =
        std::fs::read(path).map_err(|e| anyhow!("{}: {e}; check the path", path.display()))?;
    let refused = |e: serde_json::Error| anyhow!("{}: {e}; write the file again", path.display());
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let value: Value = serde_json::from_slice(bytes).map_err(refused)?;
    match value.get("schema").map(|s| s.as_str().unwrap_or_default()) {
        Some(SCHEMA) => Ok(record(
            path,
            &serde_json::from_slice(bytes).map_err(refused)?,
        )),
        Some(TRUTH_SCHEMA) => Ok(truth(path, &Truth::read(path)?)),
        Some(TRANSFORM_SCHEMA) => robot::transform(path),
        Some(SAMPLES_SCHEMA) => robot::samples(path),
        Some(RECORD_SCHEMA) => robot::report(path, &value),
        Some(other) => bail!(
            "{}: its schema is `{other}`; known are {SCHEMA}, {TRUTH_SCHEMA}, {TRANSFORM_SCHEMA}, \
             {SAMPLES_SCHEMA} and {RECORD_SCHEMA}",
            path.display()
        ),
        None if value.is_array() || value.get("annotations").is_some() => boxes(path),
        None => by_words(path, read),
    }
}

/// YAML or JSON of other programs.
pub(super) fn by_words(path: &Path, read: FrameArguments) -> anyhow::Result<Facts> {
    let bytes =
        std::fs::read(path).map_err(|e| anyhow!("{}: {e}; check the path", path.display()))?;
    match Foreign::of(&String::from_utf8_lossy(&bytes)) {
        Foreign::Camera => camera::facts(path, read),
        Foreign::Samples => robot::samples(path),
        Foreign::Transform => robot::transform(path),
    }
}

fn record(path: &Path, record: &PicksRecord) -> Facts {
    let mut facts = Facts::new(path, "picks of a frame");
    facts.say("schema", record.schema.clone());
    facts.say("frame", record.frame.id.clone());
    facts.say("frame_id", record.frame.frame_id.clone());
    facts.say("method", record.method.clone());
    facts.say("seed", record.seed);
    facts.add(
        "apples",
        record.picks.len(),
        Summary::of_record(record).to_string(),
    );
    add_radii(
        &mut facts,
        record
            .picks
            .iter()
            .filter_map(|p| Some(p.apple.as_ref()?.radius)),
    );
    facts
}

fn truth(path: &Path, truth: &Truth) -> Facts {
    let mut facts = Facts::new(path, "truth of a synthetic frame");
    facts.say("schema", truth.schema.clone());
    facts.say("apples", truth.apples.len());
    let with_branch = truth.apples.iter().filter(|a| a.branch.is_some()).count();
    facts.say("with_branch", with_branch);
    add_radii(&mut facts, truth.apples.iter().map(|a| a.radius));
    facts
}

fn add_radii(facts: &mut Facts, radii: impl Iterator<Item = f64>) {
    if let Some((low, high)) = range(radii) {
        let text = format!("{:.1} to {:.1} mm", low * 1000.0, high * 1000.0);
        facts.add("radius", vec![low, high], text);
    }
}

/// Settings, as TOML.
pub(super) fn settings(path: &Path) -> anyhow::Result<Facts> {
    let config = Config::read(path)?;
    let mut facts = Facts::new(path, "settings");
    facts.say("method", config.method.name());
    let values = serde_json::to_value(&config)?;
    let unchanged = config == Config::default();
    facts.add(
        "settings",
        values,
        if unchanged {
            "all at their defaults"
        } else {
            "see `pomona config --config`"
        },
    );
    Ok(facts)
}

/// Boxes, whose numbers mean something only in their image: the one beside them.
pub(super) fn boxes(path: &Path) -> anyhow::Result<Facts> {
    let beside = ["color.png", "color.jpg", "color.jpeg"].map(|name| path.with_file_name(name));
    let Some(image) = beside.iter().find(|image| image.exists()) else {
        bail!(
            "{}: boxes belong to an image, and no color.png or color.jpg lies beside them; put them into their frame's folder",
            path.display()
        );
    };
    let image = ColorImage::read(image)?;
    let boxes = read_boxes(path, image.width, image.height)?;
    let mut facts = Facts::new(path, "boxes");
    facts.say("boxes", boxes.len());
    for (name, side) in [("width_px", 0), ("height_px", 1)] {
        let sides = boxes.iter().map(|b| [b.width(), b.height()][side]);
        if let Some((low, high)) = range(sides) {
            facts.add(name, vec![low, high], format!("{low:.0} to {high:.0} px"));
        }
    }
    Ok(facts)
}
