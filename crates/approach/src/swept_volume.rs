//! The parts of a gripper, at rest or swept along a motion, and their distances.

use nalgebra::{Isometry3, Point3, Vector3};
use pomona_geometry::Segment;

/// A sphere-swept rectangle: the points within `radius` of it (Larsen et al. 1999, "Fast Proximity Queries with Swept
/// Sphere Volumes"). With one side of length 0 it is a capsule, with both a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SweptVolume {
    corner: Point3<f64>,
    /// Sides, perpendicular to each other; either may be 0.
    u: Vector3<f64>,
    v: Vector3<f64>,
    /// 1 / ‖u‖² and 1 / ‖v‖², or 0 where that side is 0.
    inverse_uu: f64,
    inverse_vv: f64,
    pub(crate) radius: f64,
}

fn inverse(squared: f64) -> f64 {
    if squared > 0.0 { 1.0 / squared } else { 0.0 }
}

impl SweptVolume {
    pub(crate) fn rectangle(
        corner: Point3<f64>,
        u: Vector3<f64>,
        v: Vector3<f64>,
        radius: f64,
    ) -> Self {
        Self {
            corner,
            u,
            v,
            inverse_uu: inverse(u.norm_squared()),
            inverse_vv: inverse(v.norm_squared()),
            radius,
        }
    }

    pub(crate) fn capsule(start: Point3<f64>, end: Point3<f64>, radius: f64) -> Self {
        Self::rectangle(start, end - start, Vector3::zeros(), radius)
    }

    /// The same, moved.
    pub(crate) fn moved(&self, pose: &Isometry3<f64>) -> Self {
        Self {
            corner: pose * self.corner,
            u: pose * self.u,
            v: pose * self.v,
            ..*self
        }
    }

    /// What this volume, a capsule, sweeps while it moves by `path`.
    ///
    /// Exact where `path` is parallel or perpendicular to the capsule's axis, which holds for a
    /// gripper in its straight motion.
    pub(crate) fn swept(&self, path: Vector3<f64>) -> Self {
        let along = self.u.dot(&path);
        if along.abs() > 0.5 * self.u.norm() * path.norm() {
            let (start, end) = if along > 0.0 {
                (self.corner, self.corner + self.u + path)
            } else {
                (self.corner + path, self.corner + self.u)
            };
            return Self::capsule(start, end, self.radius);
        }
        Self::rectangle(self.corner, self.u, path, self.radius)
    }

    pub(crate) fn center(&self) -> Point3<f64> {
        self.corner + (self.u + self.v) * 0.5
    }

    /// Distance of the farthest point from the centre.
    pub(crate) fn reach(&self) -> f64 {
        0.5 * (self.u.norm_squared() + self.v.norm_squared()).sqrt() + self.radius
    }

    /// The corners of its rectangle.
    pub(crate) fn corners(&self) -> [Point3<f64>; 4] {
        let c = self.corner;
        [c, c + self.u, c + self.u + self.v, c + self.v]
    }

    /// Distance of the surface from a point, negative inside.
    #[inline(always)]
    pub(crate) fn distance_to_point(&self, point: &Point3<f64>) -> f64 {
        let w = point - self.corner;
        let a = (w.dot(&self.u) * self.inverse_uu).clamp(0.0, 1.0);
        let b = (w.dot(&self.v) * self.inverse_vv).clamp(0.0, 1.0);
        (w - self.u * a - self.v * b).norm() - self.radius
    }

    /// Distance of the surface from a segment, and the segment's point nearest to it; negative where the segment enters
    /// the volume, and then no deeper than the radius.
    pub(crate) fn distance_to_segment(&self, segment: &Segment) -> (f64, Point3<f64>) {
        let first = Segment {
            start: self.corner,
            end: self.corner + self.u,
        };
        let mut best = segment_distance(&first, segment);
        if self.inverse_vv > 0.0 {
            if let Some(point) = self.pierced(segment) {
                return (-self.radius, point);
            }
            let [a, b, c, d] = self.corners();
            for (start, end) in [(b, c), (c, d), (d, a)] {
                let found = segment_distance(&Segment { start, end }, segment);
                if found.0 < best.0 {
                    best = found;
                }
            }
            for end in [segment.start, segment.end] {
                let distance = self.distance_to_point(&end) + self.radius;
                if distance < best.0 {
                    best = (distance, end);
                }
            }
        }
        (best.0 - self.radius, best.1)
    }

    /// Where the segment passes through the rectangle.
    fn pierced(&self, segment: &Segment) -> Option<Point3<f64>> {
        let normal = self.u.cross(&self.v);
        let (from, to) = (
            normal.dot(&(segment.start - self.corner)),
            normal.dot(&(segment.end - self.corner)),
        );
        if from * to > 0.0 || from == to {
            return None;
        }
        let point = segment.start + (segment.end - segment.start) * (from / (from - to));
        let w = point - self.corner;
        let inside = |share: f64| (0.0..=1.0).contains(&share);
        let a = w.dot(&self.u) * self.inverse_uu;
        let b = w.dot(&self.v) * self.inverse_vv;
        (inside(a) && inside(b)).then_some(point)
    }
}

/// Distance of two segments, and the point of the second that is nearest to the first.
///
/// Ericson 2005, "Real-Time Collision Detection", Section 5.1.9; segments may have no length.
pub(crate) fn segment_distance(first: &Segment, second: &Segment) -> (f64, Point3<f64>) {
    let (d1, d2) = (first.end - first.start, second.end - second.start);
    let r = first.start - second.start;
    let (a, e) = (d1.norm_squared(), d2.norm_squared());
    let (c, f) = (d1.dot(&r), d2.dot(&r));
    let (s, t);
    if a <= 0.0 && e <= 0.0 {
        (s, t) = (0.0, 0.0);
    } else if a <= 0.0 {
        (s, t) = (0.0, (f / e).clamp(0.0, 1.0));
    } else if e <= 0.0 {
        (s, t) = ((-c / a).clamp(0.0, 1.0), 0.0);
    } else {
        let b = d1.dot(&d2);
        let denominator = a * e - b * b;
        let free = if denominator > 0.0 {
            ((b * f - c * e) / denominator).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let along = (b * free + f) / e;
        if along < 0.0 {
            (s, t) = ((-c / a).clamp(0.0, 1.0), 0.0);
        } else if along > 1.0 {
            (s, t) = (((b - c) / a).clamp(0.0, 1.0), 1.0);
        } else {
            (s, t) = (free, along);
        }
    }
    let nearest = second.start + d2 * t;
    ((first.start + d1 * s - nearest).norm(), nearest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vector3<f64>> {
        prop::array::uniform3(-1.0..1.0f64).prop_map(Vector3::from)
    }

    fn point() -> impl Strategy<Value = Point3<f64>> {
        vector().prop_map(Point3::from)
    }

    fn rectangle() -> impl Strategy<Value = SweptVolume> {
        (point(), vector(), vector(), 0.0..2.0f64).prop_filter_map("flat", |(corner, u, v, l)| {
            let v = u.cross(&v).try_normalize(1e-3)? * l;
            Some(SweptVolume::rectangle(corner, u, v, 0.1))
        })
    }

    /// The least distance over a lattice of the rectangle's points, and the lattice's step.
    fn by_lattice(body: &SweptVolume, segment: &Segment) -> (f64, f64) {
        const N: usize = 60;
        let mut least = f64::INFINITY;
        for i in 0..=N {
            for j in 0..=N {
                let p =
                    body.corner + body.u * (i as f64 / N as f64) + body.v * (j as f64 / N as f64);
                least = least.min(segment.distance(&p));
            }
        }
        (
            least - body.radius,
            (body.u.norm() + body.v.norm()) / N as f64,
        )
    }

    proptest! {
        #[test]
        fn distances_agree_with_a_lattice(body in rectangle(), a in point(), b in point()) {
            let segment = Segment::new(a, b).unwrap();
            let (distance, nearest) = body.distance_to_segment(&segment);
            let (least, step) = by_lattice(&body, &segment);
            prop_assert!(distance <= least + 1e-12 && distance >= least - step, "{distance} {least}");
            prop_assert!((body.distance_to_point(&nearest) - distance).abs() < 1e-9);
            let ball = Segment::new(a, a).unwrap();
            let (distance, _) = body.distance_to_segment(&ball);
            prop_assert!((body.distance_to_point(&a) - distance).abs() < 1e-12);
        }

        #[test]
        fn a_sweep_holds_every_position(a in point(), axis in vector(), l in -1.0..1.0f64, p in point(), share in 0.0..1.0f64) {
            prop_assume!(axis.norm() > 1e-3);
            let rod = SweptVolume::capsule(a, a + axis, 0.05);
            let across = axis.cross(&Vector3::new(0.3, 0.7, 0.2)).normalize() * l;
            for path in [axis * l, across] {
                let part = rod.moved(&Isometry3::from_parts((path * share).into(), nalgebra::UnitQuaternion::identity()));
                prop_assert!(rod.swept(path).distance_to_point(&p) <= part.distance_to_point(&p) + 1e-12);
            }
        }
    }

    #[test]
    fn distances_by_hand() {
        let body = SweptVolume::rectangle(Point3::origin(), Vector3::x(), Vector3::y(), 0.25);
        let line = |a: [f64; 3], b: [f64; 3]| Segment::new(a.into(), b.into()).unwrap();
        assert_eq!(body.distance_to_point(&Point3::new(0.5, 0.5, 1.0)), 0.75);
        assert_eq!(body.distance_to_point(&Point3::new(4.0, 5.0, 0.0)), 4.75);
        let through = line([0.5, 0.5, -1.0], [0.5, 0.5, 3.0]);
        assert_eq!(body.distance_to_segment(&through).0, -0.25);
        let above = line([-3.0, 0.5, 1.0], [3.0, 0.5, 1.0]);
        assert_eq!(body.distance_to_segment(&above).0, 0.75);
        let flat = line([0.2, 0.5, 0.0], [0.4, 0.5, 0.0]);
        assert_eq!(body.distance_to_segment(&flat).0, -0.25);
        assert_eq!(body.reach(), 0.5_f64.sqrt() + 0.25);
        assert_eq!(body.center(), Point3::new(0.5, 0.5, 0.0));
    }
}
