//! A gripper's path to an apple, and the gripper there.

use crate::canvas::{Canvas, Point};
use crate::palette;
use crate::projection::{image_of, sphere_outline};
use nalgebra::Point3;
use pomona_cloud::Camera;
use pomona_geometry::{Capsule, Sphere};

/// The pieces of a path that can be shown: each a run of neighbouring points.
///
/// A point behind the camera, or more than a picture's size beside the picture, ends a run.
pub(crate) fn path_runs(
    camera: &Camera,
    path: &[Point3<f64>],
    width: usize,
    height: usize,
) -> Vec<Vec<Point>> {
    let (w, h) = (width as f32, height as f32);
    let near = |p: &Point| p.x > -w && p.x < 2.0 * w && p.y > -h && p.y < 2.0 * h;
    let mut runs = vec![Vec::new()];
    for point in path {
        match (image_of(camera, point).filter(near), runs.last_mut()) {
            (Some(point), Some(run)) => run.push(point),
            _ => runs.push(Vec::new()),
        }
    }
    runs.retain(|run| run.len() > 1);
    runs
}

/// The outline of a capsule in the picture; `None` where any of it has no image.
///
/// The image of a convex body is the convex hull of the images of what it is the hull of: here
/// the balls at both ends.
pub(crate) fn capsule_outline(camera: &Camera, capsule: &Capsule) -> Option<Vec<Point>> {
    let mut points = Vec::new();
    for center in [capsule.segment.start, capsule.segment.end] {
        let ball = Sphere {
            center,
            radius: capsule.radius,
        };
        points.extend(sphere_outline(camera, &ball)?);
    }
    Some(hull(points))
}

/// The convex hull, counter-clockwise in a frame with y down (Andrew 1979, the monotone chain,
/// doi 10.1016/0020-0190(79)90072-3).
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && (b.x - a.x) * (p.y - a.y) <= (b.y - a.y) * (p.x - a.x)
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut outline = chain(&mut points.iter().copied());
    outline.extend(chain(&mut points.iter().rev().copied()));
    outline
}

pub(crate) fn draw_path(canvas: &mut Canvas, run: &[Point], scale: f32) {
    // A dark rim sets it off from sunlit leaves.
    canvas.polyline(run, false, palette::BACKGROUND, 0.6, 4.4 * scale);
    canvas.polyline(run, false, palette::PATH, 1.0, 2.4 * scale);
}

pub(crate) fn draw_gripper(canvas: &mut Canvas, outline: &[Point], scale: f32) {
    canvas.polygon(outline, palette::GRIPPER, 0.12);
    canvas.polyline(outline, true, palette::GRIPPER, 0.9, 1.6 * scale);
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_geometry::Segment;

    fn camera() -> Camera {
        Camera::new([200, 100], [100.0; 2], [99.5, 49.5])
    }

    #[test]
    fn an_outline_goes_round_both_ends() {
        let axis = Segment::new([-0.2, 0.0, 1.0].into(), [0.3, 0.0, 1.0].into()).unwrap();
        let outline = capsule_outline(&camera(), &Capsule::new(axis, 0.05).unwrap()).unwrap();
        let (mut left, mut right, mut top) = (f32::MAX, f32::MIN, f32::MAX);
        for p in &outline {
            (left, right, top) = (left.min(p.x), right.max(p.x), top.min(p.y));
        }
        assert!((left - 75.0).abs() < 0.5 && (right - 135.0).abs() < 0.5);
        assert!((top - 45.0).abs() < 0.5, "{top}");
        let behind = Segment::new([0.0, 0.0, -1.0].into(), [0.0, 0.0, 1.0].into()).unwrap();
        assert!(capsule_outline(&camera(), &Capsule::new(behind, 0.05).unwrap()).is_none());
    }

    #[test]
    fn a_path_is_cut_where_it_cannot_be_seen() {
        let path = [
            [0.0, 0.0, 1.0],
            [0.1, 0.0, 1.0],
            [0.1, 0.0, -1.0],
            [0.2, 0.0, 1.0],
        ];
        let path = path.map(Point3::from);
        let runs = path_runs(&camera(), &path, 200, 100);
        assert_eq!(runs.len(), 1);
        assert_eq!(runs[0].len(), 2);
        assert!(path_runs(&camera(), &[], 200, 100).is_empty());
    }
}
