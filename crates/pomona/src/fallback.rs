//! A direction for an apple whose branch is not known, where one is asked for.

use crate::config::FallbackKind;
use crate::frame::CheckedFrame;
use crate::optics::window_of_sphere;
use crate::outcome::{DirectionSource, FallbackDirection, FittedApple, unit};
use nalgebra::Vector3;
use pomona_cloud::DepthPoints;
use pomona_geometry::Sphere;
use pomona_transforms::{CameraFrame, Direction};

/// How far from the centre obstacles count, radii.
const REACH: f64 = 3.0;
/// What is nearer than this is the apple's own surface, radii and metres.
const SURFACE: (f64, f64) = (1.15, 0.003);
/// Points that make the nearest obstacle: fewer are flying pixels.
const OBSTACLE_POINTS: usize = 12;

/// Fallback direction for a refused apple with a sphere; `surface` are the pixels of its visible cap.
///
/// `None` where none is asked for, and for an apple at the camera.
pub(crate) fn direction(
    kind: FallbackKind,
    frame: &CheckedFrame<'_>,
    apple: &FittedApple,
    surface: &[u32],
    points: &mut DepthPoints,
) -> Option<FallbackDirection> {
    if kind == FallbackKind::None {
        return None;
    }
    let sphere = Sphere::new(apple.center.point(), apple.radius_m)?;
    let reach = Sphere {
        radius: REACH * sphere.radius,
        ..sphere
    };
    let (width, height) = frame.size();
    let window = window_of_sphere(&reach, &frame.frame().camera, width, height);
    // The frame's camera has been checked: it deprojects.
    let (depth, camera) = (&frame.frame().depth, &frame.frame().camera);
    points.fill(depth, camera, window).ok()?;
    if kind == FallbackKind::AwayFromObstacle
        && let Some(direction) = to_obstacle(&sphere, points)
    {
        let source = DirectionSource::AwayFromObstacle;
        return Some(FallbackDirection::new(direction, source));
    }
    let mut surface = surface.to_vec();
    surface.sort_unstable();
    let direction = into_cap(&sphere, &surface, points)?;
    Some(FallbackDirection::new(
        direction,
        DirectionSource::SurfaceNormal,
    ))
}

/// Against the mean of the outward normals of the cap's points; along the line of sight where there are none.
fn into_cap(
    sphere: &Sphere,
    surface: &[u32],
    points: &DepthPoints,
) -> Option<Direction<CameraFrame>> {
    let of_cap = (0..points.len()).filter(|&i| surface.binary_search(&points.pixel[i]).is_ok());
    let normals = of_cap.filter_map(|i| (points.point(i) - sphere.center).try_normalize(1e-9));
    let sum: Vector3<f64> = normals.sum();
    let sight = unit(sphere.center.coords, 1e-9)?;
    Some(unit(-sum, 1e-6).unwrap_or(sight))
}

/// Towards the mean of the nearest points that are not the apple's; `None` where there are too few.
fn to_obstacle(sphere: &Sphere, points: &DepthPoints) -> Option<Direction<CameraFrame>> {
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
        .filter_map(|&(_, i)| unit(points.point(i) - sphere.center, 1e-9));
    let ways: Vec<Direction<CameraFrame>> = ways.collect();
    let sum: Vector3<f64> = ways.iter().map(Direction::vector).sum();
    // Points all around make no side: then the nearest one counts.
    let mean = sum / ways.len().max(1) as f64;
    if mean.norm() > 0.5 {
        unit(mean, 1e-9)
    } else {
        ways.first().copied()
    }
}
