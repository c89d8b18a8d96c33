//! Apples, spurs, leaves and shoots added to branches, in a level frame (x right, y down, z away).

use crate::apple::{Apple, Variety};
use crate::curve::Curve;
use crate::leaf::Leaf;
use crate::random::Normal;
use crate::world::{Bark, Branch, World};
use nalgebra::{Point3, Unit, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::ops::Range;

/// A world under construction, with its random numbers.
pub(crate) struct Grower {
    pub(crate) world: World,
    pub(crate) rng: ChaCha8Rng,
}

/// How an apple hangs on a branch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hanging {
    /// Number of the branch.
    pub(crate) branch: usize,
    /// Parameter of the branch's curve at which the apple is nearest to it.
    pub(crate) at: f64,
    /// Direction from the branch to the apple; made to stand across the branch.
    pub(crate) toward: Vector3<f64>,
    /// Distance of the apple's centre from the branch's centre line, metres.
    pub(crate) distance: f64,
}

impl Grower {
    pub(crate) fn new(world: World, rng: ChaCha8Rng) -> Self {
        Self { world, rng }
    }

    pub(crate) fn between(&mut self, range: Range<f64>) -> f64 {
        range.start + (range.end - range.start) * self.rng.random::<f64>()
    }

    /// Three independent standard normal numbers: no direction is preferred.
    /// An apple at the origin, flattened and with cavities as apples differ.
    pub(crate) fn apple(&mut self, radius: f64, variety: Variety) -> Apple {
        Apple {
            flattening: self.between(0.0..0.14),
            stem_cavity: self.between(0.12..0.30),
            calyx_cavity: self.between(0.0..0.12),
            variety,
            ..Apple::sphere(Point3::origin(), radius)
        }
    }

    pub(crate) fn isotropic(&mut self) -> Vector3<f64> {
        let mut normal = Normal::default();
        Vector3::from_fn(|_, _| normal.draw(&mut self.rng))
    }

    /// Whether a ball meets no apple and no branch but its own.
    pub(crate) fn is_free(&self, center: &Point3<f64>, radius: f64, own: usize) -> bool {
        let world = &self.world;
        let apples = world
            .apples()
            .iter()
            .all(|a| (a.center - center).norm() > a.radius + radius);
        let branches = world.branches().iter().enumerate().all(|(i, b)| {
            let s = b.curve.nearest(center);
            i == own || (b.curve.point(s) - center).norm() > radius + b.radius_at(s)
        });
        apples && branches
    }

    /// Puts `apple` (its centre and axis are set here) on a branch, by a spur and a peduncle.
    pub(crate) fn hang(&mut self, apple: Apple, how: &Hanging) -> usize {
        let branch = self.world.branches[how.branch];
        let foot = branch.curve.point(how.at);
        let tangent = branch.curve.derivative(how.at).normalize();
        let across = across(&how.toward, &tangent);
        let center = foot + across * how.distance;
        let lean = self.isotropic() * 0.15;
        let axis = Unit::new_normalize(-across * 0.75 - Vector3::y() * 0.6 + lean);
        let apple = Apple {
            center,
            axis,
            ..apple
        };
        let index = self.world.add_apple(apple);
        self.stalk(&apple, &branch, how.at, &tangent);
        index
    }

    /// A spur a little aside on the branch, and the peduncle from it to the apple.
    fn stalk(&mut self, apple: &Apple, branch: &Branch, at: f64, tangent: &Vector3<f64>) {
        let aside = self.between(-0.02..0.02);
        let root_at = branch
            .curve
            .nearest(&(branch.curve.point(at) + tangent * aside));
        let root = branch.curve.point(root_at);
        let stem = apple.stem_foot();
        let outward = (stem - root).normalize();
        let thickness = branch.radius_at(root_at);
        let length = (stem - root).norm();
        let tip = root + outward * (thickness + 0.35 * (length - thickness).max(0.0));
        let spur = (0.6 * thickness).clamp(0.0015, 0.0035);
        let wood = Branch {
            curve: Curve::straight(root, tip),
            start_radius: spur,
            end_radius: 0.8 * spur,
        };
        self.world.add_twig(&wood, Bark::Wood);
        let curve = Curve::bow(stem, apple.axis.into_inner(), tip);
        let peduncle = Branch {
            curve,
            start_radius: 0.0012,
            end_radius: 0.0016,
        };
        self.world.add_twig(&peduncle, Bark::Green);
    }

    /// Leaves that spread from `at`, on stalks, about the direction `outward`.
    pub(crate) fn rosette(&mut self, at: Point3<f64>, outward: Vector3<f64>, count: usize) {
        for _ in 0..count {
            let spread = self.isotropic() * 0.7;
            let heading = (outward.normalize() + spread).normalize();
            let stalk_length = self.between(0.012..0.03);
            self.leaf_on_stalk(at, heading, stalk_length);
        }
    }

    /// A leaf on a green stalk of its own; none where it would pierce an apple each time it is tried.
    pub(crate) fn leaf_on_stalk(
        &mut self,
        at: Point3<f64>,
        heading: Vector3<f64>,
        stalk_length: f64,
    ) {
        for attempt in 0..4 {
            let heading = heading + self.isotropic() * (0.25 * f64::from(attempt));
            let base = at + heading.normalize() * stalk_length;
            let length = self.between(0.05..0.085);
            let Some(leaf) = self.draw_leaf(base, heading, length) else {
                continue;
            };
            if self.world.apples.iter().any(|apple| pierces(&leaf, apple)) {
                continue;
            }
            let curve = Curve::straight(at, base);
            let stalk = Branch {
                curve,
                start_radius: 0.0009,
                end_radius: 0.0007,
            };
            self.world.add_twig(&stalk, Bark::Green);
            self.world.add_leaf(leaf);
            return;
        }
    }

    /// A leaf from `base`, hanging a little, its upper side towards sky and sun.
    fn draw_leaf(&mut self, base: Point3<f64>, heading: Vector3<f64>, length: f64) -> Option<Leaf> {
        let hang = Vector3::y() * self.between(0.1..0.5);
        let sun = self.world.light.toward_sun.into_inner();
        let up = -Vector3::y() * 0.9 + sun * 0.5 + self.isotropic() * 0.45;
        let width = length * self.between(0.48..0.62);
        let leaf = Leaf::new(base, heading + hang, up, length, width)?;
        let bend = self.between(-0.40..-0.05);
        let cup = self.between(0.1..0.7);
        let tint = self.between(0.1..0.9);
        Some(Leaf {
            bend,
            cup,
            tint,
            ..leaf
        })
    }

    /// A thin shoot with leaves on alternating sides.
    pub(crate) fn shoot(&mut self, from: Point3<f64>, heading: Vector3<f64>, length: f64) {
        let heading = heading.normalize();
        let end = from + heading * length + self.isotropic() * (0.08 * length);
        let curve = Curve::bow(from, heading + self.isotropic() * 0.15, end);
        self.world.add_twig(
            &Branch {
                curve,
                start_radius: 0.0026,
                end_radius: 0.0013,
            },
            Bark::Wood,
        );
        let leaves = (length / 0.022) as usize;
        for i in 1..=leaves {
            let s = i as f64 / leaves as f64;
            // The golden angle apart, as leaves stand on apple shoots (2/5 phyllotaxis or near it).
            let turn = 2.4 * i as f64;
            let along = curve.derivative(s).normalize();
            let (e, f) = crate::apple::frame_across(&Unit::new_unchecked(along));
            let side = e * turn.cos() + f * turn.sin();
            let stalk = self.between(0.012..0.024);
            self.leaf_on_stalk(curve.point(s), (along * 0.6 + side).normalize(), stalk);
        }
    }

    /// Rosettes along a branch every `spacing` metres, on sides that turn as they go.
    pub(crate) fn dress(
        &mut self,
        branch: usize,
        parameters: Range<f64>,
        spacing: f64,
        leaves: usize,
    ) {
        let branch = self.world.branches[branch];
        let length = branch.curve.length() * (parameters.end - parameters.start);
        let count = (length / spacing).floor().max(1.0) as usize;
        for i in 0..count {
            let jitter = self.between(0.1..0.9);
            let share = (i as f64 + jitter) / count as f64;
            let s = parameters.start + (parameters.end - parameters.start) * share;
            let tangent = branch.curve.derivative(s).normalize();
            let side = across(&(self.isotropic() - Vector3::y() * 0.8), &tangent);
            let at = branch.curve.point(s);
            let tip = at + side * (branch.radius_at(s) + self.between(0.004..0.015));
            let curve = Curve::straight(at, tip);
            self.world.add_twig(
                &Branch {
                    curve,
                    start_radius: 0.0028,
                    end_radius: 0.0022,
                },
                Bark::Wood,
            );
            self.rosette(tip, side, leaves);
        }
    }
}

/// Whether a leaf's blade enters an apple, by points along its midrib and its sides.
pub(crate) fn pierces(leaf: &Leaf, apple: &Apple) -> bool {
    leaf.blade_points()
        .any(|p| (p - apple.center).norm() < apple.radius + 0.001)
}

/// The part of `vector` across the unit vector `along`, of length one; any direction
/// across where the two are parallel.
pub(crate) fn across(vector: &Vector3<f64>, along: &Vector3<f64>) -> Vector3<f64> {
    let part = vector - along * vector.dot(along);
    part.try_normalize(1e-6)
        .unwrap_or_else(|| crate::apple::frame_across(&Unit::new_unchecked(*along)).0)
}
