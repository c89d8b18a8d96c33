//! What is tested against the obstacles: a gripper, or the apple in it.

use crate::outline::PlacedOutline;
use crate::point_tree::{Ball, PointTree};
use crate::swept_volume::SweptVolume;
use nalgebra::Point3;
use pomona_geometry::Segment;

/// The parts of the gripper with their bounding sphere.
pub(crate) struct Shape<'a> {
    volumes: &'a [SweptVolume],
    around: Ball,
    /// The same as an outline, where it is a gripper's.
    outline: Option<PlacedOutline>,
}

impl<'a> Shape<'a> {
    pub(crate) fn new(volumes: &'a [SweptVolume]) -> Self {
        let (mut low, mut high) = (Point3::origin(), Point3::origin());
        for (i, volume) in volumes.iter().enumerate() {
            let center = volume.center();
            (low, high) = if i == 0 {
                (center, center)
            } else {
                (low.inf(&center), high.sup(&center))
            };
        }
        let center = nalgebra::center(&low, &high);
        let far = |volume: &SweptVolume| (volume.center() - center).norm() + volume.reach();
        let radius = volumes.iter().map(far).fold(0.0, f64::max);
        Self {
            volumes,
            around: Ball { center, radius },
            outline: None,
        }
    }

    /// The parts of a gripper, of which this is the outline.
    pub(crate) fn with_outline(volumes: &'a [SweptVolume], outline: PlacedOutline) -> Self {
        Self {
            outline: Some(outline),
            ..Self::new(volumes)
        }
    }

    /// Distance from the balls of a tree where it is under `bound`, and the centre of the nearest.
    pub(crate) fn nearest_of(
        &self,
        tree: &PointTree,
        bound: f64,
        enough: f64,
    ) -> Option<(f64, Point3<f64>)> {
        if tree.around()?.gap(&self.around) >= bound {
            return None;
        }
        match &self.outline {
            Some(outline) => tree.nearest(|p| outline.distance(p), bound, enough),
            None => tree.nearest(|p| self.distance_by_volumes(p), bound, enough),
        }
    }

    fn distance_by_volumes(&self, point: &Point3<f64>) -> f64 {
        let distances = self.volumes.iter().map(|v| v.distance_to_point(point));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Distance from a point where it is under `bound`.
    pub(crate) fn distance_to_point(&self, point: &Point3<f64>, bound: f64) -> Option<f64> {
        if (point - self.around.center).norm() - self.around.radius >= bound {
            return None;
        }
        let distance = match &self.outline {
            Some(outline) => outline.distance(point),
            None => self.distance_by_volumes(point),
        };
        (distance < bound).then_some(distance)
    }

    pub(crate) fn distance(
        &self,
        segment: &Segment,
        bound: f64,
    ) -> Option<(f64, Point3<f64>, usize)> {
        if segment.distance(&self.around.center) - self.around.radius >= bound {
            return None;
        }
        let mut best: Option<(f64, Point3<f64>, usize)> = None;
        for (index, volume) in self.volumes.iter().enumerate() {
            let (distance, point) = volume.distance_to_segment(segment);
            if distance < best.map_or(bound, |b| b.0) {
                best = Some((distance, point, index));
            }
        }
        best
    }
}
