use crate::ray::{Ray, Surface};
use nalgebra::{Isometry3, Point3, Unit, Vector3};

/// How an apple is coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variety {
    /// Red all over, a little yellow about the stem.
    Red,
    /// Yellow-green, with a red cheek towards the light.
    Blushed,
    /// Yellow-green.
    Yellow,
}

/// An apple: a sphere, or a flattened body with a cavity about the stem and one about the calyx.
///
/// Its surface lies at distance R(c) = r·(1 − f·c² − s·e^((c−1)/w) − k·e^(−(c+1)/w))
/// from `center`, c being the cosine of the angle to the stem, f
/// `flattening`, s `stem_cavity`, k `calyx_cavity`, w = 0.05 (which opens the
/// cavities over about 25 degrees). With all three zero it is a sphere.
/// The largest circle about the axis has radius r, which is what calipers measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apple {
    /// Centre of the largest circle about the axis, metres.
    pub center: Point3<f64>,
    /// Radius of that circle, metres.
    pub radius: f64,
    /// Direction from the centre to the stem.
    pub axis: Unit<Vector3<f64>>,
    /// Share of the radius by which the poles are lower, 0 to 0.25.
    pub flattening: f64,
    /// Depth of the cavity about the stem, share of the radius, 0 to 0.4.
    pub stem_cavity: f64,
    /// Depth of the cavity about the calyx, share of the radius, 0 to 0.3.
    pub calyx_cavity: f64,
    /// Colours.
    pub variety: Variety,
}

const CAVITY_WIDTH: f64 = 0.05;

impl Apple {
    /// A perfectly round red apple with its stem up (against y).
    pub fn sphere(center: Point3<f64>, radius: f64) -> Self {
        Self {
            center,
            radius,
            axis: -Vector3::y_axis(),
            flattening: 0.0,
            stem_cavity: 0.0,
            calyx_cavity: 0.0,
            variety: Variety::Red,
        }
    }

    /// Where the stem leaves the flesh.
    pub fn stem_foot(&self) -> Point3<f64> {
        self.center + self.axis.into_inner() * self.reach(1.0)
    }

    /// Distance of the surface from the centre at cosine `c` of the angle to the stem.
    pub fn reach(&self, c: f64) -> f64 {
        let stem = self.stem_cavity * ((c - 1.0) / CAVITY_WIDTH).exp();
        let calyx = self.calyx_cavity * (-(c + 1.0) / CAVITY_WIDTH).exp();
        self.radius * (1.0 - self.flattening * c * c - stem - calyx)
    }

    pub(crate) fn is_sphere(&self) -> bool {
        self.flattening == 0.0 && self.stem_cavity == 0.0 && self.calyx_cavity == 0.0
    }

    pub(crate) fn transformed(mut self, by: &Isometry3<f64>) -> Self {
        self.center = by * self.center;
        self.axis = by * self.axis;
        self
    }

    /// Derivative of `reach` by the cosine.
    fn reach_slope(&self, c: f64) -> f64 {
        let stem = self.stem_cavity * ((c - 1.0) / CAVITY_WIDTH).exp() / CAVITY_WIDTH;
        let calyx = self.calyx_cavity * (-(c + 1.0) / CAVITY_WIDTH).exp() / CAVITY_WIDTH;
        self.radius * (-2.0 * self.flattening * c - stem + calyx)
    }

    pub(crate) fn hit(&self, ray: &Ray) -> Option<f64> {
        let (enter, leave) = ray.through_ball(&self.center, self.radius)?;
        if leave <= 0.0 {
            return None;
        }
        if self.is_sphere() {
            return Some(if enter > 0.0 { enter } else { leave });
        }
        // The distance bound |p| − R(c) has a gradient of at most 1.3 for the
        // cavities allowed, so that steps of 0.75 of it cannot jump the surface. A
        // least step keeps grazing rays going; what it enters the flesh is undone.
        let scale = 0.75 / ray.direction.norm();
        let (mut t, mut last_gap, mut step) = (enter.max(0.0), 0.0, 0.0);
        while t <= leave {
            let offset = ray.at(t) - self.center;
            let distance = offset.norm();
            let gap = distance - self.reach(offset.dot(&self.axis) / distance.max(1e-12));
            if gap < 1e-6 {
                let back = if gap < 0.0 && last_gap > gap {
                    gap / (last_gap - gap)
                } else {
                    0.0
                };
                return Some(t + step * back);
            }
            step = (gap * scale).max(2e-5);
            last_gap = gap;
            t += step;
        }
        None
    }

    /// Texture: u the turn about the stem in radians, v the cosine of the angle to it.
    pub(crate) fn surface(&self, point: &Point3<f64>) -> Surface {
        let offset = point - self.center;
        let distance = offset.norm().max(1e-12);
        let outward = offset / distance;
        let c = outward.dot(&self.axis).clamp(-1.0, 1.0);
        let normal = if self.is_sphere() {
            outward
        } else {
            let sideways = (self.axis.into_inner() - outward * c) / distance;
            (outward - sideways * self.reach_slope(c)).normalize()
        };
        let (e, f) = frame_across(&self.axis);
        Surface {
            normal,
            u: outward.dot(&f).atan2(outward.dot(&e)),
            v: c,
        }
    }
}

/// Two unit vectors across `axis` and each other.
pub(crate) fn frame_across(axis: &Unit<Vector3<f64>>) -> (Vector3<f64>, Vector3<f64>) {
    let least = axis.iamin();
    let mut helper = Vector3::zeros();
    helper[least] = 1.0;
    let e = axis.cross(&helper).normalize();
    (e, axis.cross(&e))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flattened() -> Apple {
        Apple {
            flattening: 0.1,
            stem_cavity: 0.25,
            calyx_cavity: 0.1,
            ..Apple::sphere(Point3::new(0.01, -0.02, 0.8), 0.04)
        }
    }

    #[test]
    fn rays_stop_on_the_surface_and_the_normal_is_its_gradient() {
        let apple = flattened();
        for i in 0..200 {
            let turn = f64::from(i) * 0.4;
            let spread = 0.0395 * (f64::from(i) / 200.0).sqrt();
            let target = apple.center + Vector3::new(spread * turn.cos(), spread * turn.sin(), 0.0);
            let ray = Ray {
                origin: Point3::origin(),
                direction: target.coords / target.z,
            };
            let Some(t) = apple.hit(&ray) else { continue };
            let level = |p: Point3<f64>| {
                let o = p - apple.center;
                o.norm() - apple.reach(o.dot(&apple.axis) / o.norm())
            };
            let p = ray.at(t);
            assert!(level(p).abs() < 2e-6);
            let h = 1e-7;
            let gradient = Vector3::from_fn(|k, _| {
                let mut step = Vector3::zeros();
                step[k] = h;
                (level(p + step) - level(p - step)) / (2.0 * h)
            });
            assert!((gradient.normalize() - apple.surface(&p).normal).norm() < 1e-5);
        }
    }

    #[test]
    fn poles_are_lower_and_the_waist_is_the_radius() {
        let apple = flattened();
        assert!((apple.reach(0.0) - apple.radius).abs() < 1e-9);
        assert!((apple.reach(1.0) - 0.65 * apple.radius).abs() < 1e-6);
        assert!((apple.stem_foot() - apple.center).norm() < apple.radius);
    }
}
