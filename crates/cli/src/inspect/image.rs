use super::facts::{Facts, range};
use pomona_cloud::{ColorImage, DepthImage};
use std::path::Path;

/// Place of bit depth and colour type in a PNG's header, and their values for 16-bit grey.
const PNG_KIND: std::ops::Range<usize> = 24..26;
const GREY_16: &[u8] = &[16, 0];

pub(super) fn facts(path: &Path, start: &[u8]) -> anyhow::Result<Facts> {
    if start.starts_with(b"\x89PNG") && start.get(PNG_KIND) == Some(GREY_16) {
        let depth = DepthImage::read(path)?;
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
    Ok(facts)
}

/// Adds the share of pixels that have a reading.
pub(super) fn add_fill(facts: &mut Facts, depth: &DepthImage) {
    let share = depth.reading_count() as f64 / depth.readings.len().max(1) as f64;
    facts.add(
        "depth_fill",
        share,
        format!("{:.1} % of the pixels have a reading", share * 100.0),
    );
}
