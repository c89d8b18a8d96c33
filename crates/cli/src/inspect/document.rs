use super::camera;
use super::facts::{Facts, range};
use super::robot::{self, Foreign};
use crate::frame_arguments::FrameArguments;
use crate::summary::Summary;
use anyhow::{anyhow, bail};
use pomona::Config;
use pomona::record::{PicksRecord, SCHEMA};
use pomona_calibrate::{RECORD_SCHEMA, SAMPLES_SCHEMA};
use pomona_cloud::{BoxChoice, BoxImage, CocoDataset, ColorImage, Frame, read_boxes};
use pomona_scenes::{TRUTH_SCHEMA, Truth};
use pomona_transforms::SCHEMA as TRANSFORM_SCHEMA;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Whether a file that begins so holds boxes: XML, or a text named so.
pub(super) fn is_box_file(path: &Path, start: &[u8]) -> bool {
    let trimmed = start.trim_ascii_start();
    let is_urdf = [&b"<origin"[..], b"<joint"]
        .iter()
        .any(|tag| trimmed.starts_with(tag));
    let is_xml = trimmed.starts_with(b"<") && !is_urdf;
    let is_text = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("txt"));
    let is_named = path
        .file_name()
        .is_some_and(|name| name.eq_ignore_ascii_case("boxes.txt"));
    is_xml || is_named || (is_text && is_yolo(start))
}

/// Whether the first line has as many numbers as a YOLO box without a score, the first of them a whole one: points of
/// clouds have 3 or 6.
fn is_yolo(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let Some(line) = text.lines().find(|line| !line.trim().is_empty()) else {
        return false;
    };
    let mut words = line.split_whitespace();
    let class = words.next().is_some_and(|word| word.parse::<u32>().is_ok());
    class && words.clone().count() == 4 && words.all(|word| word.parse::<f64>().is_ok())
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
        Some(schema) if schema.starts_with("pomona.detections/") => Ok(detections(path, &value)),
        Some(other) => bail!(
            "{}: its schema is `{other}`; known are {SCHEMA}, {TRUTH_SCHEMA}, {TRANSFORM_SCHEMA}, \
             {SAMPLES_SCHEMA} and {RECORD_SCHEMA}",
            path.display()
        ),
        None if holds_boxes(&value) => {
            let names_images = value["images"][0].get("file_name").is_some();
            if names_images && image_beside(path).is_none() {
                dataset(path)
            } else {
                boxes(path)
            }
        }
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

/// What `pomona detect` saw.
fn detections(path: &Path, record: &Value) -> Facts {
    let mut facts = Facts::new(path, "detections");
    facts.say("schema", record["schema"].clone());
    facts.say("detector", record["detector"]["name"].clone());
    let images = record["images"].as_array();
    let boxes = images
        .into_iter()
        .flatten()
        .filter_map(|image| image["detections"].as_array());
    facts.say("images", images.map_or(0, Vec::len));
    facts.say("boxes", boxes.map(Vec::len).sum::<usize>());
    facts
}

/// A COCO file that names its images: what it holds of all of them.
fn dataset(path: &Path) -> anyhow::Result<Facts> {
    let dataset = CocoDataset::read(path)?;
    let mut facts = Facts::new(path, "boxes of images");
    facts.say("images", dataset.images.len());
    let boxes = dataset.images.iter().map(|image| image.boxes.len());
    facts.say("boxes", boxes.sum::<usize>());
    let names = dataset
        .categories
        .iter()
        .map(|category| category.name.clone());
    let names: Vec<String> = names.collect();
    facts.add("classes", names.clone(), names.join(", "));
    Ok(facts)
}

/// Whether a JSON without a schema is of boxes: a list, COCO or `LabelMe`.
fn holds_boxes(value: &Value) -> bool {
    let keys = ["annotations", "shapes"];
    value.is_array() || keys.iter().any(|key| value.get(key).is_some())
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

/// The frame's colour image beside a file.
fn image_beside(path: &Path) -> Option<PathBuf> {
    Frame::color_file(
        path.parent()
            .filter(|folder| !folder.as_os_str().is_empty())
            .unwrap_or(Path::new(".")),
    )
}

/// Boxes, whose numbers mean something only in their image: the one beside them.
pub(super) fn boxes(path: &Path) -> anyhow::Result<Facts> {
    let Some(file) = image_beside(path) else {
        bail!(
            "{}: boxes belong to an image, and no color.png or color.jpg lies beside them; put them into their frame's folder",
            path.display()
        );
    };
    let (width, height) = ColorImage::read_size(&file)?;
    let image = BoxImage::new(width, height).at(file);
    let read = read_boxes(path, &image, &BoxChoice::default())?;
    let boxes = read.value;
    let mut facts = Facts::new(path, "boxes");
    facts.warn(read.warnings);
    facts.say("boxes", boxes.len());
    for (name, side) in [("width_px", 0), ("height_px", 1)] {
        let sides = boxes.iter().map(|b| [b.width(), b.height()][side]);
        if let Some((low, high)) = range(sides) {
            facts.add(name, vec![low, high], format!("{low:.0} to {high:.0} px"));
        }
    }
    Ok(facts)
}
