use crate::body::Body;
use crate::outline::Placed;
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

/// The parts of the gripper together with a ball about them.
pub(crate) struct Shape<'a> {
    bodies: &'a [Body],
    around: Ball,
    /// The same as an outline, where it is a gripper's.
    outline: Option<Placed>,
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
            outline: None,
        }
    }

    /// The bodies of a gripper, of which this is the outline.
    pub(crate) fn with_outline(bodies: &'a [Body], outline: Placed) -> Self {
        Self {
            outline: Some(outline),
            ..Self::new(bodies)
        }
    }

    /// Distance from the balls of a tree where it is under `bound`, and the centre of the nearest.
    fn nearest_of(&self, tree: &PointTree, bound: f64, enough: f64) -> Option<(f64, Point3<f64>)> {
        if tree.around()?.gap(&self.around) >= bound {
            return None;
        }
        match &self.outline {
            Some(outline) => tree.nearest(|p| outline.distance(p), bound, enough),
            None => tree.nearest(|p| self.distance_by_bodies(p), bound, enough),
        }
    }

    fn distance_by_bodies(&self, point: &Point3<f64>) -> f64 {
        let distances = self.bodies.iter().map(|b| b.distance_to_point(point));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Distance from a point where it is under `bound`.
    fn distance_to_point(&self, point: &Point3<f64>, bound: f64) -> Option<f64> {
        if (point - self.around.center).norm() - self.around.radius >= bound {
            return None;
        }
        let distance = match &self.outline {
            Some(outline) => outline.distance(point),
            None => self.distance_by_bodies(point),
        };
        (distance < bound).then_some(distance)
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
            shape.nearest_of(&self.rest, bound + margin, enough + margin)
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
        // A distance before that is not under the margin allows as much as any other.
        let before_tree = |tree: &PointTree, margin: f64| {
            still.nearest_of(tree, margin, all).map_or(far, |b| b.0)
        };
        let margin = config.apple_margin_m;
        for (number, apple) in self.apples.iter().enumerate() {
            if number == view.target || !view.shows(number) {
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
        if let Some((after, point)) = moved.nearest_of(&self.rest, margin, all) {
            let before = before_tree(&self.rest, margin);
            judge(margin, before, after, Obstacle::Cloud, point);
        }
        worst
    }
}
