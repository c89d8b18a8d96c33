use crate::prior::Knowledge;
use crate::{Coordinate, Points, PriorError, RadiusPrior, cylinder_through, cylinder_weighted};
use pomona_geometry::Cylinder;
use pomona_ransac::{Candidates, Estimator};
use std::ops::Range;

/// Cylinders through points with normals, for `pomona-ransac`. A residual is the distance from the
/// surface; the normals (of either sign) make models and are not scored.
///
/// A refit is [`cylinder_weighted`], started from the model so far.
#[derive(Clone, Copy, Debug)]
pub struct CylinderEstimator<'a, T> {
    points: Points<'a, T>,
    normals: Points<'a, T>,
    knowledge: Option<Knowledge>,
}

impl<'a, T: Coordinate> CylinderEstimator<'a, T> {
    /// An estimator over a view of points and a view of as many normals.
    ///
    /// Points beyond the last normal are scored, but a sample with one gives no model.
    pub fn new(points: Points<'a, T>, normals: Points<'a, T>) -> Self {
        Self {
            points,
            normals,
            knowledge: None,
        }
    }

    /// Refits use a prior on the radius; `point_sigma` is the standard deviation of the points about the surface.
    ///
    /// # Errors
    ///
    /// Unless `point_sigma` is positive and finite.
    pub fn prior(self, prior: RadiusPrior, point_sigma: f64) -> Result<Self, PriorError> {
        let knowledge = Some(Knowledge::new(prior, point_sigma)?);
        Ok(Self { knowledge, ..self })
    }

    fn refit_with(
        &self,
        inliers: &[usize],
        weight: impl Fn(usize) -> f64 + Clone,
        current: &Cylinder,
    ) -> Option<Cylinder> {
        let unit = self.knowledge.map_or(1.0, |k| k.point_sigma.powi(-2));
        let points = self.points.select(inliers).enumerate();
        cylinder_weighted(
            points.map(|(i, p)| (p, unit * weight(i))),
            current,
            self.knowledge.map(|k| k.prior),
        )
    }
}

impl<T: Coordinate> Estimator for CylinderEstimator<'_, T> {
    type Model = Cylinder;
    const SAMPLE_SIZE: usize = 2;

    fn len(&self) -> usize {
        self.points.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Cylinder>) {
        let &[i, j] = sample else { return };
        if i.max(j) >= self.normals.len() {
            return;
        }
        let points = [i, j].map(|i| self.points.get(i));
        let normals = [i, j].map(|i| self.normals.get(i).coords);
        if let Some(cylinder) = cylinder_through(points, normals) {
            candidates.push(cylinder);
        }
    }

    fn refit(&self, inliers: &[usize], current: &Cylinder) -> Option<Cylinder> {
        self.refit_with(inliers, |_| 1.0, current)
    }

    fn refit_weighted(
        &self,
        inliers: &[usize],
        weights: &[f64],
        current: &Cylinder,
    ) -> Option<Cylinder> {
        let weight = |i| weights.get(i).copied().unwrap_or(0.0);
        self.refit_with(inliers, weight, current)
    }

    fn residuals(&self, cylinder: &Cylinder, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = cylinder.signed_distance(&self.points.get(i)).abs();
        }
    }
}
