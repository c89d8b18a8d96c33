//! A direction for an apple whose branch is not known, where one is asked for.

mod direction_source;

pub use direction_source::DirectionSource;

use crate::config::FallbackKind;
use crate::optics::window_of;
use crate::outcome::Evidence;
use crate::record::Pick;
use nalgebra::{Point3, Vector3};
use pomona_cloud::{DepthPoints, Frame};
use pomona_geometry::Sphere;

/// How far from the centre obstacles count, radii.
const REACH: f64 = 3.0;
/// What is nearer than this is the apple's own surface, radii and metres.
const SURFACE: (f64, f64) = (1.15, 0.003);
/// Points that make the nearest obstacle: fewer are flying pixels.
const OBSTACLE_POINTS: usize = 12;

/// Direction and source for a pick that has a sphere and no direction; `surface` of the evidence are the pixels of its cap.
///
/// `None` for a pick without a sphere, for an apple at the camera, and where the frame's parts contradict each other.
pub(crate) fn direction(
    kind: FallbackKind,
    frame: &Frame,
    pick: &Pick,
    evidence: &Evidence,
    points: &mut DepthPoints,
) -> Option<(Vector3<f64>, DirectionSource)> {
    if kind == FallbackKind::None {
        return None;
    }
    let apple = pick.apple.as_ref()?;
    let sphere = Sphere::new(Point3::from(apple.center), apple.radius)?;
    let reach = Sphere {
        radius: REACH * sphere.radius,
        ..sphere
    };
    let (width, height) = (frame.depth.width, frame.depth.height);
    let window = window_of(&reach, &frame.camera, width, height);
    points.fill(&frame.depth, &frame.camera, window).ok()?;
    if kind == FallbackKind::AwayFromObstacle
        && let Some(direction) = to_obstacle(&sphere, points)
    {
        return Some((direction, DirectionSource::AwayFromObstacle));
    }
    let mut surface = evidence.surface.clone();
    surface.sort_unstable();
    let direction = into_cap(&sphere, &surface, points)?;
    Some((direction, DirectionSource::SurfaceNormal))
}

/// Against the mean of the outward normals of the cap's points; along the line of sight where there are none.
fn into_cap(sphere: &Sphere, surface: &[u32], points: &DepthPoints) -> Option<Vector3<f64>> {
    let of_cap = (0..points.len()).filter(|&i| surface.binary_search(&points.pixel[i]).is_ok());
    let normals = of_cap.filter_map(|i| (points.point(i) - sphere.center).try_normalize(1e-9));
    let sum: Vector3<f64> = normals.sum();
    let sight = sphere.center.coords.try_normalize(1e-9)?;
    Some((-sum).try_normalize(1e-6).unwrap_or(sight))
}

/// Towards the mean of the nearest points that are not the apple's; `None` where there are too few.
fn to_obstacle(sphere: &Sphere, points: &DepthPoints) -> Option<Vector3<f64>> {
    let from = SURFACE.0 * sphere.radius + SURFACE.1;
    let to = REACH * sphere.radius;
    let mut near: Vec<(f64, usize)> = (0..points.len())
        .map(|i| ((points.point(i) - sphere.center).norm(), i))
        .filter(|(distance, _)| *distance > from && *distance <= to)
        .collect();
    if near.len() < OBSTACLE_POINTS {
        return None;
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let ways = near
        .iter()
        .take(OBSTACLE_POINTS)
        .filter_map(|&(_, i)| (points.point(i) - sphere.center).try_normalize(1e-9));
    let ways: Vec<Vector3<f64>> = ways.collect();
    let sum: Vector3<f64> = ways.iter().sum();
    // Points all around make no side: then the nearest one counts.
    let mean = sum / ways.len().max(1) as f64;
    if mean.norm() > 0.5 {
        mean.try_normalize(1e-9)
    } else {
        ways.first().copied()
    }
}
