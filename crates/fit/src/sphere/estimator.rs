use crate::{Coordinate, Points, simd, sphere_geometric, sphere_least_squares, sphere_through};
use pomona_geometry::Sphere;
use pomona_ransac::{Candidates, Estimator};
use std::ops::Range;

/// How a sphere is refitted to its inliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphereRefit {
    /// [`sphere_least_squares`]: linear, as in Gao et al. 2022.
    #[default]
    Algebraic,
    /// [`sphere_geometric`], started from the model so far: the distances themselves.
    Geometric,
}

/// Spheres through points, for `pomona-ransac`. A residual is the distance from the surface.
#[derive(Clone, Copy, Debug)]
pub struct SphereEstimator<'a, T> {
    points: Points<'a, T>,
    refit: SphereRefit,
}

impl<'a, T: Coordinate> SphereEstimator<'a, T> {
    /// An estimator over a view of points.
    pub fn new(points: Points<'a, T>, refit: SphereRefit) -> Self {
        Self { points, refit }
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

impl<T: Coordinate> Estimator for SphereEstimator<'_, T> {
    type Model = Sphere;
    const SAMPLE_SIZE: usize = 4;

    fn len(&self) -> usize {
        self.points.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Sphere>) {
        let &[i, j, k, l] = sample else { return };
        if let Some(sphere) = sphere_through([i, j, k, l].map(|i| self.points.get(i))) {
            candidates.push(sphere);
        }
    }

    fn refit(&self, inliers: &[usize], current: &Sphere) -> Option<Sphere> {
        let points = self.points.select(inliers);
        match self.refit {
            SphereRefit::Algebraic => sphere_least_squares(points),
            SphereRefit::Geometric => sphere_geometric(points, current),
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
