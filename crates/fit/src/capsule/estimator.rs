use crate::capsule::capsule_along;
use crate::chart::linearize;
use crate::cylinder::{CylinderChart, cylinder_held};
use crate::held::HeldRefit;
use crate::points::weighted;
use crate::prior::Knowledge;
use crate::shared_methods::{geometric_refits, held_refit, radius_prior, residuals_by_distance};
use crate::{Coordinate, Points, PriorError, RadiusPrior, cylinder_through};
use pomona_geometry::{Capsule, Cylinder};
use pomona_ransac::{Candidates, Estimator, Linearization};
use std::ops::Range;

/// How many gaps' lengths a minimal model reaches at most, both ways together.
const CELLS: usize = 256;

/// Capsules through points with normals, for `pomona-ransac`: cylinders with two ends. A residual is
/// the distance from the surface, round ends included.
///
/// A sample of two points gives a cylinder, and its ends are where the points near it end: from the first
/// point of the sample both ways, until a piece of the axis as long as a gap has no point. That
/// is one pass over the data for each sample. A refit fits the cylinder
/// ([`cylinder_weighted`](crate::cylinder_weighted)) and then takes the extent of the inliers
/// ([`capsule_along`]). Unlike an infinite cylinder a capsule does not count what lies on the axis's
/// continuation elsewhere in the scene.
///
/// The covariance in a report is that of the cylinder (see [`CylinderEstimator`](crate::CylinderEstimator)) about the
/// segment's start; the ends are the outermost inliers, and no covariance tells how far the rod goes on unseen.
/// Inliers on the round ends count as if they lay on the cylinder's side, which makes the noise look a little larger.
#[derive(Clone, Copy, Debug)]
pub struct CapsuleEstimator<'a, T> {
    points: Points<'a, T>,
    normals: Points<'a, T>,
    inlier_distance: f64,
    max_gap: f64,
    knowledge: Option<Knowledge>,
}

impl<'a, T: Coordinate> CapsuleEstimator<'a, T> {
    /// An estimator over a view of points and one of as many normals, of either sign.
    ///
    /// A minimal model ends where for a length of `max_gap` no point is within `inlier_distance` of its
    /// surface, and 128 gaps from the sample at the latest; a refit ends where its inliers leave a larger gap than
    /// `max_gap`. There are no models for an `inlier_distance` that is negative or NaN, for a
    /// `max_gap` that is not positive and finite, or for a sample with a point beyond the last normal.
    pub fn new(
        points: Points<'a, T>,
        normals: Points<'a, T>,
        inlier_distance: f64,
        max_gap: f64,
    ) -> Self {
        Self {
            points,
            normals,
            inlier_distance,
            max_gap,
            knowledge: None,
        }
    }

    radius_prior!();

    /// The ends of `cylinder` about the parameter `middle` of its axis.
    fn ends(&self, cylinder: &Cylinder, middle: f64) -> (f64, f64) {
        let mut covered = [false; CELLS];
        let half = CELLS / 2;
        let start = middle - half as f64 * self.max_gap;
        for i in 0..self.points.len() {
            let p = self.points.get(i);
            let cell = (cylinder.axis.parameter(&p) - start) / self.max_gap;
            if cylinder.signed_distance(&p).abs() <= self.inlier_distance
                && (0.0..CELLS as f64).contains(&cell)
            {
                covered[cell as usize] = true;
            }
        }
        let below = covered[..half].iter().rev().take_while(|c| **c).count();
        let above = covered[half..].iter().take_while(|c| **c).count();
        let at = |cells: usize| cells as f64 * self.max_gap;
        (middle - at(below), middle + at(above))
    }

    fn geometric(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        current: &Capsule,
        condition: Option<&dyn Fn(&Capsule) -> f64>,
    ) -> Option<Capsule> {
        let points = weighted(&self.points, inliers, weights, self.knowledge);
        let with_ends = |cylinder: &Cylinder| {
            let [a, b] = [current.segment.start, current.segment.end];
            let [a, b] = [a, b].map(|p| cylinder.axis.parameter(&p));
            Capsule::cut(cylinder, a, b)
        };
        let on_cylinder = |cylinder: &Cylinder| {
            let capsule = with_ends(cylinder);
            capsule
                .zip(condition)
                .map_or(f64::NAN, |(capsule, condition)| condition(&capsule))
        };
        let cylinder = cylinder_held(
            points,
            &current.cylinder()?,
            self.knowledge.map(|k| k.prior),
            condition.map(|_| &on_cylinder as &dyn Fn(&Cylinder) -> f64),
        )?;
        capsule_along(&cylinder, self.points.select(inliers), self.max_gap)
    }
}

impl<T: Coordinate> Estimator for CapsuleEstimator<'_, T> {
    type Model = Capsule;
    const SAMPLE_SIZE: usize = 2;
    const PARAMETERS: usize = 5;

    residuals_by_distance!(Capsule, signed_distance, abs);

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Capsule>) {
        let &[i, j] = sample else { return };
        let sensible =
            self.inlier_distance >= 0.0 && self.max_gap > 0.0 && self.max_gap.is_finite();
        if i.max(j) >= self.normals.len() || !sensible {
            return;
        }
        let points = [i, j].map(|i| self.points.get(i));
        let normals = [i, j].map(|i| self.normals.get(i).coords);
        let capsule = cylinder_through(points, normals).and_then(|cylinder| {
            let (from, to) = self.ends(&cylinder, cylinder.axis.parameter(&points[0]));
            Capsule::cut(&cylinder, from, to)
        });
        if let Some(capsule) = capsule {
            candidates.push(capsule);
        }
    }

    fn linearize(&self, capsule: &Capsule, datum: usize, rows: &mut Linearization) {
        if let Some(cylinder) = capsule.cylinder() {
            linearize::<CylinderChart, 5, 1>(&cylinder, &self.points.get(datum), rows);
        }
    }

    geometric_refits!(Capsule);
}

/// The condition sees the capsule with the ends of the one started from; afterwards the ends are those of the inliers.
impl<T: Coordinate> HeldRefit for CapsuleEstimator<'_, T> {
    held_refit!(Capsule, geometric);
}
