//! Boxes of one apple become one box.

use super::candidate::{Candidate, SEED};
use super::depth_check::DepthChecker;
use super::grid_readings::GridReadings;
use super::mark::Mark;
use crate::seed::apple_rng;
use pomona_cloud::PixelBox;
use pomona_geometry::Sphere;

/// Radii of two spheres that may be of one apple differ by no more than this factor.
const ALIKE: f64 = 1.6;

/// A box that reaches beyond the outline of its sphere by more than this factor is of several apples.
const HULL: f64 = 1.35;

/// Joins the boxes whose spheres coincide, best first.
///
/// The joint box is the hull of its parts, with the best part's score and the names of all. A box that shows the apple
/// of a better one but would stretch its hull beyond that apple's outline, as one about a whole cluster does, keeps
/// to itself and is marked [`Mark::OfAnother`].
pub(super) fn join(
    candidates: Vec<Candidate>,
    checker: &DepthChecker<'_>,
    frame_id: &str,
) -> Vec<Candidate> {
    let mut joined: Vec<Candidate> = Vec::with_capacity(candidates.len());
    let mut readings = GridReadings::default();
    let limit = checker.config.merge_distance;
    for (i, mut candidate) in candidates.into_iter().enumerate() {
        let same = joined
            .iter()
            .position(|other| coincide(&candidate, other, limit));
        let Some(at) = same else {
            joined.push(candidate);
            continue;
        };
        let better = &mut joined[at];
        let hull = hull(&better.bounds, &candidate.bounds);
        let mut rng = apple_rng(SEED, frame_id, i);
        let check = checker.check(&hull, &mut rng, &mut readings);
        let fits = check
            .sphere
            .is_some_and(|sphere| check.mark == Mark::Plausible && frames(&hull, &sphere, checker));
        if fits {
            let parts = better.parts + 1;
            let found_by = better.found_by;
            *better = Candidate {
                parts,
                ..Candidate::new(hull, found_by, check, checker, &readings)
            };
        } else {
            candidate.check.mark = Mark::OfAnother;
            joined.push(candidate);
        }
    }
    joined
}

/// Whether two plausible boxes show one sphere.
fn coincide(a: &Candidate, b: &Candidate, limit: f64) -> bool {
    let plausible = |c: &Candidate| c.check.sphere.filter(|_| c.check.mark == Mark::Plausible);
    let (Some(a), Some(b)) = (plausible(a), plausible(b)) else {
        return false;
    };
    let (less, more) = (a.radius.min(b.radius), a.radius.max(b.radius));
    more <= ALIKE * less && (a.center - b.center).norm() < limit * less
}

fn hull(a: &PixelBox, b: &PixelBox) -> PixelBox {
    PixelBox {
        name: format!("{}+{}", a.name, b.name),
        x_min: a.x_min.min(b.x_min),
        y_min: a.y_min.min(b.y_min),
        x_max: a.x_max.max(b.x_max),
        y_max: a.y_max.max(b.y_max),
        score: a.score.max(b.score),
    }
}

/// Whether the sphere's outline fills the box by and large.
fn frames(bounds: &PixelBox, sphere: &Sphere, checker: &DepthChecker<'_>) -> bool {
    let outline = 2.0 * sphere.radius / checker.projection.pixel_m(sphere.center.z);
    bounds.width().max(bounds.height()) <= HULL * outline
}
