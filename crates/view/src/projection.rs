use crate::basis::perpendiculars;
use crate::canvas::Point;
use nalgebra::{Point2, Point3};
use pomona_cloud::Camera;
use pomona_geometry::{Sphere, angle_between};
use std::f64::consts::{PI, TAU};

/// Angle to the line of sight under which a short arrow counts as pointing
/// along it, radians.
const ALONG_SIGHT: f64 = PI / 4.0;

/// Points of the outline of a sphere.
const OUTLINE_POINTS: u32 = 72;

/// An arrow as it appears in the picture, canvas coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ArrowShape {
    /// It lies across the line of sight.
    Across { start: Point, tip: Point },
    /// It comes straight at the camera: ⊙.
    Towards { at: Point },
    /// It goes straight away from the camera: ⊗.
    Away { at: Point },
}

/// Where the point appears on the canvas; `None` behind the camera or where not finite.
fn project(camera: &Camera, point: &Point3<f64>) -> Option<Point2<f64>> {
    // The camera counts from the centre of the first pixel, the canvas from its corner.
    let (u, v) = camera.project(point).map(|(u, v)| (u + 0.5, v + 0.5))?;
    // Beyond this a coordinate says nothing about the picture.
    (u.abs() < 1e6 && v.abs() < 1e6).then(|| Point2::new(u, v))
}

fn canvas_point(p: Point2<f64>) -> Point {
    Point::from_xy(p.x as f32, p.y as f32)
}

/// The arrow's appearance. One shorter than `shortest` px becomes a marker
/// where it points within 45° of the line of sight, and is otherwise drawn
/// out to that length, since it is short only because it is far away. One
/// longer than `longest` px is cut there. `None` where it starts behind the
/// camera or has no direction.
pub(crate) fn arrow_shape(
    camera: &Camera,
    (start, end): (Point3<f64>, Point3<f64>),
    shortest: f64,
    longest: f64,
) -> Option<ArrowShape> {
    let direction = end - start;
    let to_sight = angle_between(&direction, &start.coords)?;
    let from = project(camera, &start)?;
    let at = canvas_point(from);
    // An end near or behind the camera's plane has no image: the arrow is drawn up to there.
    let nearest = 0.05 * start.z;
    let fraction = if end.z < nearest {
        (start.z - nearest) / (start.z - end.z)
    } else {
        1.0
    };
    let to = project(camera, &(start + direction * fraction))?;
    let across = to - from;
    let length = across.norm();
    if length < shortest {
        if to_sight < ALONG_SIGHT {
            return Some(ArrowShape::Away { at });
        }
        if to_sight > PI - ALONG_SIGHT {
            return Some(ArrowShape::Towards { at });
        }
    }
    if length == 0.0 {
        return None;
    }
    let tip = from + across * (length.clamp(shortest, longest.max(shortest)) / length);
    Some(ArrowShape::Across {
        start: at,
        tip: canvas_point(tip),
    })
}

/// The closed outline of a sphere in the picture (an ellipse for a pinhole
/// camera); `None` where any of it has no image.
///
/// The rays that touch a sphere of radius r at distance d do so on a circle
/// of radius r·√(1 − r²/d²) about the centre times (1 − r²/d²).
pub(crate) fn sphere_outline(camera: &Camera, sphere: &Sphere) -> Option<Vec<Point>> {
    let center = sphere.center.coords;
    let distance = center.norm();
    let cosine_squared = 1.0 - (sphere.radius / distance).powi(2);
    // Written so that NaN is refused.
    if !(cosine_squared > 0.0 && sphere.radius > 0.0) {
        return None;
    }
    let axis = center / distance;
    let (right, down) = perpendiculars(&axis);
    let radius = sphere.radius * cosine_squared.sqrt();
    let at = |i: u32| {
        let (sine, cosine) = (TAU * f64::from(i) / f64::from(OUTLINE_POINTS)).sin_cos();
        Point3::from(center * cosine_squared + (right * cosine + down * sine) * radius)
    };
    (0..OUTLINE_POINTS)
        .map(|i| project(camera, &at(i)).map(canvas_point))
        .collect()
}

/// Where a point of space lies on the canvas.
pub(crate) fn image_of(camera: &Camera, point: &Point3<f64>) -> Option<Point> {
    project(camera, point).map(canvas_point)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera::new([200, 100], [100.0; 2], [99.5, 49.5])
    }

    fn shape(start: [f64; 3], end: [f64; 3]) -> Option<ArrowShape> {
        arrow_shape(&camera(), (start.into(), end.into()), 8.0, 400.0)
    }

    #[test]
    fn arrows_along_the_sight_become_markers() {
        let at = Point::from_xy(100.0, 50.0);
        assert_eq!(
            shape([0.0, 0.0, 1.0], [0.0, 0.0, 0.9]),
            Some(ArrowShape::Towards { at })
        );
        assert_eq!(
            shape([0.0, 0.0, 1.0], [0.0, 0.0, -3.0]),
            Some(ArrowShape::Towards { at })
        );
        assert_eq!(
            shape([0.0, 0.0, 1.0], [0.001, 0.0, 1.1]),
            Some(ArrowShape::Away { at })
        );
    }

    #[test]
    fn a_far_arrow_across_the_sight_is_drawn_out() {
        let Some(ArrowShape::Across { start, tip }) = shape([0.0, 0.0, 5.0], [0.0, -0.05, 5.0])
        else {
            panic!("no arrow")
        };
        assert!((tip.x - start.x).abs() < 1e-3 && (start.y - tip.y - 8.0).abs() < 1e-3);
    }

    #[test]
    fn no_arrow_without_image_or_direction() {
        assert_eq!(shape([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]), None);
        assert_eq!(shape([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]), None);
        assert_eq!(shape([0.0, f64::NAN, 1.0], [0.0, 0.0, 1.0]), None);
        assert_eq!(shape([0.0, 0.0, 1.0], [0.0, f64::INFINITY, 1.0]), None);
    }

    #[test]
    fn outline_of_a_sphere_ahead_is_a_circle() {
        let sphere = Sphere::new(Point3::new(0.0, 0.0, 1.0), 0.1).unwrap();
        // tan(asin(r / d)) at focal length 100 px.
        let expected = 100.0 * 0.1 / f64::sqrt(1.0 - 0.01);
        for p in sphere_outline(&camera(), &sphere).unwrap() {
            let radius = f64::from(p.x - 100.0).hypot(f64::from(p.y - 50.0));
            assert!((radius - expected).abs() < 1e-3);
        }
        let around_us = Sphere::new(Point3::new(0.0, 0.0, 1.0), 2.0).unwrap();
        assert!(sphere_outline(&camera(), &around_us).is_none());
    }
}
