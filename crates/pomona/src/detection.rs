//! From a frame to the boxes of its apples: a detector's, checked and joined by depth.

mod appearance;
mod candidate;
mod depth_check;
mod grid_readings;
mod joining;
mod mark;
mod origin;
mod search;
mod summary;

pub use candidate::DetectedBox;
pub use mark::Mark;
pub use origin::{BoxOrigin, FoundBy};
pub use summary::{DetectionSummary, DetectionTimes};

use crate::config::Config;
use crate::error::PickError;
use crate::frame::CheckedFrame;
use crate::seed::apple_rng;
use candidate::{Candidate, SEED};
use depth_check::DepthChecker;
use grid_readings::GridReadings;
use joining::join;
use pomona_cloud::{ColorImage, PixelBox};
use pomona_detect::{Detection, Detector};
use rayon::prelude::*;

use search::search;
use std::time::Instant;

/// The boxes of a frame's apples, and what found them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DetectedApples {
    /// Those of the colour image, best first, then those that only depth shows.
    pub boxes: Vec<DetectedBox>,
    /// The detector, and what became of its boxes.
    pub summary: DetectionSummary,
}

impl DetectedApples {
    /// The boxes alone, as box files hold them: those that depth gives no reason to doubt.
    pub fn plausible(&self) -> impl Iterator<Item = &PixelBox> {
        let plausible = |b: &&DetectedBox| b.origin.mark == Mark::Plausible;
        self.boxes.iter().filter(plausible).map(|b| &b.bounds)
    }
}

/// Finds the apples of `frame`: what `detector` sees in the colour image, each box checked against depth.
///
/// A box keeps its place and gets a [`Mark`]; boxes that show one apple are joined into their hull, with the
/// best of their scores. With [`DetectionConfig::depth_search`](crate::DetectionConfig::depth_search), apples that the
/// colour misses are looked for among
/// the readings outside of the boxes. The frame's own boxes are not read. Detection is by one thread or
/// many as the detector pleases; the rest runs box by box in parallel and gives the same for any number of threads.
///
/// # Errors
///
/// [`PickError::Detect`] where the detector fails.
pub fn find_apples(
    frame: &CheckedFrame<'_>,
    detector: &dyn Detector,
    config: &Config,
) -> Result<DetectedApples, PickError> {
    let (projection, frame) = (frame.projection(), frame.frame());
    let start = Instant::now();
    let detections = detector
        .detect(&frame.color)
        .map_err(|source| PickError::Detect {
            frame: frame.id.clone(),
            source: Box::new(source),
        })?;
    let mut summary = DetectionSummary {
        detector: detector.report(),
        detections: detections.len(),
        ..DetectionSummary::default()
    };
    summary.times.detector = start.elapsed();

    let start = Instant::now();
    let checker = DepthChecker::new(&frame.depth, projection, config);
    let candidates: Vec<Candidate> = named(&detections, &frame.color)
        .into_par_iter()
        .enumerate()
        .map_init(GridReadings::default, |readings, (i, bounds)| {
            let mut rng = apple_rng(SEED, &frame.id, i);
            let check = checker.check(&bounds, &mut rng, readings);
            Candidate::new(bounds, FoundBy::Color, check, &checker, readings)
        })
        .collect();
    let mut candidates = join(candidates, &checker, &frame.id);
    summary.times.depth_check = start.elapsed();

    if config.detection.depth_search {
        let start = Instant::now();
        let more = search(frame, &checker, &candidates);
        candidates.extend(more);
        summary.times.depth_search = Some(start.elapsed());
    }
    count(&mut summary, &candidates);
    let boxes = candidates.into_iter().map(Candidate::finish).collect();
    Ok(DetectedApples { boxes, summary })
}

/// Counts what became of the boxes.
fn count(summary: &mut DetectionSummary, candidates: &[Candidate]) {
    let number = |wanted: &dyn Fn(&Candidate) -> bool| {
        candidates
            .iter()
            .filter(|candidate| wanted(candidate))
            .count()
    };
    summary.merged = candidates.iter().map(|c| c.parts - 1).sum();
    summary.marked = number(&|c| c.check.mark.refuses());
    summary.by_depth = number(&|c| c.found_by == FoundBy::Depth);
}

/// The detections as boxes of the image, named by their number; what holds no pixel is left out.
fn named(detections: &[Detection], image: &ColorImage) -> Vec<PixelBox> {
    let boxes = detections.iter().enumerate().map(|(i, detection)| {
        let mut bounds = detection.to_pixel_box(i.to_string());
        bounds.score = if bounds.score.is_nan() {
            0.0
        } else {
            bounds.score.clamp(0.0, 1.0)
        };
        bounds
    });
    boxes
        .filter(|b| b.validate(image.width, image.height).is_ok())
        .collect()
}

#[cfg(test)]
mod tests;
