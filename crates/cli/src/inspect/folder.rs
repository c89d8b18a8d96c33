use super::camera::add_camera;
use super::document;
use super::facts::Facts;
use super::image::add_fill;
use crate::frame_arguments::FrameArguments;
use crate::pick::PICKS;
use crate::summary::plural;
use pomona::DepthQuality;
use pomona_cloud::{DepthPoints, Frame, read_tum};
use pomona_scenes::{TRUTH_FILE, Truth};
use pomona_statistics::lower_median;
use std::path::Path;

pub(super) fn facts(path: &Path, read: FrameArguments) -> anyhow::Result<Facts> {
    if path.join("rgb.txt").is_file() && path.join("depth.txt").is_file() {
        let mut facts = Facts::new(path, "TUM RGB-D folder");
        facts.say("frames", read_tum(path)?.len());
        return Ok(facts);
    }
    if path.join(PICKS).is_file() && Frame::depth_file(path).is_none() {
        return document::json(&path.join(PICKS), read);
    }
    frame(path, read)
}

fn frame(path: &Path, read: FrameArguments) -> anyhow::Result<Facts> {
    let frame = read.read(path)?;
    let mut facts = Facts::new(path, "RGB-D frame");
    facts.say("id", frame.id.clone());
    facts.warn(frame.warnings.iter().cloned());
    facts.warn(frame.camera.doubts());
    facts.size(frame.color.width, frame.color.height);
    add_camera(&mut facts, &frame.camera);
    add_fill(&mut facts, &frame.depth);
    add_depth_range(&mut facts, &frame);
    add_quality(&mut facts, &frame);
    match &frame.boxes {
        None => facts.add(
            "boxes",
            serde_json::Value::Null,
            "none; `pomona pick` detects them",
        ),
        Some(boxes) => {
            let mut points = DepthPoints::new();
            let mut with_depth = 0;
            for pixel_box in boxes {
                let window = pixel_box.window(frame.depth.width, frame.depth.height)?;
                points.fill(&frame.depth, &frame.camera, window)?;
                with_depth += usize::from(!points.is_empty());
            }
            facts.say("boxes", boxes.len());
            facts.say("boxes_with_depth", with_depth);
        }
    }
    if path.join(TRUTH_FILE).is_file() {
        let truth = Truth::read(path)?;
        facts.add(
            "truth",
            truth.apples.len(),
            plural(truth.apples.len(), "apple"),
        );
    }
    Ok(facts)
}

fn add_depth_range(facts: &mut Facts, frame: &Frame) {
    let mut readings: Vec<u16> = frame
        .depth
        .readings
        .iter()
        .copied()
        .filter(|&r| r != 0)
        .collect();
    let (least, most) = (
        readings.iter().copied().min(),
        readings.iter().copied().max(),
    );
    if let (Some(low), Some(median), Some(high)) = (least, lower_median(&mut readings), most) {
        let z = |reading: u16| f64::from(reading) * frame.camera.depth_scale;
        let (low, median, high) = (z(low), z(median), z(high));
        let text = format!(
            "{:.0} to {:.0} mm, median {:.0} mm",
            low * 1000.0,
            high * 1000.0,
            median * 1000.0
        );
        facts.add("z", vec![low, median, high], text);
    }
}

/// What the depth image tells about its own errors.
fn add_quality(facts: &mut Facts, frame: &Frame) {
    let quality = DepthQuality::of(&frame.depth, frame.camera.depth_scale);
    if let Some(noise) = quality.noise {
        let text = format!("{noise:.2} of that of `generic`");
        facts.add("depth_noise", noise, text);
    }
    if let Some(shared) = quality.shared_error_m {
        let text = format!("{:.1} mm shared by neighbours", shared * 1000.0);
        facts.add("depth_shared_error", shared, text);
    }
    match quality.smeared_share {
        None => facts.add(
            "smeared_edges",
            serde_json::Value::Null,
            "too few edges to tell; taken to be sharp",
        ),
        Some(share) => {
            let kind = match quality.smear() {
                0.0 => "sharp",
                s if s < 1.0 => "partly smeared",
                _ => "smeared: rims and curvature are believed less",
            };
            let text = format!("{:.0} % of them, {kind}", share * 100.0);
            facts.add("smeared_edges", share, text);
        }
    }
}
