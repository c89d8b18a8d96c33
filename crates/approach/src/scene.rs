use crate::body::Body;
use crate::point_tree::{Ball, PointTree, cells};
use crate::{ClearanceConfig, Obstacle};
use nalgebra::Point3;
use pomona_geometry::{Aabb, Capsule, Segment, Sphere};

/// What is in the way in one frame, in the base's frame: apples, branches, and the rest of the cloud.
///
/// Built once, it serves all targets. What the camera has not seen is not in it.
#[derive(Clone, Debug)]
pub struct Scene {
    apples: Vec<Sphere>,
    branches: Vec<Capsule>,
    /// Points on the surface of each apple.
    on_apples: Vec<PointTree>,
    /// All others.
    rest: PointTree,
}

impl Scene {
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
        let near = near_apples(&apples, cloud, config.region_m);
        let balls = cells(&near, config.voxel_m, config.voxel_min_points);
        let mut on_apples = vec![Vec::new(); apples.len()];
        let mut rest = Vec::new();
        for ball in balls {
            let nearest = apples
                .iter()
                .map(|apple| apple.signed_distance(&ball.center))
                .enumerate()
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

fn near_apples(apples: &[Sphere], cloud: &[Point3<f64>], region_m: f64) -> Vec<Point3<f64>> {
    let Some(around) = Aabb::around(apples.iter().map(|a| a.center)) else {
        return Vec::new();
    };
    let largest = apples.iter().map(|a| a.radius).fold(0.0, f64::max);
    let reach = nalgebra::Vector3::repeat(region_m + largest);
    let region = Aabb {
        min: around.min - reach,
        max: around.max + reach,
    };
    cloud
        .iter()
        .filter(|p| region.contains(p))
        .copied()
        .collect()
}

/// The parts of the gripper together with a ball about them.
pub(crate) struct Shape<'a> {
    bodies: &'a [Body],
    around: Ball,
}

impl<'a> Shape<'a> {
    pub(crate) fn new(bodies: &'a [Body]) -> Self {
        let (mut low, mut high) = (Point3::origin(), Point3::origin());
        for (i, body) in bodies.iter().enumerate() {
            let center = body.center();
            (low, high) = if i == 0 {
                (center, center)
            } else {
                (low.inf(&center), high.sup(&center))
            };
        }
        let center = nalgebra::center(&low, &high);
        let far = |body: &Body| (body.center() - center).norm() + body.reach();
        let radius = bodies.iter().map(far).fold(0.0, f64::max);
        Self {
            bodies,
            around: Ball { center, radius },
        }
    }

    fn distance(&self, segment: &Segment, bound: f64) -> Option<(f64, Point3<f64>, usize)> {
        if segment.distance(&self.around.center) - self.around.radius >= bound {
            return None;
        }
        let mut best: Option<(f64, Point3<f64>, usize)> = None;
        for (index, body) in self.bodies.iter().enumerate() {
            let (distance, point) = body.distance_to_segment(segment);
            if distance < best.map_or(bound, |b| b.0) {
                best = Some((distance, point, index));
            }
        }
        best
    }
}

/// The nearest obstacle, by what is left beyond its margin.
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

/// Which obstacles count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a> {
    /// The apple to be picked; its points never count.
    pub(crate) target: usize,
    /// Whether its sphere does.
    pub(crate) target_counts: bool,
    /// Apples that are gone, by number; the target never is.
    pub(crate) gone: &'a [bool],
    /// Whether branches and the cloud count.
    pub(crate) wood_counts: bool,
    /// Whether any collision will do for an answer, in place of the nearest thing.
    pub(crate) any: bool,
}

impl View<'_> {
    /// The slack under which the search may end.
    fn enough(&self) -> f64 {
        if self.any { 0.0 } else { f64::NEG_INFINITY }
    }

    fn shows(&self, apple: usize) -> bool {
        !self.gone.get(apple).copied().unwrap_or(false)
    }
}

impl Scene {
    /// The obstacle with the least slack where that is under `bound`.
    pub(crate) fn nearest(
        &self,
        shape: &Shape<'_>,
        view: &View<'_>,
        config: &ClearanceConfig,
        bound: f64,
    ) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        let (mut bound, enough) = (bound, view.enough());
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
            let is_target = number == view.target;
            let counts = if is_target {
                view.target_counts
            } else {
                view.shows(number)
            };
            if !counts {
                continue;
            }
            let obstacle = Obstacle::Apple(number);
            let ball = Segment {
                start: apple.center,
                end: apple.center,
            };
            if let Some((distance, point, _)) = shape.distance(&ball, bound + margin + apple.radius)
            {
                take(distance - apple.radius, margin, obstacle, point, &mut bound);
            }
            if is_target {
                continue;
            }
            if let Some((distance, point)) =
                self.on_apples[number].nearest(shape.bodies, bound + margin, enough + margin)
            {
                take(distance, margin, obstacle, point, &mut bound);
            }
        }
        if !view.wood_counts || bound < enough {
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
            self.rest
                .nearest(shape.bodies, bound + margin, enough + margin)
        {
            take(distance, margin, Obstacle::Cloud, point, &mut bound);
        }
        best
    }

    /// The obstacle into which a ball that is moved by `path` presses by more than where it
    /// starts, and than its margin allows.
    pub(crate) fn pressed(
        &self,
        ball: &Sphere,
        path: nalgebra::Vector3<f64>,
        view: &View<'_>,
        config: &ClearanceConfig,
    ) -> Option<Hit> {
        let still = [Body::capsule(ball.center, ball.center, ball.radius)];
        let moved = [Body::capsule(ball.center, ball.center + path, ball.radius)];
        let (still, moved) = (Shape::new(&still), Shape::new(&moved));
        let mut worst: Option<Hit> = None;
        // Rounding must not tell two equal distances apart.
        let mut judge = |margin: f64, before: f64, after: f64, obstacle, point| {
            let allowed = margin.min(before) - 1e-9;
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
        let before_tree =
            |tree: &PointTree| tree.nearest(still.bodies, far, all).map_or(far, |b| b.0);
        let margin = config.apple_margin_m;
        for (number, apple) in self.apples.iter().enumerate() {
            if number == view.target || !view.shows(number) {
                continue;
            }
            let center = Segment {
                start: apple.center,
                end: apple.center,
            };
            if let Some((after, point, _)) = moved.distance(&center, margin + apple.radius) {
                let before = still.distance(&center, far).map_or(far, |b| b.0);
                let radius = apple.radius;
                let obstacle = Obstacle::Apple(number);
                judge(margin, before - radius, after - radius, obstacle, point);
            }
            let tree = &self.on_apples[number];
            if let Some((after, point)) = tree.nearest(moved.bodies, margin, all) {
                let before = before_tree(tree);
                judge(margin, before, after, Obstacle::Apple(number), point);
            }
        }
        if !view.wood_counts {
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
        if let Some((after, point)) = self.rest.nearest(moved.bodies, margin, all) {
            let before = before_tree(&self.rest);
            judge(margin, before, after, Obstacle::Cloud, point);
        }
        worst
    }
}
