use crate::chart::linearize;
use crate::held::HeldRefit;
use crate::points::weighted;
use crate::prior::Knowledge;
use crate::shared_methods::{held_refit, residuals_by_distance, scores_by_kernel};
use crate::sphere::{FourPoints, SphereChart, SphereSample, shell, sphere_held};
use crate::{Coordinate, Points, PriorError, RadiusPrior, simd, sphere_least_squares};
use pomona_geometry::Sphere;
use pomona_ransac::{Candidates, Estimator, Linearization};
use std::ops::Range;

/// How a sphere is refitted to its inliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphereRefit {
    /// [`sphere_least_squares`]: linear, as in Gao et al. 2022. Weights are not heeded.
    #[default]
    Algebraic,
    /// [`sphere_geometric`](crate::sphere_geometric), started from the model so far: the distances
    /// themselves, each with its weight where the engine gives one.
    Geometric,
}

/// Spheres through points, for `pomona-ransac`. A residual is the distance from the surface.
///
/// `S` is what a minimal sample is: four points unless [`sampling`](Self::sampling) says otherwise.
///
/// The covariance in a report is by the shift of the centre along x, y and z and the change of the radius.
/// A prior is not part of it: it says what the points alone tell.
#[derive(Clone, Copy, Debug)]
pub struct SphereEstimator<'a, T, S = FourPoints> {
    points: Points<'a, T>,
    refit: SphereRefit,
    sample: S,
    knowledge: Option<Knowledge>,
}

impl<'a, T: Coordinate> SphereEstimator<'a, T> {
    /// An estimator over a view of points.
    pub fn new(points: Points<'a, T>, refit: SphereRefit) -> Self {
        Self {
            points,
            refit,
            sample: FourPoints,
            knowledge: None,
        }
    }
}

impl<'a, T: Coordinate, S> SphereEstimator<'a, T, S> {
    /// The same with another kind of minimal sample.
    pub fn sampling<S2>(self, sample: S2) -> SphereEstimator<'a, T, S2> {
        SphereEstimator {
            points: self.points,
            refit: self.refit,
            sample,
            knowledge: self.knowledge,
        }
    }

    /// Refits use a prior on the radius, and are geometric; `point_sigma` is the standard
    /// deviation of the points about the surface.
    ///
    /// # Errors
    ///
    /// Unless `point_sigma` is positive and finite.
    pub fn prior(self, prior: RadiusPrior, point_sigma: f64) -> Result<Self, PriorError> {
        Ok(Self {
            refit: SphereRefit::Geometric,
            knowledge: Some(Knowledge::new(prior, point_sigma)?),
            ..self
        })
    }

    fn geometric(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        current: &Sphere,
        condition: Option<&dyn Fn(&Sphere) -> f64>,
    ) -> Option<Sphere> {
        let points = weighted(&self.points, inliers, weights, self.knowledge);
        sphere_held(points, current, self.knowledge.map(|k| k.prior), condition)
    }
}

impl<T: Coordinate, S: SphereSample<T>> Estimator for SphereEstimator<'_, T, S> {
    type Model = Sphere;
    const SAMPLE_SIZE: usize = S::SIZE;
    const MAX_MODELS: usize = S::MODELS;
    const PARAMETERS: usize = 4;

    residuals_by_distance!(Sphere, signed_distance, abs);

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Sphere>) {
        self.sample.fit(&self.points, sample, candidates);
    }

    fn refit(&self, inliers: &[usize], current: &Sphere) -> Option<Sphere> {
        match self.refit {
            SphereRefit::Algebraic => sphere_least_squares(self.points.select(inliers)),
            SphereRefit::Geometric => self.geometric(inliers, None, current, None),
        }
    }

    fn refit_weighted(
        &self,
        inliers: &[usize],
        weights: &[f64],
        current: &Sphere,
    ) -> Option<Sphere> {
        match self.refit {
            SphereRefit::Algebraic => self.refit(inliers, current),
            SphereRefit::Geometric => self.geometric(inliers, Some(weights), current, None),
        }
    }

    fn linearize(&self, sphere: &Sphere, datum: usize, rows: &mut Linearization) {
        linearize::<SphereChart, 4, 1>(sphere, &self.points.get(datum), rows);
    }

    scores_by_kernel!(Sphere, shell::<T>);
}

impl<T: Coordinate, S: SphereSample<T>> HeldRefit for SphereEstimator<'_, T, S> {
    held_refit!(Sphere, geometric);
}
