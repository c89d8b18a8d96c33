use crate::body::Body;
use nalgebra::{Point3, Vector3};
use std::collections::HashMap;

/// Balls in a leaf of the tree.
const LEAF: usize = 4;

/// A ball that holds some points of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ball {
    pub(crate) center: Point3<f64>,
    pub(crate) radius: f64,
}

impl Ball {
    fn around(balls: &[Self]) -> Self {
        let (mut low, mut high) = (balls[0].center, balls[0].center);
        for ball in balls {
            low = low.inf(&ball.center);
            high = high.sup(&ball.center);
        }
        let center = nalgebra::center(&low, &high);
        let far = |ball: &Self| (ball.center - center).norm() + ball.radius;
        let radius = balls.iter().map(far).fold(0.0, f64::max);
        Self { center, radius }
    }
}

/// Points of a cloud, held by balls, and those by a tree of balls: the lookup of what is near a
/// gripper.
///
/// A distance to the tree is a lower bound of that to its points: a ball is one cell's points, and
/// reaches beyond them by up to its radius.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointTree {
    /// In the order of their leaves.
    balls: Vec<Ball>,
    /// Each node before its children, the left subtree before the right.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    ball: Ball,
    /// The right child, for an inner node; the left one is the next node.
    right: u32,
    /// The balls of a leaf; an empty range for an inner node.
    first: u32,
    last: u32,
}

impl PointTree {
    /// A tree of these points, in cells of side `voxel_m`; cells with fewer than `least` points are
    /// left out. Points that are not finite are left out too, and a `voxel_m` that is not positive
    /// gives an empty tree.
    pub fn of_points(points: &[Point3<f64>], voxel_m: f64, least: usize) -> Self {
        Self::of_balls(cells(points, voxel_m, least))
    }

    pub(crate) fn of_balls(mut balls: Vec<Ball>) -> Self {
        let mut nodes = Vec::new();
        if !balls.is_empty() {
            let count = balls.len();
            split(&mut balls, 0, count, &mut nodes);
        }
        Self { balls, nodes }
    }

    /// How many balls the points are held by.
    pub fn len(&self) -> usize {
        self.balls.len()
    }

    /// Whether it holds nothing.
    pub fn is_empty(&self) -> bool {
        self.balls.is_empty()
    }

    /// Distance from the nearest ball to the nearest of `bodies` where it is under `bound`, and the
    /// ball's centre. The first ball found nearer than `enough` ends the search.
    pub(crate) fn nearest(
        &self,
        bodies: &[Body],
        bound: f64,
        enough: f64,
    ) -> Option<(f64, Point3<f64>)> {
        let mut best = None;
        let mut bound = bound;
        // As deep as a balanced tree of 2³² leaves.
        let mut stack = [0_u32; 64];
        let mut depth = 0;
        if let Some(root) = self.nodes.first()
            && distance(bodies, &root.ball) < bound
        {
            depth = 1;
        }
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if node.last > node.first {
                for ball in &self.balls[node.first as usize..node.last as usize] {
                    let d = distance(bodies, ball);
                    if d < bound {
                        bound = d;
                        best = Some((d, ball.center));
                    }
                }
                if bound < enough {
                    break;
                }
                continue;
            }
            let (left, right) = (index + 1, node.right);
            let d_left = distance(bodies, &self.nodes[left as usize].ball);
            let d_right = distance(bodies, &self.nodes[right as usize].ball);
            // The nearer child last, to be looked at first.
            let order = if d_left < d_right {
                [(d_right, right), (d_left, left)]
            } else {
                [(d_left, left), (d_right, right)]
            };
            for (d, child) in order {
                if d < bound && depth < stack.len() {
                    stack[depth] = child;
                    depth += 1;
                }
            }
        }
        best
    }
}

#[inline(always)]
fn distance(bodies: &[Body], ball: &Ball) -> f64 {
    let mut least = f64::INFINITY;
    for body in bodies {
        least = least.min(body.distance_to_point(&ball.center));
    }
    least - ball.radius
}

/// Builds the node of `balls[first..last]`, which is not empty, and those below it.
fn split(balls: &mut [Ball], first: usize, last: usize, nodes: &mut Vec<Node>) {
    let part = &mut balls[first..last];
    let index = nodes.len();
    let leaf = part.len() <= LEAF;
    nodes.push(Node {
        ball: Ball::around(part),
        right: 0,
        first: first as u32,
        last: if leaf { last as u32 } else { first as u32 },
    });
    if leaf {
        return;
    }
    let (mut low, mut high) = (part[0].center, part[0].center);
    for ball in &*part {
        low = low.inf(&ball.center);
        high = high.sup(&ball.center);
    }
    let axis = (high - low).imax();
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| a.center[axis].total_cmp(&b.center[axis]));
    split(balls, first, first + middle, nodes);
    nodes[index].right = nodes.len() as u32;
    split(balls, first + middle, last, nodes);
}

struct Cell {
    low: Point3<f64>,
    high: Point3<f64>,
    count: usize,
}

/// One ball for each cell with enough points; in the order of the cells.
pub(crate) fn cells(points: &[Point3<f64>], voxel_m: f64, least: usize) -> Vec<Ball> {
    if !(voxel_m > 0.0) {
        return Vec::new();
    }
    let mut cells: HashMap<[i32; 3], Cell> = HashMap::new();
    for p in points.iter().filter(|p| p.iter().all(|c| c.is_finite())) {
        let key = [p.x, p.y, p.z].map(|c| (c / voxel_m).floor() as i32);
        cells
            .entry(key)
            .and_modify(|cell| {
                cell.low = cell.low.inf(p);
                cell.high = cell.high.sup(p);
                cell.count += 1;
            })
            .or_insert(Cell {
                low: *p,
                high: *p,
                count: 1,
            });
    }
    let mut kept: Vec<([i32; 3], Ball)> = cells
        .into_iter()
        .filter(|(_, cell)| cell.count >= least)
        .map(|(key, cell)| {
            let diagonal: Vector3<f64> = cell.high - cell.low;
            let ball = Ball {
                center: nalgebra::center(&cell.low, &cell.high),
                radius: 0.5 * diagonal.norm(),
            };
            (key, ball)
        })
        .collect();
    // The order of a hash map differs from run to run.
    kept.sort_unstable_by_key(|(key, _)| *key);
    kept.into_iter().map(|(_, ball)| ball).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(n: usize) -> impl Strategy<Value = Vec<Point3<f64>>> {
        prop::collection::vec(
            prop::array::uniform3(-0.5..0.5f64).prop_map(Point3::from),
            0..n,
        )
    }

    proptest! {
        #[test]
        fn the_nearest_ball_is_found(points in points(300), a in prop::array::uniform3(-0.5..0.5f64), bound in 0.0..0.5f64) {
            let body = Body::capsule(a.into(), Point3::new(0.1, 0.2, 0.3), 0.02);
            let balls = cells(&points, 0.03, 1);
            let least = balls.iter().map(|b| distance(&[body], b)).fold(f64::INFINITY, f64::min);
            let found = PointTree::of_balls(balls).nearest(&[body], bound, f64::NEG_INFINITY);
            prop_assert_eq!(found.map(|f| f.0), (least < bound).then_some(least));
        }

        #[test]
        fn distances_are_lower_bounds(points in points(200), a in prop::array::uniform3(-0.5..0.5f64)) {
            prop_assume!(!points.is_empty());
            let body = Body::capsule(a.into(), Point3::new(0.1, 0.2, 0.3), 0.02);
            let least = points.iter().map(|p| body.distance_to_point(p)).fold(f64::INFINITY, f64::min);
            let (d, _) = PointTree::of_points(&points, 0.02, 1).nearest(&[body], 10.0, f64::NEG_INFINITY).unwrap();
            prop_assert!(d <= least + 1e-12 && d >= least - 0.02 * 3.0_f64.sqrt(), "{d} {least}");
        }
    }

    #[test]
    fn stray_points_and_none_are_no_tree() {
        let stray = [Point3::new(0.0, 0.0, 0.0), Point3::new(f64::NAN, 0.0, 0.0)];
        assert!(PointTree::of_points(&stray, 0.01, 2).is_empty());
        assert!(PointTree::of_points(&stray, 0.0, 1).is_empty());
        assert_eq!(PointTree::of_points(&stray, 0.01, 1).len(), 1);
        assert!(PointTree::default().nearest(&[], 1.0, 0.0).is_none());
    }
}
