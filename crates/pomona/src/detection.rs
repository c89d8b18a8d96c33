//! From a frame to the boxes of its apples: a detector's, checked and joined by depth.

mod appearance;
mod candidate;
mod joining;
mod look;
mod mark;
mod record;
mod roundness;
mod samples;
mod search;

pub use candidate::FoundBox;
pub use mark::Mark;
pub use record::{DetectionRecord, DetectionTiming, FoundBy, FoundRecord};

use crate::optics::Projection;
use crate::seed::apple_rng;
use crate::{Config, PickError};
use candidate::{Candidate, SEED};
use joining::join;
use look::Looker;
use pomona_cloud::{ColorImage, Frame, PixelBox};
use pomona_detect::{Detection, Detector};
use rayon::prelude::*;
use search::search;
use std::time::Instant;

/// The boxes of a frame's apples, and what found them.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Those of the colour image, best first, then those that only depth shows.
    pub boxes: Vec<FoundBox>,
    /// What `picks.json` says of the detection.
    pub record: DetectionRecord,
}

impl Found {
    /// The boxes alone, as box files hold them: those that depth gives no reason to doubt.
    pub fn plausible(&self) -> impl Iterator<Item = &PixelBox> {
        let plausible = |b: &&FoundBox| b.found.mark == Mark::Plausible;
        self.boxes.iter().filter(plausible).map(|b| &b.bounds)
    }
}

/// Finds the apples of `frame`: what `detector` sees in the colour image, each box looked at in depth.
///
/// A box keeps its place and gets a [`Mark`]; boxes that show one apple are joined into their hull, with the
/// best of their scores. With [`DetectionConfig::depth_search`], apples that the colour misses are looked for among
/// the readings outside of the boxes. The frame's own boxes are not read. Detection is by one thread or
/// many as the detector pleases; the rest runs box by box in parallel and gives the same for any number of threads.
///
/// # Errors
///
/// [`PickError::Frame`] where the frame's parts contradict each other, [`PickError::Detect`] where the detector fails.
pub fn find_apples(
    frame: &Frame,
    detector: &dyn Detector,
    config: &Config,
) -> Result<Found, PickError> {
    frame.validate().map_err(|source| PickError::Frame {
        frame: frame.id.clone(),
        source: Box::new(source),
    })?;
    let start = Instant::now();
    let detections = detector
        .detect(&frame.color)
        .map_err(|source| PickError::Detect {
            frame: frame.id.clone(),
            source: Box::new(source),
        })?;
    let mut record = DetectionRecord::of(&detector.report());
    record.timing_ms.detector = milliseconds(start);
    record.detections = detections.len();

    let start = Instant::now();
    let bounds = named(&detections, &frame.color);
    let Some(projection) = Projection::new(&frame.camera) else {
        // Frame::validate has computed with the lens.
        return Ok(Found {
            boxes: Vec::new(),
            record,
        });
    };
    let looker = Looker::new(&frame.depth, &projection, config);
    let candidates: Vec<Candidate> = bounds
        .into_par_iter()
        .enumerate()
        .map_init(Default::default, |samples, (i, bounds)| {
            let mut rng = apple_rng(SEED, &frame.id, i);
            let look = looker.look(&bounds, &mut rng, samples);
            Candidate::new(bounds, FoundBy::Color, look)
        })
        .collect();
    let mut candidates = join(candidates, &looker, &frame.id);
    record.timing_ms.depth_check = milliseconds(start);

    if config.detection.depth_search {
        let start = Instant::now();
        let more = search(frame, &looker, &candidates);
        candidates.extend(more);
        record.timing_ms.depth_search = Some(milliseconds(start));
    }
    count(&mut record, &candidates);
    let boxes = candidates.into_iter().map(Candidate::finish).collect();
    Ok(Found { boxes, record })
}

/// Counts what became of the boxes.
fn count(record: &mut DetectionRecord, candidates: &[Candidate]) {
    let number = |wanted: &dyn Fn(&Candidate) -> bool| {
        candidates
            .iter()
            .filter(|candidate| wanted(candidate))
            .count()
    };
    record.merged = candidates.iter().map(|c| c.parts - 1).sum();
    record.marked = number(&|c| c.look.mark.refuses());
    record.by_depth = number(&|c| c.found_by == FoundBy::Depth);
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

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests;
