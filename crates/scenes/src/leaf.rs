use crate::ray::{Ray, Surface};
use nalgebra::{Isometry3, Point3, Unit, Vector3};

/// A thin leaf, bent along its midrib and cupped across it.
///
/// In its own axes (u along the midrib from the stalk, v across, w up) the
/// blade is the paraboloid w = b·u²/length + k·v²/width inside an egg-shaped
/// outline, b being `bend` and k `cup`: a ray meets it in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf {
    /// Where the stalk meets the blade.
    pub base: Point3<f64>,
    /// Direction of the midrib at the base.
    pub along: Unit<Vector3<f64>>,
    /// Upper side's normal at the base; across `along`.
    pub up: Unit<Vector3<f64>>,
    /// Length along the midrib's first direction, metres.
    pub length: f64,
    /// Greatest width, metres.
    pub width: f64,
    /// Height of the tip over the base's plane, share of the length; negative hangs.
    pub bend: f64,
    /// Height of the sides over the midrib, share of a quarter of the width.
    pub cup: f64,
    /// Shade of green, 0 (dark) to 1 (fresh).
    pub tint: f64,
}

impl Leaf {
    /// A leaf from `base` towards `along`, its upper side as near to `up` as that allows;
    /// `None` where the two are parallel or have no length.
    pub fn new(
        base: Point3<f64>,
        along: Vector3<f64>,
        up: Vector3<f64>,
        length: f64,
        width: f64,
    ) -> Option<Self> {
        let along = Unit::try_new(along, 1e-12)?;
        let up = Unit::try_new(up - along.into_inner() * up.dot(&along), 1e-9)?;
        Some(Self {
            base,
            along,
            up,
            length,
            width,
            bend: -0.15,
            cup: 0.3,
            tint: 0.5,
        })
    }

    fn across(&self) -> Vector3<f64> {
        self.up.cross(&self.along)
    }

    pub(crate) fn transformed(mut self, by: &Isometry3<f64>) -> Self {
        self.base = by * self.base;
        self.along = by * self.along;
        self.up = by * self.up;
        self
    }

    /// Coefficients of w = ku·u² + kv·v².
    fn curvature(&self) -> (f64, f64) {
        (self.bend / self.length, self.cup / self.width)
    }

    fn inside(&self, u: f64, v: f64) -> bool {
        let x = u / self.length;
        if !(0.0..=1.0).contains(&x) || v.abs() > 0.5 * self.width {
            return false;
        }
        // Egg shape x^0.6 (1 − x)^0.8, which peaks at x = 3/7 with 0.3845; small teeth.
        let outline = x.powf(0.6) * (1.0 - x).powf(0.8) / 0.3845;
        let teeth = 1.0 - 0.04 * (70.0 * x).sin().abs();
        v.abs() <= 0.5 * self.width * outline * teeth
    }

    pub(crate) fn hit(&self, ray: &Ray) -> Option<f64> {
        let (ku, kv) = self.curvature();
        let m = ray.origin - self.base;
        let across = self.across();
        let (mu, mv, mw) = (m.dot(&self.along), m.dot(&across), m.dot(&self.up));
        let d = &ray.direction;
        let (du, dv, dw) = (d.dot(&self.along), d.dot(&across), d.dot(&self.up));
        // ku (mu + t du)² + kv (mv + t dv)² − (mw + t dw) = 0
        let a = ku * du * du + kv * dv * dv;
        let half_b = ku * mu * du + kv * mv * dv - 0.5 * dw;
        let c = ku * mu * mu + kv * mv * mv - mw;
        let accept = |t: f64| (t > 1e-9 && self.inside(mu + t * du, mv + t * dv)).then_some(t);
        let discriminant = half_b * half_b - a * c;
        if discriminant < 0.0 {
            return None;
        }
        // q keeps its digits where a is small; the flat leaf (a = 0) is the second root alone.
        let q = -(half_b + half_b.signum() * discriminant.sqrt());
        let roots = [q / a, c / q].map(|t| if t.is_finite() { accept(t) } else { None });
        match roots {
            [Some(s), Some(t)] => Some(s.min(t)),
            [s, t] => s.or(t),
        }
    }

    /// Texture: u the way from base to tip in 0..1, v the way across in −1..1.
    pub(crate) fn surface(&self, point: &Point3<f64>) -> Surface {
        let (ku, kv) = self.curvature();
        let across = self.across();
        let m = point - self.base;
        let (u, v) = (m.dot(&self.along), m.dot(&across));
        let slope = self.along.into_inner() * (2.0 * ku * u) + across * (2.0 * kv * v);
        let normal = (self.up.into_inner() - slope).normalize();
        Surface {
            normal,
            u: u / self.length,
            v: 2.0 * v / self.width,
        }
    }

    /// Points spread over the blade.
    pub(crate) fn blade_points(&self) -> impl Iterator<Item = Point3<f64>> + '_ {
        let (ku, kv) = self.curvature();
        let across = self.across();
        (0..27).map(move |i| {
            let u = self.length * f64::from(i / 3) / 8.0;
            // The blade is widest near its middle and ends in points.
            let v = 0.4 * self.width * f64::from(i % 3 - 1);
            let w = ku * u * u + kv * v * v;
            self.base + self.along.into_inner() * u + across * v + self.up.into_inner() * w
        })
    }

    /// The corners of a box that holds the blade.
    pub(crate) fn corners(&self) -> [Point3<f64>; 8] {
        let across = self.across();
        let heights = [self.bend * self.length, 0.25 * self.cup * self.width];
        let low = heights.iter().map(|h| h.min(0.0)).sum::<f64>();
        let high = heights.iter().map(|h| h.max(0.0)).sum::<f64>();
        std::array::from_fn(|i| {
            let u = if i & 1 == 0 { 0.0 } else { self.length };
            let v = if i & 2 == 0 { -0.5 } else { 0.5 } * self.width;
            let w = if i & 4 == 0 { low } else { high };
            self.base + self.along.into_inner() * u + across * v + self.up.into_inner() * w
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_stop_on_the_blade_inside_its_box() {
        let mut leaf = Leaf::new(
            Point3::new(-0.03, 0.0, 0.7),
            Vector3::new(1.0, 0.2, 0.1),
            Vector3::new(0.0, -0.5, -1.0),
            0.07,
            0.04,
        )
        .unwrap();
        leaf.bend = -0.3;
        let corners = leaf.corners();
        let mut hits = 0;
        for i in 0..40 {
            for j in 0..40 {
                let direction = Vector3::new(
                    -0.06 + 0.004 * f64::from(i),
                    -0.06 + 0.004 * f64::from(j),
                    1.0,
                );
                let ray = Ray {
                    origin: Point3::origin(),
                    direction,
                };
                let Some(t) = leaf.hit(&ray) else { continue };
                hits += 1;
                let p = ray.at(t);
                for k in 0..3 {
                    let min = corners.iter().map(|c| c[k]).fold(f64::INFINITY, f64::min);
                    let max = corners
                        .iter()
                        .map(|c| c[k])
                        .fold(f64::NEG_INFINITY, f64::max);
                    assert!(min - 1e-9 <= p[k] && p[k] <= max + 1e-9);
                }
                let surface = leaf.surface(&p);
                assert!((0.0..=1.0).contains(&surface.u) && surface.v.abs() <= 1.0);
            }
        }
        assert!(hits > 50, "{hits} hits");
    }

    #[test]
    fn a_flat_leaf_is_met_too() {
        let mut leaf = Leaf::new(
            Point3::new(-0.03, 0.0, 0.5),
            Vector3::x(),
            -Vector3::z(),
            0.06,
            0.03,
        )
        .unwrap();
        leaf.bend = 0.0;
        leaf.cup = 0.0;
        let ray = Ray {
            origin: Point3::origin(),
            direction: Vector3::z(),
        };
        assert!((leaf.hit(&ray).unwrap() - 0.5).abs() < 1e-12);
    }
}
