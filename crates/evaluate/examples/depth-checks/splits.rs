//! Whether boxes of one apple become one, and those of two stay two.

use crate::boxes::{Draw, jittered, of_box};
use crate::fixed_detector::find;
use pomona::{Config, Mark, PickError};
use pomona_cloud::{Frame, PixelBox};
use pomona_detect::Detection;
use pomona_scenes::AppleTruth;
use serde::Serialize;

/// Each part of a box that is split takes this share of it.
const PART: f64 = 0.58;

/// Least overlap of a joint box with the whole one.
const RIGHT_IOU: f64 = 0.7;

/// Least share of an apple that shows for its box to be split: halves of less show nothing.
const LEAST_VISIBLE: f64 = 0.5;

/// How boxes were joined.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct MergeCounts {
    /// Apples whose box came in two parts.
    pub(crate) split: usize,
    /// Of these, those with one joint box about the whole apple.
    pub(crate) rightly_merged: usize,
    /// Of the others, those of which no more than one box would be picked: the second part is marked.
    pub(crate) left_with_one: usize,
    /// Boxes of whole apples, each apple with one.
    pub(crate) whole: usize,
    /// Of these, those that were joined with another apple's.
    pub(crate) wrongly_merged: usize,
    /// Of these, those marked as another apple's.
    pub(crate) wrongly_of_another: usize,
}

impl MergeCounts {
    pub(crate) fn join(&mut self, other: &Self) {
        self.split += other.split;
        self.rightly_merged += other.rightly_merged;
        self.left_with_one += other.left_with_one;
        self.whole += other.whole;
        self.wrongly_merged += other.wrongly_merged;
        self.wrongly_of_another += other.wrongly_of_another;
    }
}

pub(crate) fn measure(
    frame: &Frame,
    apples: &[AppleTruth],
    config: &Config,
    seed: u64,
) -> Result<MergeCounts, PickError> {
    let mut config = config.clone();
    config.detection.depth_search = false;
    let mut counts = MergeCounts {
        whole: apples.len(),
        ..MergeCounts::default()
    };
    let mut draw = Draw::new(seed, 101);
    let whole = apples.iter().map(|a| jittered(&a.bounds, &mut draw));
    let found = find(frame, whole.collect(), &config)?;
    counts.wrongly_merged = found.summary.merged;
    let of_another = |b: &&pomona::DetectedBox| b.origin.mark == Mark::OfAnother;
    counts.wrongly_of_another = found.boxes.iter().filter(of_another).count();

    let chosen: Vec<&AppleTruth> = apples
        .iter()
        .filter(|a| a.visible_share.unwrap_or(1.0) >= LEAST_VISIBLE)
        .collect();
    let parts: Vec<Detection> = chosen
        .iter()
        .flat_map(|a| parts(&a.bounds, draw.share() < 0.5))
        .collect();
    let found = find(frame, parts, &config)?;
    for (k, apple) in chosen.iter().enumerate() {
        counts.split += 1;
        let whole = of_box(&apple.bounds);
        let (first, second) = ((2 * k).to_string(), (2 * k + 1).to_string());
        let mine: Vec<_> = found
            .boxes
            .iter()
            .filter(|b| b.bounds.name.split('+').any(|n| n == first || n == second))
            .collect();
        let joint = mine
            .iter()
            .any(|b| b.origin.merged > 1 && of_box(&b.bounds).iou(&whole) >= RIGHT_IOU);
        if joint {
            counts.rightly_merged += 1;
        } else if mine.iter().filter(|b| !b.origin.mark.refuses()).count() <= 1 {
            counts.left_with_one += 1;
        }
    }
    Ok(counts)
}

/// The two parts of a box, side by side or one over the other.
fn parts(b: &PixelBox, upright: bool) -> [Detection; 2] {
    let whole = of_box(b);
    if upright {
        let cut = PART * b.width();
        [
            Detection {
                x_max: b.x_min + cut,
                ..whole
            },
            Detection {
                x_min: b.x_max - cut,
                ..whole
            },
        ]
    } else {
        let cut = PART * b.height();
        [
            Detection {
                y_max: b.y_min + cut,
                ..whole
            },
            Detection {
                y_min: b.y_max - cut,
                ..whole
            },
        ]
    }
}
