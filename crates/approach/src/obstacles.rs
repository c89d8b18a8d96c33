//! The obstacle that is nearest to a shape.

use crate::point_tree::PointTree;
use crate::shape::Shape;
use crate::swept_volume::SweptVolume;
use crate::{ClearanceConfig, Obstacle, ObstacleMap};
use nalgebra::{Point3, Vector3};
use pomona_geometry::Sphere;

/// The nearest obstacle, by its slack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hit {
    pub(crate) distance: f64,
    pub(crate) margin: f64,
    pub(crate) obstacle: Obstacle,
    pub(crate) point: Point3<f64>,
}

impl Hit {
    pub(crate) fn slack(&self) -> f64 {
        self.distance - self.margin
    }
}

/// Distances nearer to each other than this are equal but for rounding, m.
const ROUNDING_M: f64 = 1e-9;

/// Which obstacles count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObstacleFilter<'a> {
    /// The apple to be picked; its points never count.
    pub(crate) target: usize,
    /// Whether its sphere does.
    pub(crate) target_counts: bool,
    /// Apples that have been picked already, by number; never the target.
    pub(crate) gone: &'a [bool],
    /// Whether branches and the cloud count.
    pub(crate) wood_counts: bool,
    /// Whether any collision ends the search, which then need not find the nearest obstacle.
    pub(crate) any_collision: bool,
}

impl ObstacleFilter<'_> {
    /// The slack under which the search may end.
    fn enough(&self) -> f64 {
        if self.any_collision {
            0.0
        } else {
            f64::NEG_INFINITY
        }
    }

    fn shows(&self, apple: usize) -> bool {
        !self.gone.get(apple).copied().unwrap_or(false)
    }
}

impl ObstacleMap {
    /// The obstacle with the least slack where that is under `bound`.
    pub(crate) fn nearest(
        &self,
        shape: &Shape<'_>,
        filter: &ObstacleFilter<'_>,
        config: &ClearanceConfig,
        bound: f64,
    ) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        let (mut bound, enough) = (bound, filter.enough());
        let mut take = |distance: f64, margin: f64, obstacle, point, bound: &mut f64| {
            *bound = distance - margin;
            best = Some(Hit {
                distance,
                margin,
                obstacle,
                point,
            });
        };
        let margin = config.apple_margin_m;
        for (number, apple) in self.apples.iter().enumerate() {
            let is_target = number == filter.target;
            let counts = if is_target {
                filter.target_counts
            } else {
                filter.shows(number)
            };
            if !counts {
                continue;
            }
            let obstacle = Obstacle::Apple(number);
            let reach = bound + margin + apple.radius;
            if let Some(distance) = shape.distance_to_point(&apple.center, reach) {
                let distance = distance - apple.radius;
                take(distance, margin, obstacle, apple.center, &mut bound);
            }
            if is_target {
                continue;
            }
            if let Some((distance, point)) =
                shape.nearest_of(&self.on_apples[number], bound + margin, enough + margin)
            {
                take(distance, margin, obstacle, point, &mut bound);
            }
        }
        if !filter.wood_counts || bound < enough {
            return best;
        }
        let margin = config.branch_margin_m;
        for (number, branch) in self.branches.iter().enumerate() {
            if let Some((distance, point, _)) =
                shape.distance(&branch.segment, bound + margin + branch.radius)
            {
                let obstacle = Obstacle::Branch(number);
                take(
                    distance - branch.radius,
                    margin,
                    obstacle,
                    point,
                    &mut bound,
                );
            }
        }
        if bound < enough {
            return best;
        }
        let margin = config.cloud_margin_m;
        if let Some((distance, point)) =
            shape.nearest_of(&self.rest, bound + margin, enough + margin)
        {
            take(distance, margin, Obstacle::Cloud, point, &mut bound);
        }
        best
    }

    /// The obstacle that a ball moved by `path` penetrates deeper than at its start and than the margin allows.
    pub(crate) fn pressed(
        &self,
        ball: &Sphere,
        path: Vector3<f64>,
        filter: &ObstacleFilter<'_>,
        config: &ClearanceConfig,
    ) -> Option<Hit> {
        let still = [SweptVolume::capsule(ball.center, ball.center, ball.radius)];
        let moved = [SweptVolume::capsule(
            ball.center,
            ball.center + path,
            ball.radius,
        )];
        let (still, moved) = (Shape::new(&still), Shape::new(&moved));
        let mut worst: Option<Hit> = None;
        let mut judge = |margin: f64, before: f64, after: f64, obstacle, point| {
            let allowed = margin.min(before) - ROUNDING_M;
            let slack = worst.as_ref().map_or(0.0, Hit::slack);
            if after < allowed && after - margin.min(before) < slack {
                worst = Some(Hit {
                    distance: after,
                    margin: margin.min(before),
                    obstacle,
                    point,
                });
            }
        };
        let far = f64::INFINITY;
        let all = f64::NEG_INFINITY;
        // A distance before that is not under the margin allows as much as any other.
        let before_tree = |tree: &PointTree, margin: f64| {
            still.nearest_of(tree, margin, all).map_or(far, |b| b.0)
        };
        let margin = config.apple_margin_m;
        for (number, apple) in self.apples.iter().enumerate() {
            if number == filter.target || !filter.shows(number) {
                continue;
            }
            let center = apple.center;
            if let Some(after) = moved.distance_to_point(&center, margin + apple.radius) {
                let before = still.distance_to_point(&center, far).unwrap_or(far);
                let radius = apple.radius;
                let obstacle = Obstacle::Apple(number);
                judge(margin, before - radius, after - radius, obstacle, center);
            }
            let tree = &self.on_apples[number];
            if let Some((after, point)) = moved.nearest_of(tree, margin, all) {
                let before = before_tree(tree, margin);
                judge(margin, before, after, Obstacle::Apple(number), point);
            }
        }
        if !filter.wood_counts {
            return worst;
        }
        let margin = config.branch_margin_m;
        for (number, branch) in self.branches.iter().enumerate() {
            let (segment, radius) = (&branch.segment, branch.radius);
            if let Some((after, point, _)) = moved.distance(segment, margin + radius) {
                let before = still.distance(segment, far).map_or(far, |b| b.0);
                let obstacle = Obstacle::Branch(number);
                judge(margin, before - radius, after - radius, obstacle, point);
            }
        }
        let margin = config.cloud_margin_m;
        if let Some((after, point)) = moved.nearest_of(&self.rest, margin, all) {
            let before = before_tree(&self.rest, margin);
            judge(margin, before, after, Obstacle::Cloud, point);
        }
        worst
    }
}
