use crate::sphere::spheres_of_radius;
use crate::{Coordinate, Points, RadiusPrior, sphere_through, sphere_through_normals};
use nalgebra::Point3;
use pomona_geometry::Sphere;
use pomona_ransac::Candidates;

/// What a [`SphereEstimator`](crate::SphereEstimator) makes a sphere of: [`FourPoints`],
/// [`ThreePointsAndRadius`] or [`TwoNormals`].
pub trait SphereSample<T>: Copy + Sync + sealed::Sealed {
    /// How many points a sample has.
    const SIZE: usize;

    /// How many spheres one sample can give at most.
    const MODELS: usize;

    /// Adds to `candidates` the spheres through a sample of `points`.
    fn fit(&self, points: &Points<'_, T>, sample: &[usize], candidates: &mut Candidates<Sphere>);
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::FourPoints {}
    impl Sealed for super::ThreePointsAndRadius {}
    impl<T> Sealed for super::TwoNormals<'_, T> {}
}

/// [`sphere_through`] four points.
#[derive(Clone, Copy, Debug, Default)]
pub struct FourPoints;

impl<T: Coordinate> SphereSample<T> for FourPoints {
    const SIZE: usize = 4;
    const MODELS: usize = 1;

    fn fit(&self, points: &Points<'_, T>, sample: &[usize], candidates: &mut Candidates<Sphere>) {
        let &[i, j, k, l] = sample else { return };
        let four = [points.get(i), points.get(j), points.get(k), points.get(l)];
        if let Some(sphere) = sphere_through(four) {
            candidates.push(sphere);
        }
    }
}

/// The two [`spheres_of_radius`] through three points, the radius being a prior's mean; with a viewpoint only
/// the one whose near side the points are.
///
/// Three points are clean more often than four, and noise leaves the radius alone: with 30 % inliers a
/// sample is clean with a chance of 2.7 % instead of 0.8 %.
///
/// A circle through the sample that is larger than the mean, but by no more than three standard deviations,
/// gives the sphere of which it is a great circle.
#[derive(Clone, Copy, Debug)]
pub struct ThreePointsAndRadius {
    prior: RadiusPrior,
    viewpoint: Option<Point3<f64>>,
}

impl ThreePointsAndRadius {
    /// Spheres on both sides of the sample.
    pub fn new(prior: RadiusPrior) -> Self {
        Self {
            prior,
            viewpoint: None,
        }
    }

    /// Only the sphere whose centre is farther from `viewpoint`, the camera's centre in the points'
    /// frame: a camera sees the near side of things.
    #[must_use]
    pub fn seen_from(self, viewpoint: Point3<f64>) -> Self {
        Self {
            viewpoint: Some(viewpoint),
            ..self
        }
    }
}

impl<T: Coordinate> SphereSample<T> for ThreePointsAndRadius {
    const SIZE: usize = 3;
    const MODELS: usize = 2;

    fn fit(&self, points: &Points<'_, T>, sample: &[usize], candidates: &mut Candidates<Sphere>) {
        let &[i, j, k] = sample else { return };
        let points = [i, j, k].map(|i| points.get(i));
        let radius = match crate::circle_through(points) {
            Some(circle) if circle.radius <= self.prior.mean() => self.prior.mean(),
            Some(circle) if circle.radius <= self.prior.mean() + 3.0 * self.prior.sigma() => {
                circle.radius
            }
            _ => return,
        };
        let Some([over, under]) = spheres_of_radius(points, radius) else {
            return;
        };
        if let Some(eye) = self.viewpoint {
            let farther = (over.center - eye).norm() >= (under.center - eye).norm();
            candidates.push(if farther { over } else { under });
        } else {
            candidates.push(over);
            if under != over {
                candidates.push(under);
            }
        }
    }
}

/// [`sphere_through_normals`] of two points.
#[derive(Clone, Copy, Debug)]
pub struct TwoNormals<'a, T> {
    normals: Points<'a, T>,
}

impl<'a, T: Coordinate> TwoNormals<'a, T> {
    /// The normals of the points, in the same order; a sample with a point beyond the last normal
    /// gives no sphere.
    pub fn new(normals: Points<'a, T>) -> Self {
        Self { normals }
    }
}

impl<T: Coordinate> SphereSample<T> for TwoNormals<'_, T> {
    const SIZE: usize = 2;
    const MODELS: usize = 1;

    fn fit(&self, points: &Points<'_, T>, sample: &[usize], candidates: &mut Candidates<Sphere>) {
        let &[i, j] = sample else { return };
        if i.max(j) >= self.normals.len() {
            return;
        }
        let normals = [i, j].map(|i| self.normals.get(i).coords);
        if let Some(sphere) = sphere_through_normals([i, j].map(|i| points.get(i)), normals) {
            candidates.push(sphere);
        }
    }
}
