use crate::apple::Apple;
use crate::curve::Curve;
use crate::leaf::Leaf;
use crate::light::Light;
use crate::limb::LimbPiece;
use crate::ray::{Ray, Surface};
use crate::scenery::Scenery;
use nalgebra::{Isometry3, Point3, Vector3};
use pomona_geometry::{Line, Plane};

/// A branch: a limb that bears apples and is part of the ground truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Centre line.
    pub curve: Curve,
    /// Radius at the curve's start, metres.
    pub start_radius: f64,
    /// Radius at the curve's end, metres.
    pub end_radius: f64,
}

impl Branch {
    /// Radius at the curve's parameter `s`: it grows evenly with the parameter.
    pub fn radius_at(&self, s: f64) -> f64 {
        self.start_radius + (self.end_radius - self.start_radius) * s
    }

    /// The tangent of the centre line at `s`; `None` where the curve stands still.
    pub fn tangent(&self, s: f64) -> Option<Line> {
        Line::new(self.curve.point(s), self.curve.derivative(s))
    }
}

/// The object to which a visible pixel belongs; indices count in the order of addition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner {
    /// An apple.
    Apple(usize),
    /// A branch.
    Branch(usize),
    /// A spur or a peduncle: wood, but no branch.
    Twig,
    /// A leaf.
    Leaf,
    /// The backdrop.
    Backdrop,
}

/// What a branch or twig is covered with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bark {
    /// Grey-brown, streaked.
    Wood,
    /// The green stem of a fruit or a leaf.
    Green,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Apple(Apple),
    Limb(LimbPiece, Bark),
    Leaf(Leaf),
    Plane(Plane),
}

/// A shape and whose it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) shape: Shape,
    pub(crate) owner: Owner,
}

impl Part {
    pub(crate) fn hit(&self, ray: &Ray) -> Option<f64> {
        match &self.shape {
            Shape::Apple(apple) => apple.hit(ray),
            Shape::Limb(limb, _) => limb.hit(ray),
            Shape::Leaf(leaf) => leaf.hit(ray),
            Shape::Plane(plane) => {
                let height = plane.offset - plane.normal.dot(&ray.origin.coords);
                let t = height / plane.normal.dot(&ray.direction);
                (t > 1e-9 && t.is_finite()).then_some(t)
            }
        }
    }

    pub(crate) fn surface(&self, point: &Point3<f64>) -> Surface {
        match &self.shape {
            Shape::Apple(apple) => apple.surface(point),
            Shape::Limb(limb, _) => limb.surface(point),
            Shape::Leaf(leaf) => leaf.surface(point),
            Shape::Plane(plane) => Surface {
                normal: plane.normal.into_inner(),
                u: point.x,
                v: point.y,
            },
        }
    }

    /// Points whose convex hull holds the part; `None` for a plane, which has no end.
    pub(crate) fn hull(&self) -> Option<Vec<Point3<f64>>> {
        let cube = |center: Point3<f64>, radius: f64| {
            (0..8).map(move |i| {
                let side = |bit: usize| if i & bit == 0 { -radius } else { radius };
                center + Vector3::new(side(1), side(2), side(4))
            })
        };
        match &self.shape {
            Shape::Apple(apple) => Some(cube(apple.center, apple.radius).collect()),
            Shape::Limb(limb, _) => Some(
                cube(limb.start, limb.start_radius)
                    .chain(cube(limb.end, limb.end_radius))
                    .collect(),
            ),
            Shape::Leaf(leaf) => Some(leaf.corners().to_vec()),
            Shape::Plane(_) => None,
        }
    }

    fn transformed(self, by: &Isometry3<f64>) -> Self {
        let shape = match self.shape {
            Shape::Apple(apple) => Shape::Apple(apple.transformed(by)),
            Shape::Limb(limb, bark) => Shape::Limb(limb.transformed(by), bark),
            Shape::Leaf(leaf) => Shape::Leaf(leaf.transformed(by)),
            Shape::Plane(plane) => {
                let normal = by * plane.normal;
                let point = by * Point3::from(plane.normal.into_inner() * plane.offset);
                Shape::Plane(Plane {
                    normal,
                    offset: normal.dot(&point.coords),
                })
            }
        };
        Self { shape, ..self }
    }
}

/// The objects before the camera, in the camera's frame (x right, y down, z forward), metres.
#[derive(Clone, Debug, Default)]
pub struct World {
    pub(crate) parts: Vec<Part>,
    pub(crate) apples: Vec<Apple>,
    pub(crate) branches: Vec<Branch>,
    pub(crate) light: Light,
    /// What stands far behind, where it is not a plain sky.
    pub(crate) scenery: Option<Scenery>,
}

/// Length of the pieces into which a limb is cut, metres.
///
/// Against a curve of 0.2 m radius a chord of 8 mm leaves out 0.04 mm.
const PIECE_LENGTH_M: f64 = 0.008;

impl World {
    /// An empty world under `light`.
    pub fn new(light: Light) -> Self {
        Self {
            light,
            ..Self::default()
        }
    }

    /// Adds an apple and returns its index.
    pub fn add_apple(&mut self, apple: Apple) -> usize {
        let index = self.apples.len();
        self.apples.push(apple);
        self.parts.push(Part {
            shape: Shape::Apple(apple),
            owner: Owner::Apple(index),
        });
        index
    }

    /// Adds a branch and returns its index.
    pub fn add_branch(&mut self, branch: Branch) -> usize {
        let index = self.branches.len();
        self.branches.push(branch);
        self.add_limb(&branch, Bark::Wood, Owner::Branch(index));
        index
    }

    /// Adds a spur, peduncle or leaf stalk: it looks like wood and is not a branch.
    pub fn add_twig(&mut self, twig: &Branch, bark: Bark) {
        self.add_limb(twig, bark, Owner::Twig);
    }

    /// Adds a leaf.
    pub fn add_leaf(&mut self, leaf: Leaf) {
        self.parts.push(Part {
            shape: Shape::Leaf(leaf),
            owner: Owner::Leaf,
        });
    }

    /// Adds a plane as backdrop.
    pub fn add_backdrop(&mut self, plane: Plane) {
        self.parts.push(Part {
            shape: Shape::Plane(plane),
            owner: Owner::Backdrop,
        });
    }

    /// The apples, in the order in which they were added.
    pub fn apples(&self) -> &[Apple] {
        &self.apples
    }

    /// The branches, in the order in which they were added.
    pub fn branches(&self) -> &[Branch] {
        &self.branches
    }

    /// The same world, moved; the light moves along.
    #[must_use]
    pub fn transformed(&self, by: &Isometry3<f64>) -> Self {
        let branch = |b: &Branch| Branch {
            curve: b.curve.transformed(by),
            ..*b
        };
        Self {
            parts: self.parts.iter().map(|p| p.transformed(by)).collect(),
            apples: self.apples.iter().map(|a| a.transformed(by)).collect(),
            branches: self.branches.iter().map(branch).collect(),
            light: self.light.transformed(by),
            scenery: self.scenery,
        }
    }

    fn add_limb(&mut self, limb: &Branch, bark: Bark, owner: Owner) {
        let pieces = (limb.curve.length() / PIECE_LENGTH_M)
            .ceil()
            .clamp(1.0, 400.0) as usize;
        let nodes: Vec<_> = limb.curve.nodes(pieces).collect();
        let mut offset = 0.0;
        for (i, pair) in nodes.windows(2).enumerate() {
            let radius = |k: usize| limb.radius_at(k as f64 / pieces as f64);
            let piece = LimbPiece {
                start: pair[0],
                end: pair[1],
                start_radius: radius(i),
                end_radius: radius(i + 1),
                offset,
            };
            offset += (pair[1] - pair[0]).norm();
            self.parts.push(Part {
                shape: Shape::Limb(piece, bark),
                owner,
            });
        }
    }
}
