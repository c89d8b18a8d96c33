use crate::ViewError;
use nalgebra::{Point3, Vector3};
use std::f64::consts::PI;

/// The viewpoint from which a cloud is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    eye: Point3<f64>,
    right: Vector3<f64>,
    down: Vector3<f64>,
    forward: Vector3<f64>,
    projection: Projection,
}

/// A projection onto the image plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Lines of sight meet in the eye; the field of view from top to bottom, radians.
    Perspective {
        /// Angle between the top and the bottom of the picture, in 0..π.
        vertical_angle: f64,
    },
    /// Lines of sight are parallel; the height of the field seen, metres.
    Orthographic {
        /// Height of the field seen, metres.
        field_height: f64,
    },
}

impl Viewpoint {
    /// Looks from `eye` at `target`, which is in the middle of the picture,
    /// with `up` upwards in it (−y in a camera's frame).
    ///
    /// # Errors
    ///
    /// [`ViewError::Viewpoint`] where eye and target coincide, `up` has no
    /// part across the line of sight, the field is not positive (or an angle
    /// not under π), or a number is not finite.
    pub fn new(
        eye: Point3<f64>,
        target: Point3<f64>,
        up: Vector3<f64>,
        projection: Projection,
    ) -> Result<Self, ViewError> {
        // Each is written so that NaN is refused.
        let forward = (target - eye).try_normalize(1e-12).filter(is_finite);
        let forward = forward.ok_or(ViewError::Viewpoint(
            "eye and target are one point, or not finite",
        ))?;
        let right = up
            .try_normalize(1e-12)
            .and_then(|up| forward.cross(&up).try_normalize(1e-9));
        let right = right
            .filter(is_finite)
            .ok_or(ViewError::Viewpoint("`up` lies along the line of sight"))?;
        let usable = match projection {
            Projection::Perspective { vertical_angle: a } => a > 0.0 && a < PI,
            Projection::Orthographic { field_height: h } => h > 0.0 && h.is_finite(),
        };
        if !usable {
            return Err(ViewError::Viewpoint("the field of view is not positive"));
        }
        let down = forward.cross(&right);
        Ok(Self {
            eye,
            right,
            down,
            forward,
            projection,
        })
    }

    /// The pixel coordinates of a point in a picture of this size, its depth
    /// along the line of sight; `None` behind the eye or where not finite.
    pub(crate) fn project(
        &self,
        point: &Point3<f64>,
        width: usize,
        height: usize,
    ) -> Option<(f64, f64, f64)> {
        let offset = point - self.eye;
        let depth = offset.dot(&self.forward);
        if !(depth > 1e-9 && depth.is_finite()) {
            return None;
        }
        let pixels_per_metre = match self.projection {
            Projection::Perspective { vertical_angle } => {
                height as f64 / (2.0 * (vertical_angle / 2.0).tan() * depth)
            }
            Projection::Orthographic { field_height } => height as f64 / field_height,
        };
        let u = width as f64 / 2.0 + offset.dot(&self.right) * pixels_per_metre;
        let v = height as f64 / 2.0 + offset.dot(&self.down) * pixels_per_metre;
        (u.is_finite() && v.is_finite()).then_some((u, v, depth))
    }
}

fn is_finite(v: &Vector3<f64>) -> bool {
    v.iter().all(|c| c.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIELD: Projection = Projection::Orthographic { field_height: 2.0 };

    #[test]
    fn a_camera_frame_keeps_its_sides() {
        let ahead = Point3::new(0.0, 0.0, 1.0);
        let right_and_down = Point3::new(0.5, 0.25, 1.0);
        for projection in [
            FIELD,
            Projection::Perspective {
                vertical_angle: PI / 2.0,
            },
        ] {
            let view = Viewpoint::new(Point3::origin(), ahead, -Vector3::y(), projection).unwrap();
            let (u, v, depth) = view.project(&right_and_down, 200, 100).unwrap();
            assert!(
                (u - 125.0).abs() < 1e-9 && (v - 62.5).abs() < 1e-9 && (depth - 1.0).abs() < 1e-12
            );
            assert!(
                view.project(&Point3::new(0.0, 0.0, -1.0), 200, 100)
                    .is_none()
            );
            assert!(
                view.project(&Point3::new(f64::NAN, 0.0, 1.0), 200, 100)
                    .is_none()
            );
        }
    }

    #[test]
    fn refuses_what_looks_nowhere() {
        let (o, ahead, up) = (Point3::origin(), Point3::new(0.0, 0.0, 1.0), Vector3::y());
        assert!(Viewpoint::new(o, o, up, FIELD).is_err());
        assert!(Viewpoint::new(o, ahead, Vector3::z(), FIELD).is_err());
        assert!(Viewpoint::new(o, ahead, Vector3::zeros(), FIELD).is_err());
        assert!(Viewpoint::new(Point3::new(f64::NAN, 0.0, 0.0), ahead, up, FIELD).is_err());
        for bad in [0.0, -1.0, PI, f64::NAN] {
            let projection = Projection::Perspective {
                vertical_angle: bad,
            };
            assert!(Viewpoint::new(o, ahead, up, projection).is_err());
        }
        assert!(
            Viewpoint::new(
                o,
                ahead,
                up,
                Projection::Orthographic {
                    field_height: f64::INFINITY
                }
            )
            .is_err()
        );
    }
}
