use nalgebra::{Point3, Vector3};
use pomona_cloud::Camera;

/// A half-line, by its start and a direction of any length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub(crate) origin: Point3<f64>,
    pub(crate) direction: Vector3<f64>,
}

impl Ray {
    /// The ray of pixel position (u, v): its parameter is the depth z.
    pub(crate) fn of_pixel(camera: &Camera, u: f64, v: f64) -> Self {
        let x = (u - camera.cx) / camera.fx;
        let y = (v - camera.cy) / camera.fy;
        Self {
            origin: Point3::origin(),
            direction: Vector3::new(x, y, 1.0),
        }
    }

    pub(crate) fn at(&self, t: f64) -> Point3<f64> {
        self.origin + self.direction * t
    }

    /// Where the line enters and leaves a ball, or `None` where it passes it by.
    pub(crate) fn through_ball(&self, center: &Point3<f64>, radius: f64) -> Option<(f64, f64)> {
        let m = self.origin - center;
        let a = self.direction.norm_squared();
        let half_b = m.dot(&self.direction);
        let c = m.norm_squared() - radius * radius;
        let discriminant = half_b * half_b - a * c;
        if discriminant < 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        Some(((-half_b - root) / a, (-half_b + root) / a))
    }
}

/// What a surface shows at one of its points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// Unit normal, outwards, or the upper side of a leaf.
    pub(crate) normal: Vector3<f64>,
    /// Texture coordinates: each shape says what they are.
    pub(crate) u: f64,
    pub(crate) v: f64,
}
