use crate::ray::{Ray, Surface};
use nalgebra::{Isometry3, Point3, Vector3};

/// One tapered piece of a limb: a cone's side between two round ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LimbPiece {
    pub(crate) start: Point3<f64>,
    pub(crate) end: Point3<f64>,
    pub(crate) start_radius: f64,
    pub(crate) end_radius: f64,
    /// Way along the whole limb at `start`, metres; for the bark.
    pub(crate) offset: f64,
}

impl LimbPiece {
    /// Unit axis, length, and growth of the radius along it.
    fn shape(&self) -> (Vector3<f64>, f64, f64) {
        let along = self.end - self.start;
        let length = along.norm().max(1e-12);
        (
            along / length,
            length,
            (self.end_radius - self.start_radius) / length,
        )
    }

    pub(crate) fn thickness(&self) -> f64 {
        self.start_radius + self.end_radius
    }

    pub(crate) fn transformed(mut self, by: &Isometry3<f64>) -> Self {
        self.start = by * self.start;
        self.end = by * self.end;
        self
    }

    pub(crate) fn hit(&self, ray: &Ray) -> Option<f64> {
        let (axis, length, growth) = self.shape();
        let m = ray.origin - self.start;
        let d = &ray.direction;
        let (md, da) = (m.dot(&axis), d.dot(&axis));
        let widening = 1.0 + growth * growth;
        let a = d.norm_squared() - da * da * widening;
        let half_b = m.dot(d) - md * da * widening - self.start_radius * growth * da;
        let c = m.norm_squared()
            - md * md * widening
            - 2.0 * self.start_radius * growth * md
            - self.start_radius * self.start_radius;
        let discriminant = half_b * half_b - a * c;
        // Along the axis (a near 0) only the ends can be met first.
        if a > 1e-9 {
            if discriminant < 0.0 {
                return None;
            }
            let t = (-half_b - discriminant.sqrt()) / a;
            let s = md + t * da;
            if t > 1e-9 && (0.0..=length).contains(&s) {
                return Some(t);
            }
        }
        let ends = [(self.start, self.start_radius), (self.end, self.end_radius)];
        ends.into_iter()
            .filter_map(|(center, radius)| ray.through_ball(&center, radius))
            .filter_map(|(enter, _)| (enter > 1e-9).then_some(enter))
            .min_by(f64::total_cmp)
    }

    /// Texture: u the way along the limb in metres, v unused.
    pub(crate) fn surface(&self, point: &Point3<f64>) -> Surface {
        let (axis, length, growth) = self.shape();
        let m = point - self.start;
        let s = m.dot(&axis);
        let within = s.clamp(0.0, length);
        let radial = m - axis * within;
        let tilt = if s == within { growth } else { 0.0 };
        let normal = (radial.normalize() - axis * tilt).normalize();
        Surface {
            normal,
            u: self.offset + within,
            v: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece() -> LimbPiece {
        LimbPiece {
            start: Point3::new(-0.1, 0.0, 0.8),
            end: Point3::new(0.1, 0.02, 0.85),
            start_radius: 0.012,
            end_radius: 0.008,
            offset: 0.0,
        }
    }

    #[test]
    fn rays_stop_on_the_side_or_on_an_end() {
        let limb = piece();
        let axis = pomona_geometry::Segment::new(limb.start, limb.end).unwrap();
        let mut hits = 0;
        for i in -60..60 {
            for j in -20..30 {
                let direction = Vector3::new(f64::from(i) * 0.0025, f64::from(j) * 0.0015, 1.0);
                let ray = Ray {
                    origin: Point3::origin(),
                    direction,
                };
                let Some(t) = limb.hit(&ray) else { continue };
                hits += 1;
                let p = ray.at(t);
                let f = axis.fraction(&p);
                let radius = limb.start_radius + f * (limb.end_radius - limb.start_radius);
                // The taper's slope of 0.02 sets foot and side apart by its square.
                assert!(
                    (axis.distance(&p) - radius).abs() < 1e-5,
                    "{}",
                    axis.distance(&p)
                );
                assert!(limb.surface(&p).normal.dot(&ray.direction) < 1e-6);
            }
        }
        assert!(hits > 300, "{hits} hits");
    }

    #[test]
    fn end_on_it_is_a_disc() {
        let limb = LimbPiece {
            start: Point3::new(0.0, 0.0, 0.5),
            end: Point3::new(0.0, 0.0, 0.7),
            start_radius: 0.01,
            end_radius: 0.01,
            offset: 0.0,
        };
        let ray = Ray {
            origin: Point3::origin(),
            direction: Vector3::z(),
        };
        assert!((limb.hit(&ray).unwrap() - 0.49).abs() < 1e-12);
    }
}
