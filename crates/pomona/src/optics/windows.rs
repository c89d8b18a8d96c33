use pomona_cloud::{Camera, PixelBox, PixelWindow};
use pomona_geometry::Sphere;

/// The pixels of a `width` × `height` image that lie in a box; empty where there are none.
pub(crate) fn window_of_box(bounds: &PixelBox, width: usize, height: usize) -> PixelWindow {
    let b = bounds;
    PixelWindow::clamped(b.x_min, b.y_min, b.x_max, b.y_max, width, height)
}

/// The pixels that can show any point of `sphere`; all of them where it reaches the camera.
///
/// For each image axis alone, the tangents from the camera to the sphere's circle of shadow: with
/// centre (c, z) and radius r in that plane, the slopes s of its tangents solve
/// (c − s z)² = r² (1 + s²). Lens distortion moves the edge, so the window
/// is then widened by a tenth of its size.
pub(crate) fn window_of_sphere(
    sphere: &Sphere,
    camera: &Camera,
    width: usize,
    height: usize,
) -> PixelWindow {
    let full = PixelWindow::full(width, height);
    let Some((x_low, x_high)) = slopes(sphere.center.x, sphere.center.z, sphere.radius) else {
        return full;
    };
    let Some((y_low, y_high)) = slopes(sphere.center.y, sphere.center.z, sphere.radius) else {
        return full;
    };
    let widen = if camera.distortion.is_some() {
        0.1
    } else {
        0.0
    };
    let (mx, my) = ((x_high - x_low) * widen, (y_high - y_low) * widen);
    PixelWindow::clamped(
        camera.cx + camera.fx * (x_low - mx) - 1.0,
        camera.cy + camera.fy * (y_low - my) - 1.0,
        camera.cx + camera.fx * (x_high + mx) + 2.0,
        camera.cy + camera.fy * (y_high + my) + 2.0,
        width,
        height,
    )
}

/// The least and greatest of x/z over a circle about (c, z); `None` where it reaches z ≤ 0.
fn slopes(c: f64, z: f64, r: f64) -> Option<(f64, f64)> {
    if z <= r {
        return None;
    }
    let denominator = z * z - r * r;
    let root = r * (c * c + denominator).sqrt();
    Some(((c * z - root) / denominator, (c * z + root) / denominator))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_window_shows_the_whole_sphere(
            c in prop::array::uniform3(-0.4..0.4f64), r in 0.01..0.3f64, d in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let camera = Camera::new([1280, 960], [1080.0, 1075.0], [640.0, 470.0]);
            let d = Vector3::from(d);
            prop_assume!(d.norm() > 0.1);
            let sphere = Sphere::new(Point3::new(c[0], c[1], c[2] + 0.9), r).unwrap();
            let p = sphere.center + d.normalize() * r;
            let (u, v) = (camera.fx * p.x / p.z + camera.cx, camera.fy * p.y / p.z + camera.cy);
            let (u, v) = (u.round(), v.round());
            prop_assume!((0.0..1280.0).contains(&u) && (0.0..960.0).contains(&v) && p.z > 0.0);
            prop_assert!(window_of_sphere(&sphere, &camera, 1280, 960).contains(u as usize, v as usize));
        }
    }

    #[test]
    fn a_sphere_about_the_camera_is_seen_everywhere() {
        let camera = Camera::new([8, 6], [5.0; 2], [4.0, 3.0]);
        let sphere = Sphere::new(Point3::new(0.0, 0.0, 0.1), 0.2).unwrap();
        assert_eq!(
            window_of_sphere(&sphere, &camera, 8, 6),
            PixelWindow::full(8, 6)
        );
    }
}
