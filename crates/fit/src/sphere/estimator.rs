use crate::held::HeldRefit;
use crate::points::weighted;
use crate::prior::Knowledge;
use crate::sphere::{FourPoints, SphereSample, sphere_held};
use crate::{Coordinate, Points, PriorError, RadiusPrior, simd, sphere_least_squares};
use pomona_geometry::Sphere;
use pomona_ransac::{Candidates, Estimator};
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

/// A sphere made ready for one threshold: a point supports it where `low <= d² <= high`.
struct Shell<T> {
    center: [T; 3],
    low: T,
    high: T,
}

impl<T: Coordinate> Shell<T> {
    /// d lies within `threshold` of r exactly where d² lies between these squares.
    /// A threshold that is negative or NaN leaves nothing between them.
    fn new(sphere: &Sphere, threshold: f64) -> Self {
        let r = sphere.radius;
        let (low, high) = if threshold >= 0.0 {
            let inner = r - threshold;
            (
                if inner > 0.0 { inner * inner } else { 0.0 },
                (r + threshold).powi(2),
            )
        } else {
            (1.0, -1.0)
        };
        let [x, y, z] = [sphere.center.x, sphere.center.y, sphere.center.z];
        Self {
            center: [x, y, z].map(T::from_f64),
            low: T::from_f64(low),
            high: T::from_f64(high),
        }
    }

    #[inline(always)]
    fn squared_distance(&self, x: T, y: T, z: T) -> T {
        let (dx, dy, dz) = (x - self.center[0], y - self.center[1], z - self.center[2]);
        dx * dx + dy * dy + dz * dz
    }

    #[expect(
        clippy::needless_bitwise_bool,
        reason = "a branch in the inner loop keeps it from being vectorised"
    )]
    #[inline(always)]
    fn holds(&self, x: T, y: T, z: T) -> bool {
        let d2 = self.squared_distance(x, y, z);
        (self.low <= d2) & (d2 <= self.high)
    }
}

impl<T: Coordinate, S: SphereSample<T>> Estimator for SphereEstimator<'_, T, S> {
    type Model = Sphere;
    const SAMPLE_SIZE: usize = S::SIZE;
    const MAX_MODELS: usize = S::MODELS;

    fn len(&self) -> usize {
        self.points.len()
    }

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

    fn residuals(&self, sphere: &Sphere, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = sphere.signed_distance(&self.points.get(i)).abs();
        }
    }

    fn count_within(&self, sphere: &Sphere, block: Range<usize>, threshold: f64) -> usize {
        let shell = Shell::<T>::new(sphere, threshold);
        simd::count(self.points.block(block), |x, y, z| shell.holds(x, y, z))
    }

    fn select_within(
        &self,
        sphere: &Sphere,
        block: Range<usize>,
        threshold: f64,
        out: &mut Vec<usize>,
    ) {
        let shell = Shell::<T>::new(sphere, threshold);
        let (x, y, z) = self.points.block(block.clone());
        let points = x.iter().zip(y).zip(z).zip(block);
        out.extend(
            points
                .filter(|(((x, y), z), _)| shell.holds(**x, **y, **z))
                .map(|(_, i)| i),
        );
    }
}

impl<T: Coordinate, S: SphereSample<T>> HeldRefit for SphereEstimator<'_, T, S> {
    fn refit_held(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        start: &Sphere,
        condition: &dyn Fn(&Sphere) -> f64,
    ) -> Option<Sphere> {
        self.geometric(inliers, weights, start, Some(condition))
    }
}
