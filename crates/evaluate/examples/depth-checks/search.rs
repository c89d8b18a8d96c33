//! What a search in depth finds of apples whose boxes are withheld.

use crate::boxes::{Draw, jittered};
use crate::fixed_detector::find;
use pomona::{Config, FoundBy, PickError};
use pomona_cloud::Frame;
use pomona_scenes::AppleTruth;
use serde::Serialize;

/// A find is an apple's where the centres are nearer than this many radii.
const SAME_APPLE: f64 = 0.6;

/// Share of an apple that shows from which on it could be expected to be found.
const WELL_SEEN: f64 = 0.6;

/// What the search found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct SearchCounts {
    /// Apples whose boxes were withheld: every other one, drawn by seed.
    pub(crate) withheld: usize,
    /// Of these, those that were found.
    pub(crate) found: usize,
    /// Apples withheld of which at least 60 % shows.
    pub(crate) withheld_well_seen: usize,
    /// Of these, those that were found.
    pub(crate) found_well_seen: usize,
    /// Finds where there is no apple, or one that has a box already.
    pub(crate) false_finds: usize,
    /// Milliseconds of the searches, all together.
    pub(crate) total_ms: f64,
}

impl SearchCounts {
    pub(crate) fn join(&mut self, other: &Self) {
        self.withheld += other.withheld;
        self.found += other.found;
        self.withheld_well_seen += other.withheld_well_seen;
        self.found_well_seen += other.found_well_seen;
        self.false_finds += other.false_finds;
        self.total_ms += other.total_ms;
    }
}

pub(crate) fn measure(
    frame: &Frame,
    apples: &[AppleTruth],
    config: &Config,
    seed: u64,
) -> Result<SearchCounts, PickError> {
    let mut config = config.clone();
    config.detection.depth_search = true;
    let mut draw = Draw::new(seed, 202);
    let (mut shown, mut withheld) = (Vec::new(), Vec::new());
    for apple in apples {
        if draw.share() < 0.5 {
            withheld.push(apple);
        } else {
            shown.push(jittered(&apple.bounds, &mut draw));
        }
    }
    let found = find(frame, shown, &config)?;
    let mut counts = SearchCounts {
        withheld: withheld.len(),
        total_ms: found
            .summary
            .times
            .depth_search
            .unwrap_or_default()
            .as_secs_f64()
            * 1e3,
        ..SearchCounts::default()
    };
    let mut got = vec![false; withheld.len()];
    let finds = found
        .boxes
        .iter()
        .filter(|b| b.origin.found_by == FoundBy::Depth);
    for sphere in finds.filter_map(|b| b.sphere) {
        let hit = withheld.iter().position(|apple| {
            (sphere.center - nalgebra::Point3::from(apple.center)).norm()
                <= SAME_APPLE * apple.radius
        });
        match hit {
            Some(k) if !got[k] => got[k] = true,
            _ => counts.false_finds += 1,
        }
    }
    for (apple, got) in withheld.iter().zip(got) {
        let well = apple.visible_share.unwrap_or(1.0) >= WELL_SEEN;
        counts.found += usize::from(got);
        counts.withheld_well_seen += usize::from(well);
        counts.found_well_seen += usize::from(well && got);
    }
    Ok(counts)
}
