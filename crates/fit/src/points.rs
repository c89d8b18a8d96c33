use crate::Coordinate;
use crate::prior::Knowledge;
use nalgebra::Point3;
use std::ops::Range;
use thiserror::Error;

/// Coordinate arrays of different length were given as one set of points.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("coordinate arrays differ in length: {x} x, {y} y, {z} z")]
#[non_exhaustive]
pub struct PointsError {
    /// Length of the array of x.
    pub x: usize,
    /// Length of the array of y.
    pub y: usize,
    /// Length of the array of z.
    pub z: usize,
}

/// A view of points as three arrays of coordinates of equal length.
///
/// Points that are not finite may be among them: they never make a model nor support one.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a, T> {
    x: &'a [T],
    y: &'a [T],
    z: &'a [T],
}

impl<'a, T: Coordinate> Points<'a, T> {
    /// A view of three arrays.
    ///
    /// # Errors
    ///
    /// Where their lengths differ.
    pub fn new(x: &'a [T], y: &'a [T], z: &'a [T]) -> Result<Self, PointsError> {
        if x.len() == y.len() && y.len() == z.len() {
            Ok(Self { x, y, z })
        } else {
            Err(PointsError {
                x: x.len(),
                y: y.len(),
                z: z.len(),
            })
        }
    }

    /// How many points.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Point `index`. Panics like a slice where there is none.
    #[inline]
    pub fn get(&self, index: usize) -> Point3<f64> {
        Point3::new(
            self.x[index].to_f64(),
            self.y[index].to_f64(),
            self.z[index].to_f64(),
        )
    }

    /// The points of the given numbers.
    pub fn select<'s>(
        &'s self,
        indices: &'s [usize],
    ) -> impl ExactSizeIterator<Item = Point3<f64>> + Clone + 's {
        indices.iter().map(|&i| self.get(i))
    }

    /// The coordinates of a block, three slices of one length.
    #[inline]
    pub(crate) fn block(&self, block: Range<usize>) -> (&'a [T], &'a [T], &'a [T]) {
        (
            &self.x[block.clone()],
            &self.y[block.clone()],
            &self.z[block],
        )
    }
}

/// Points with the weights that a refit gives them: 1/σ² where their σ is known, else 1, times
/// `weights` if there are any (a point beyond their end has none).
pub(crate) fn weighted<'s, T: Coordinate>(
    points: &'s Points<'_, T>,
    indices: &'s [usize],
    weights: Option<&'s [f64]>,
    knowledge: Option<Knowledge>,
) -> impl Iterator<Item = (Point3<f64>, f64)> + Clone + 's {
    let unit = knowledge.map_or(1.0, |k| k.point_sigma.powi(-2));
    indices.iter().enumerate().map(move |(n, &i)| {
        let weight = weights.map_or(1.0, |w| w.get(n).copied().unwrap_or(0.0));
        (points.get(i), unit * weight)
    })
}

/// Centroid of points, and the largest distance of one from it along an axis;
/// `None` for no points, for points that coincide up to rounding, and where they are not finite.
///
/// Solvers work in coordinates shifted and scaled by these, so that neither
/// the distance from the origin nor the unit of length costs digits.
pub(crate) fn centroid_and_extent(
    points: impl Iterator<Item = Point3<f64>> + Clone,
) -> Option<(Point3<f64>, f64)> {
    let (sum, count) = points
        .clone()
        .fold((nalgebra::Vector3::zeros(), 0_usize), |(sum, n), p| {
            (sum + p.coords, n + 1)
        });
    let centroid = Point3::from(sum / count.max(1) as f64);
    let extent = points.fold(0.0_f64, |extent, p| extent.max((p - centroid).amax()));
    let rounding = 8.0 * f64::EPSILON * centroid.coords.amax();
    (count > 0 && extent > rounding && extent.is_finite()).then_some((centroid, extent))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_must_be_of_one_length() {
        assert!(Points::new(&[1.0_f32], &[], &[1.0]).is_err());
        let points = Points::new(&[1.0_f32, 2.0], &[3.0, 4.0], &[5.0, 6.0]).unwrap();
        assert_eq!(points.get(1), Point3::new(2.0, 4.0, 6.0));
        assert_eq!(points.select(&[1, 0]).count(), 2);
    }

    #[test]
    fn no_centroid_of_nothing() {
        assert!(centroid_and_extent(std::iter::empty()).is_none());
        assert!(centroid_and_extent([Point3::new(f64::NAN, 0.0, 0.0)].into_iter()).is_none());
    }
}
