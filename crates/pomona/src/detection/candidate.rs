use super::depth_check::{DepthAssessment, DepthChecker};
use super::grid_readings::GridReadings;
use super::mark::Mark;
use super::origin::{BoxOrigin, FoundBy};
use pomona_cloud::PixelBox;
use pomona_geometry::Sphere;

/// Seed of the draws of all checks: a box is judged alike in every run.
pub(super) const SEED: u64 = 0x6465_7465_6374;

/// A box that a detector or the search in depth gave, and what depth says about it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DetectedBox {
    /// The box. Its name is the detection's number, best first; `2+5` for joined ones, `d0` for one found in depth.
    pub bounds: PixelBox,
    /// How it was found and what depth says about it.
    pub origin: BoxOrigin,
    /// The sphere that its depth shows, metres in the camera's frame; `None` where it shows none.
    pub sphere: Option<Sphere>,
}

/// A box while boxes are checked and joined.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) bounds: PixelBox,
    pub(super) found_by: FoundBy,
    pub(super) check: DepthAssessment,
    /// Pixels of the readings that show the sphere of a plausible box.
    pub(super) surface: Vec<u32>,
    /// Number of detections that were joined in it.
    pub(super) parts: usize,
}

impl Candidate {
    /// A box of one detection, with its check and the readings that the check has taken.
    pub(super) fn new(
        bounds: PixelBox,
        found_by: FoundBy,
        check: DepthAssessment,
        checker: &DepthChecker<'_>,
        readings: &GridReadings,
    ) -> Self {
        let plausible = check.sphere.filter(|_| check.mark == Mark::Plausible);
        let surface = plausible.map(|sphere| checker.surface(readings, &sphere));
        Self {
            bounds,
            found_by,
            check,
            surface: surface.unwrap_or_default(),
            parts: 1,
        }
    }

    pub(super) fn finish(self) -> DetectedBox {
        DetectedBox {
            bounds: self.bounds,
            origin: BoxOrigin {
                merged: self.parts,
                ..BoxOrigin::new(self.found_by, self.check.mark)
            },
            sphere: self.check.sphere,
        }
    }
}
