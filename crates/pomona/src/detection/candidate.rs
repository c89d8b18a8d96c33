use super::look::Look;
use super::record::{FoundBy, FoundRecord};
use pomona_cloud::PixelBox;
use pomona_geometry::Sphere;

/// Seed of the draws of all checks: a box is judged alike in every run.
pub(super) const SEED: u64 = 0x6465_7465_6374;

/// A box in which an apple was looked for and may have been found.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundBox {
    /// The box. Its name is the detection's number, best first; `2+5` for joined ones, `d0` for one found in depth.
    pub bounds: PixelBox,
    /// How it was found and what depth says about it.
    pub found: FoundRecord,
    /// The sphere that its depth shows, metres in the camera's frame; absent where it shows none.
    pub sphere: Option<Sphere>,
}

/// A box and what depth says about it.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) bounds: PixelBox,
    pub(super) found_by: FoundBy,
    pub(super) look: Look,
    /// Detections that were joined in it.
    pub(super) parts: usize,
}

impl Candidate {
    pub(super) fn new(bounds: PixelBox, found_by: FoundBy, look: Look) -> Self {
        Self {
            bounds,
            found_by,
            look,
            parts: 1,
        }
    }

    pub(super) fn finish(self) -> FoundBox {
        FoundBox {
            bounds: self.bounds,
            found: FoundRecord {
                found_by: self.found_by,
                mark: self.look.mark,
                merged: (self.parts > 1).then_some(self.parts),
            },
            sphere: self.look.sphere,
        }
    }
}
