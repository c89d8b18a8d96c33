use crate::ClearanceConfig;
use crate::point_tree::{PointTree, cells};
use nalgebra::Point3;
use pomona_geometry::{Aabb, Capsule, Sphere};

/// The obstacles of one frame, in the base's frame: apples, branches, and the rest of the cloud.
///
/// Built once, it serves all targets. What the camera has not seen is not in it.
#[derive(Clone, Debug)]
pub struct ObstacleMap {
    pub(crate) apples: Vec<Sphere>,
    pub(crate) branches: Vec<Capsule>,
    /// Points on the surface of each apple.
    pub(crate) on_apples: Vec<PointTree>,
    /// All others.
    pub(crate) rest: PointTree,
}

impl ObstacleMap {
    /// The scene of these apples, branches of the extent that was seen, and cloud points.
    ///
    /// Points within the configured band of an apple (the nearest one) become that apple's. Points that
    /// are not finite, or farther than the configured region from every apple, are left out.
    pub fn new(
        apples: Vec<Sphere>,
        branches: Vec<Capsule>,
        cloud: &[Point3<f64>],
        config: &ClearanceConfig,
    ) -> Self {
        let region = around_apples(&apples, config.region_m);
        let near = |p: &&Point3<f64>| region.is_some_and(|region| region.contains(p));
        let near = cloud.iter().filter(near);
        let balls = cells(near, config.voxel_m, config.voxel_min_points);
        let mut on_apples = vec![Vec::new(); apples.len()];
        let mut rest = Vec::new();
        for ball in balls {
            // A root for the few apples that are that near, and a little for rounding.
            let about = |apple: &Sphere| {
                let reach = apple.radius + config.own_band_m + 1e-9;
                (ball.center - apple.center).norm_squared() <= reach * reach
            };
            let nearest = apples
                .iter()
                .enumerate()
                .filter(|(_, apple)| about(apple))
                .map(|(number, apple)| (number, apple.signed_distance(&ball.center)))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            match nearest {
                Some((apple, distance)) if distance <= config.own_band_m => {
                    on_apples[apple].push(ball);
                }
                _ => rest.push(ball),
            }
        }
        Self {
            apples,
            branches,
            on_apples: on_apples.into_iter().map(PointTree::of_balls).collect(),
            rest: PointTree::of_balls(rest),
        }
    }

    /// The apples.
    pub fn apples(&self) -> &[Sphere] {
        &self.apples
    }

    /// The branches.
    pub fn branches(&self) -> &[Capsule] {
        &self.branches
    }

    /// The points that neither an apple nor the region's edge has taken away.
    pub fn rest(&self) -> &PointTree {
        &self.rest
    }
}

/// The box that reaches this far beyond every apple.
fn around_apples(apples: &[Sphere], region_m: f64) -> Option<Aabb> {
    let around = Aabb::around(apples.iter().map(|a| a.center))?;
    let largest = apples.iter().map(|a| a.radius).fold(0.0, f64::max);
    let reach = nalgebra::Vector3::repeat(region_m + largest);
    Some(Aabb {
        min: around.min - reach,
        max: around.max + reach,
    })
}
