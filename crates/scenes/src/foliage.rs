//! Leaves as dense as in a hedge: curled, in rosettes at spurs and along shoots.

use crate::apple::frame_across;
use crate::curve::Curve;
use crate::grow::{Grower, across, pierces};
use crate::leaf::Leaf;
use crate::world::{Bark, Branch};
use nalgebra::{Point3, Unit, Vector3};
use std::ops::Range;

/// Length of a leaf, metres: apple leaves of 5 to 10 cm.
const LEAF_LENGTH: Range<f64> = 0.045..0.095;

/// Width of a leaf, share of its length.
const LEAF_WIDTH: Range<f64> = 0.40..0.60;

/// Distance of the leaves along a shoot, metres.
const LEAF_SPACING: f64 = 0.022;

/// Angle between one leaf of a shoot and the next, radians: the golden angle, to which 2/5 phyllotaxis is near.
const LEAF_TURN: f64 = 2.4;

impl Grower {
    /// A curled leaf on a green stalk; none where it would pierce an apple each time it is tried.
    pub(crate) fn curled_leaf(&mut self, at: Point3<f64>, heading: Vector3<f64>, stalk: f64) {
        for attempt in 0..3 {
            let heading = heading + self.isotropic() * (0.25 * f64::from(attempt));
            let base = at + heading.normalize() * stalk;
            let Some(leaf) = self.draw_curled_leaf(base, heading) else {
                continue;
            };
            if self
                .world
                .apples()
                .iter()
                .any(|apple| pierces(&leaf, apple))
            {
                continue;
            }
            self.world.add_twig(
                &Branch {
                    curve: Curve::straight(at, base),
                    start_radius: 0.0010,
                    end_radius: 0.0007,
                },
                Bark::Green,
            );
            self.world.add_leaf(leaf);
            return;
        }
    }

    fn draw_curled_leaf(&mut self, base: Point3<f64>, heading: Vector3<f64>) -> Option<Leaf> {
        let hang = Vector3::y() * self.between(0.1..0.9);
        let up = -Vector3::y() * 0.8 + self.isotropic() * 0.55;
        let length = self.between(LEAF_LENGTH);
        let width = length * self.between(LEAF_WIDTH);
        let leaf = Leaf::new(base, heading + hang, up, length, width)?;
        let bend = self.between(-0.7..0.05);
        let cup = self.between(0.1..1.3);
        let tint = self.between(0.0..1.0).powi(2);
        Some(Leaf {
            bend,
            cup,
            tint,
            ..leaf
        })
    }

    /// A short spur of wood on a branch, with a rosette of leaves at its tip.
    pub(crate) fn leafy_spur(&mut self, branch: usize, at: f64, leaves: usize) {
        let branch = self.world.branches()[branch];
        let root = branch.curve.point(at);
        let tangent = branch.curve.derivative(at).normalize();
        let side = across(&(self.isotropic() - Vector3::y() * 0.6), &tangent);
        let tip = root + side * (branch.radius_at(at) + self.between(0.006..0.03));
        let clear = |apple: &crate::apple::Apple| {
            (tip - apple.center).norm() > apple.radius + 0.003
                && (root + (tip - root) * 0.5 - apple.center).norm() > apple.radius + 0.003
        };
        if !self.world.apples().iter().all(clear) {
            return;
        }
        self.world.add_twig(
            &Branch {
                curve: Curve::straight(root, tip),
                start_radius: 0.0026,
                end_radius: 0.0020,
            },
            Bark::Wood,
        );
        self.curled_rosette(tip, side, leaves);
    }

    /// Curled leaves that spread from `at` about the direction `outward`.
    pub(crate) fn curled_rosette(&mut self, at: Point3<f64>, outward: Vector3<f64>, leaves: usize) {
        for _ in 0..leaves {
            let heading = (outward.normalize() + self.isotropic() * 0.75).normalize();
            let stalk = self.between(0.012..0.035);
            self.curled_leaf(at, heading, stalk);
        }
    }

    /// A thin shoot with curled leaves all along.
    pub(crate) fn leafy_shoot(&mut self, from: Point3<f64>, heading: Vector3<f64>, length: f64) {
        let heading = heading.normalize();
        let end = from + heading * length + self.isotropic() * (0.08 * length);
        let curve = Curve::bow(from, heading + self.isotropic() * 0.15, end);
        let clear = |s: i32| {
            let point = curve.point(f64::from(s) / 8.0);
            let far = |a: &crate::apple::Apple| (point - a.center).norm() > a.radius + 0.002;
            self.world.apples().iter().all(far)
        };
        if !(0..=8).all(clear) {
            return;
        }
        let start_radius = self.between(0.0013..0.0021);
        self.world.add_twig(
            &Branch {
                curve,
                start_radius,
                end_radius: 0.0009,
            },
            Bark::Wood,
        );
        let leaves = (length / LEAF_SPACING) as usize;
        for i in 1..=leaves {
            let s = i as f64 / leaves as f64;
            let turn = LEAF_TURN * i as f64;
            let along = curve.derivative(s).normalize();
            let (e, f) = frame_across(&Unit::new_unchecked(along));
            let side = e * turn.cos() + f * turn.sin();
            let stalk = self.between(0.012..0.03);
            self.curled_leaf(curve.point(s), (along * 0.6 + side).normalize(), stalk);
        }
    }
}
