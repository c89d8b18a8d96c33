//! What the camera sees of each apple and of its branch.

use crate::apple::Apple;
use crate::ray::Ray;
use crate::raycast::{Raycast, extent};
use crate::truth::{AppleTruth, BranchTruth};
use crate::world::{Owner, Part, Shape, World};
use nalgebra::Point3;
use pomona_cloud::{Camera, PixelBox};
use std::collections::BTreeSet;

/// Radii within which a branch passes an apple to be its nearest.
const BRANCH_REACH: f64 = 1.8;

/// Radii about the centre within which the visible branch is measured: the paper's shell.
const SHELL_REACH: f64 = 3.0;

/// Width of the slices in which the visible length is counted, metres: over twice a pixel at 0.8 m.
const SLICE_M: f64 = 0.002;

/// Apple number `index` of the world as the camera sees it; `None` where fewer than
/// `least_pixels` of it show.
pub(crate) fn look_at(
    world: &World,
    camera: &Camera,
    cast: &Raycast,
    index: usize,
    margin_px: f64,
    least_pixels: usize,
) -> Option<AppleTruth> {
    let apple = &world.apples[index];
    let part = Part {
        shape: Shape::Apple(*apple),
        owner: Owner::Apple(index),
    };
    let area = extent(&part, camera)?;
    let (mut silhouette, mut visible) = (0usize, 0usize);
    let (mut left, mut top, mut right, mut bottom) = (usize::MAX, usize::MAX, 0, 0);
    for y in area.y.0..area.y.1 {
        for x in area.x.0..area.x.1 {
            if part
                .hit(&Ray::of_pixel(camera, x as f64, y as f64))
                .is_none()
            {
                continue;
            }
            silhouette += 1;
            if cast.owner(world, y * cast.width + x) == Some(part.owner) {
                visible += 1;
                (left, right) = (left.min(x), right.max(x));
                (top, bottom) = (top.min(y), bottom.max(y));
            }
        }
    }
    if visible < least_pixels.max(1) {
        return None;
    }
    let bounds = PixelBox {
        name: index.to_string(),
        x_min: (left as f64 - margin_px).max(0.0),
        y_min: (top as f64 - margin_px).max(0.0),
        x_max: (right as f64 + 1.0 + margin_px).min(camera.width as f64),
        y_max: (bottom as f64 + 1.0 + margin_px).min(camera.height as f64),
        score: 1.0,
    };
    let nearest = nearest_branch(world, &apple.center);
    let branch = nearest.filter(|n| n.distance <= BRANCH_REACH * apple.radius);
    let direction = branch
        .as_ref()
        .map(|n| (world.branches[n.index].curve.point(n.parameter) - apple.center).normalize());
    Some(AppleTruth {
        bounds,
        center: apple.center.into(),
        radius: apple.radius,
        branch: branch.and_then(|n| describe(world, camera, cast, index, &n)),
        direction: direction.map(Into::into),
        target: None,
        visible_share: Some(visible as f64 / silhouette as f64),
        leaves: Some(leaves_near(world, apple)),
    })
}

/// Leaves within the shell in which a method looks for the branch.
fn leaves_near(world: &World, apple: &Apple) -> usize {
    let near = |part: &&Part| match &part.shape {
        Shape::Leaf(leaf) => {
            let middle = leaf.base + leaf.along.into_inner() * (0.5 * leaf.length);
            (middle - apple.center).norm() <= SHELL_REACH * apple.radius
        }
        _ => false,
    };
    world.parts.iter().filter(near).count()
}

/// The branch whose centre line is nearest to a point.
pub(crate) struct Nearest {
    pub(crate) index: usize,
    pub(crate) parameter: f64,
    pub(crate) distance: f64,
}

pub(crate) fn nearest_branch(world: &World, to: &Point3<f64>) -> Option<Nearest> {
    let near = world.branches.iter().enumerate().map(|(index, branch)| {
        let parameter = branch.curve.nearest(to);
        let distance = (branch.curve.point(parameter) - to).norm();
        Nearest {
            index,
            parameter,
            distance,
        }
    });
    near.min_by(|a, b| a.distance.total_cmp(&b.distance))
}

fn describe(
    world: &World,
    camera: &Camera,
    cast: &Raycast,
    apple: usize,
    near: &Nearest,
) -> Option<BranchTruth> {
    let branch = &world.branches[near.index];
    let tangent = branch.tangent(near.parameter)?;
    let (visible_pixels, visible_length) = visible_branch(world, camera, cast, apple, near.index);
    Some(BranchTruth {
        point: tangent.point.into(),
        direction: tangent.direction.into_inner().into(),
        radius: branch.radius_at(near.parameter),
        index: Some(near.index),
        visible_pixels: Some(visible_pixels),
        visible_length: Some(visible_length),
    })
}

/// Pixels and length of a branch that show within the shell's reach of an apple.
pub(crate) fn visible_branch(
    world: &World,
    camera: &Camera,
    cast: &Raycast,
    apple: usize,
    branch: usize,
) -> (usize, f64) {
    let apple = &world.apples[apple];
    let reach = SHELL_REACH * apple.radius;
    let ball = Part {
        shape: Shape::Apple(Apple::sphere(apple.center, reach)),
        owner: Owner::Leaf,
    };
    let Some(area) = extent(&ball, camera) else {
        return (0, 0.0);
    };
    let mut pixels = 0;
    let mut slices = BTreeSet::new();
    for y in area.y.0..area.y.1 {
        for x in area.x.0..area.x.1 {
            let pixel = y * cast.width + x;
            let Some(part) = world.parts.get(cast.part[pixel] as usize) else {
                continue;
            };
            if part.owner != Owner::Branch(branch) {
                continue;
            }
            let ray = Ray::of_pixel(camera, x as f64, y as f64);
            let point = ray.at(f64::from(cast.depth[pixel]));
            if (point - apple.center).norm() <= reach {
                pixels += 1;
                slices.insert((part.surface(&point).u / SLICE_M) as u64);
            }
        }
    }
    (pixels, slices.len() as f64 * SLICE_M)
}
