use super::facts::{Facts, range};
use pomona_cloud::{ColorImage, DepthImage, DepthValues};
use std::path::Path;

/// Place of bit depth and colour type in a PNG's header, and their values for 16-bit grey.
const PNG_KIND: std::ops::Range<usize> = 24..26;
const GREY_16: &[u8] = &[16, 0];

/// How the files begin in which only depth is looked for: TIFF and NPY.
const DEPTH_ALONE: [&[u8]; 3] = [b"II*\0", b"MM\0*", b"\x93NUMPY"];

/// Whether a file that begins so is a picture or a depth image.
pub(super) fn is_image(start: &[u8]) -> bool {
    let of_both = [&b"\x89PNG"[..], b"\xff\xd8"];
    let mut all = of_both.into_iter().chain(DEPTH_ALONE);
    all.any(|magic| start.starts_with(magic))
}

pub(super) fn facts(path: &Path, start: &[u8]) -> anyhow::Result<Facts> {
    let is_depth = DEPTH_ALONE.iter().any(|magic| start.starts_with(magic))
        || (start.starts_with(b"\x89PNG") && start.get(PNG_KIND) == Some(GREY_16));
    if is_depth {
        let depth = match DepthValues::read(path)? {
            DepthValues::Metres {
                width,
                height,
                values,
            } => return Ok(floating(path, [width, height], &values)),
            _ => DepthImage::read(path)?,
        };
        let mut facts = Facts::new(path, "depth image");
        facts.size(depth.width, depth.height);
        add_fill(&mut facts, &depth);
        let readings = depth.readings.iter().filter(|&&r| r != 0);
        if let Some((low, high)) = range(readings.map(|&r| f64::from(r))) {
            facts.add(
                "readings",
                vec![low, high],
                format!("{low} to {high}, in the camera's depth unit"),
            );
        }
        return Ok(facts);
    }
    let image = ColorImage::read(path)?;
    let mut facts = Facts::new(path, "colour image");
    facts.size(image.width, image.height);
    facts.warn(ColorImage::turned_by_exif(path)?);
    Ok(facts)
}

/// A depth image in floating point.
fn floating(path: &Path, [width, height]: [usize; 2], values: &[f32]) -> Facts {
    let mut facts = Facts::new(path, "depth image");
    facts.size(width, height);
    let is_reading = |value: &&f32| value.is_finite() && **value > 0.0;
    let known = values.iter().filter(is_reading);
    let share = known.clone().count() as f64 / values.len().max(1) as f64;
    add_share(&mut facts, share);
    if let Some((low, high)) = range(known.map(|&value| f64::from(value))) {
        let text = format!(
            "{low} to {high} in floating point: metres, unless the camera states another unit"
        );
        facts.add("readings", vec![low, high], text);
    }
    facts
}

/// Adds the share of pixels that have a reading.
pub(super) fn add_fill(facts: &mut Facts, depth: &DepthImage) {
    let share = depth.reading_count() as f64 / depth.readings.len().max(1) as f64;
    add_share(facts, share);
}

fn add_share(facts: &mut Facts, share: f64) {
    facts.add(
        "depth_fill",
        share,
        format!("{:.1} % of the pixels have a reading", share * 100.0),
    );
}
