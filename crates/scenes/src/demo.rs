use crate::apple::{Apple, Variety};
use crate::curve::Curve;
use crate::grow::{Grower, Hanging};
use crate::light::Light;
use crate::random::{Purpose, stream};
use crate::world::{Branch, World};
use nalgebra::{Isometry3, Point3, Rotation3, Translation3, Unit, Vector3};

/// Angle by which the camera looks up.
const TILT: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// Distance of the tree's middle from the camera, metres.
const DISTANCE_M: f64 = 0.85;

/// Part of a fruiting tree against the sky, as a camera that is tilted upwards sees it:
/// a leader, four laterals, eight apples.
///
/// Drawn up in a level frame about the tree's middle, then turned before the camera.
pub(crate) fn world() -> World {
    let light = Light {
        toward_sun: Unit::new_normalize(Vector3::new(-0.5, -0.8, -0.55)),
        shadows: true,
        ..Light::default()
    };
    let mut tree = Grower::new(World::new(light), stream(7, Purpose::Layout, 0));
    let (leader, laterals) = grow_limbs(&mut tree);
    hang_apples(&mut tree, laterals);
    for branch in laterals {
        tree.dress(branch, 0.08..1.0, 0.05, 4);
    }
    tree.dress(leader, 0.2..0.95, 0.10, 4);
    for (branch, at, heading) in [
        (0, 0.97, Vector3::new(0.7, -0.6, 0.1)),
        (1, 0.98, Vector3::new(0.8, -0.7, 0.2)),
        (1, 0.55, Vector3::new(0.1, -1.0, 0.3)),
        (2, 0.95, Vector3::new(-0.6, -0.9, 0.2)),
        (3, 0.15, Vector3::new(0.2, -1.0, 0.4)),
    ] {
        let from = tree.world.branches()[laterals[branch]].curve.point(at);
        let length = tree.between(0.13..0.2);
        tree.shoot(from, heading, length);
    }
    let pose = Isometry3::from_parts(
        Translation3::new(0.0, 0.0, DISTANCE_M),
        Rotation3::from_axis_angle(&Vector3::x_axis(), -TILT).into(),
    );
    tree.world.transformed(&pose)
}

/// The leader and the laterals: the numbers of their branches.
fn grow_limbs(tree: &mut Grower) -> (usize, [usize; 4]) {
    let p = Point3::new;
    let limb = |start, leaving, end, start_radius, end_radius| Branch {
        curve: Curve::bow(start, leaving, end),
        start_radius,
        end_radius,
    };
    let x = Vector3::x();
    let leader = limb(
        p(-0.31, 0.70, 0.10),
        -Vector3::y(),
        p(-0.22, -0.70, 0.14),
        0.021,
        0.012,
    );
    let joint = |s| leader.curve.point(s);
    let laterals = [
        limb(
            joint(0.44),
            x * 2.0 - Vector3::y(),
            p(0.50, 0.03, -0.03),
            0.0095,
            0.0045,
        ),
        limb(
            joint(0.65),
            x - Vector3::y() * 0.8,
            p(0.40, -0.33, 0.05),
            0.0085,
            0.004,
        ),
        limb(
            joint(0.53),
            -x - Vector3::y() * 0.5,
            p(-0.62, -0.12, 0.00),
            0.0075,
            0.004,
        ),
        limb(
            p(0.62, 0.30, 0.16),
            -x - Vector3::y() * 0.3,
            p(-0.14, 0.24, 0.10),
            0.0085,
            0.004,
        ),
    ];
    let leader = tree.world.add_branch(leader);
    (leader, laterals.map(|branch| tree.world.add_branch(branch)))
}

fn hang_apples(tree: &mut Grower, laterals: [usize; 4]) {
    let down = Vector3::y();
    let near = -Vector3::z();
    let apples = [
        (0, 0.30, down + near * 0.7, 0.039, Variety::Blushed),
        (0, 0.58, down + near * 0.3, 0.036, Variety::Red),
        (0, 0.86, down - near * 0.1, 0.041, Variety::Red),
        (1, 0.36, down + near * 0.6, 0.037, Variety::Red),
        (1, 0.74, down + near * 0.2, 0.034, Variety::Blushed),
        (2, 0.58, down + near * 0.5, 0.040, Variety::Red),
        (3, 0.30, down + near * 0.4, 0.038, Variety::Red),
        (3, 0.66, down + near * 0.8, 0.035, Variety::Blushed),
    ];
    for (lateral, at, toward, radius, variety) in apples {
        let branch = laterals[lateral];
        let apple = Apple {
            flattening: 0.07,
            stem_cavity: 0.22,
            calyx_cavity: 0.10,
            variety,
            ..Apple::sphere(Point3::origin(), radius)
        };
        let thickness = tree.world.branches()[branch].radius_at(at);
        let distance = radius + thickness + tree.between(0.003..0.008);
        tree.hang(
            apple,
            &Hanging {
                branch,
                at,
                toward,
                distance,
            },
        );
    }
}
