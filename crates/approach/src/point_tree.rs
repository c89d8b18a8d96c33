use nalgebra::{Point3, Vector3};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Balls in a leaf of the tree.
const LEAF: usize = 4;

/// A ball that holds some points of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ball {
    pub(crate) center: Point3<f64>,
    pub(crate) radius: f64,
}

impl Ball {
    /// The ball about the middle of a box that holds these balls, whose centres span the box.
    fn around(balls: &[Self], low: &Point3<f64>, high: &Point3<f64>) -> Self {
        let center = nalgebra::center(low, high);
        let mut radius: f64 = 0.0;
        for ball in balls {
            let squared = (ball.center - center).norm_squared();
            let room = radius - ball.radius;
            // Most balls reach no farther than those before: no root for them.
            if room < 0.0 || squared > room * room {
                radius = radius.max(squared.sqrt() + ball.radius);
            }
        }
        Self { center, radius }
    }

    /// Distance of the surfaces of two balls, negative where they overlap.
    pub(crate) fn gap(&self, other: &Self) -> f64 {
        (self.center - other.center).norm() - self.radius - other.radius
    }
}

/// Points of a cloud in balls, and these in a tree of balls, for distance queries near a gripper.
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

    /// Number of balls.
    pub fn len(&self) -> usize {
        self.balls.len()
    }

    /// Whether it is empty.
    pub fn is_empty(&self) -> bool {
        self.balls.is_empty()
    }

    /// The ball about all of them.
    pub(crate) fn around(&self) -> Option<&Ball> {
        self.nodes.first().map(|root| &root.ball)
    }

    /// Distance from the nearest ball where it is under `bound`, and the ball's centre; `from` is the distance from a
    /// point. The first ball found nearer than `enough` ends the search.
    #[inline]
    pub(crate) fn nearest(
        &self,
        from: impl Fn(&Point3<f64>) -> f64,
        bound: f64,
        enough: f64,
    ) -> Option<(f64, Point3<f64>)> {
        let distance = |ball: &Ball| from(&ball.center) - ball.radius;
        let mut best = None;
        let mut bound = bound;
        // As deep as a balanced tree of 2³² leaves.
        let mut stack = [0_u32; 64];
        let mut depth = 0;
        if let Some(root) = self.nodes.first()
            && distance(&root.ball) < bound
        {
            depth = 1;
        }
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if node.last > node.first {
                for ball in &self.balls[node.first as usize..node.last as usize] {
                    let d = distance(ball);
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
            let d_left = distance(&self.nodes[left as usize].ball);
            let d_right = distance(&self.nodes[right as usize].ball);
            // The nearer child last, to be visited first.
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

/// Builds the node of `balls[first..last]`, which is not empty, and those below it.
fn split(balls: &mut [Ball], first: usize, last: usize, nodes: &mut Vec<Node>) {
    let part = &mut balls[first..last];
    let index = nodes.len();
    let leaf = part.len() <= LEAF;
    let (mut low, mut high) = (part[0].center, part[0].center);
    for ball in &*part {
        low = low.inf(&ball.center);
        high = high.sup(&ball.center);
    }
    nodes.push(Node {
        ball: Ball::around(part, &low, &high),
        right: 0,
        first: first as u32,
        last: if leaf { last as u32 } else { first as u32 },
    });
    if leaf {
        return;
    }
    let axis = (high - low).imax();
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| a.center[axis].total_cmp(&b.center[axis]));
    split(balls, first, first + middle, nodes);
    nodes[index].right = nodes.len() as u32;
    split(balls, first + middle, last, nodes);
}

/// What a cell holds.
#[derive(Clone, Copy)]
struct Cell {
    low: Point3<f64>,
    high: Point3<f64>,
    count: usize,
}

/// A hash of a cell's three indices: fast, since a frame has a hundred thousand points; the input is not adversarial.
#[derive(Clone, Copy, Default)]
struct CellHasher(u64);

impl Hasher for CellHasher {
    fn finish(&self) -> u64 {
        // The table takes its place from the low bits and its tag from the high ones.
        self.0 ^ (self.0 >> 32)
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }

    fn write_i32(&mut self, number: i32) {
        self.write_u64(u64::from(number.cast_unsigned()));
    }

    fn write_u64(&mut self, number: u64) {
        // 2⁶⁴ over the golden ratio (Knuth 1998, section 6.4).
        self.0 = (self.0.rotate_left(21) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

/// `floor` as an integer, without a function call.
fn floor(x: f64) -> i32 {
    let whole = x as i32;
    whole.saturating_sub(i32::from(f64::from(whole) > x))
}

/// One ball for each cell with enough points; in the order of the cells.
pub(crate) fn cells<'a>(
    points: impl IntoIterator<Item = &'a Point3<f64>>,
    voxel_m: f64,
    least: usize,
) -> Vec<Ball> {
    if !(voxel_m > 0.0) {
        return Vec::new();
    }
    let mut cells: HashMap<(i32, i32, i32), Cell, BuildHasherDefault<CellHasher>> =
        HashMap::default();
    let finite = |p: &&Point3<f64>| p.iter().all(|c| c.is_finite());
    for p in points.into_iter().filter(finite) {
        let [x, y, z] = [p.x, p.y, p.z].map(|c| floor(c / voxel_m));
        let cell = cells.entry((x, y, z)).or_insert(Cell {
            low: *p,
            high: *p,
            count: 0,
        });
        cell.low = cell.low.inf(p);
        cell.high = cell.high.sup(p);
        cell.count += 1;
    }
    let mut kept: Vec<((i32, i32, i32), Ball)> = cells
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
    // The order of a hash map is that in which the cells came.
    kept.sort_unstable_by_key(|(key, _)| *key);
    kept.into_iter().map(|(_, ball)| ball).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::swept_volume::SweptVolume;
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
            let body = SweptVolume::capsule(a.into(), Point3::new(0.1, 0.2, 0.3), 0.02);
            let balls = cells(&points, 0.03, 1);
            let least = balls.iter().map(|b| body.distance_to_point(&b.center) - b.radius).fold(f64::INFINITY, f64::min);
            let found = PointTree::of_balls(balls).nearest(|p| body.distance_to_point(p), bound, f64::NEG_INFINITY);
            prop_assert_eq!(found.map(|f| f.0), (least < bound).then_some(least));
        }

        #[test]
        fn distances_are_lower_bounds(points in points(200), a in prop::array::uniform3(-0.5..0.5f64)) {
            prop_assume!(!points.is_empty());
            let body = SweptVolume::capsule(a.into(), Point3::new(0.1, 0.2, 0.3), 0.02);
            let least = points.iter().map(|p| body.distance_to_point(p)).fold(f64::INFINITY, f64::min);
            let (d, _) = PointTree::of_points(&points, 0.02, 1).nearest(|p| body.distance_to_point(p), 10.0, f64::NEG_INFINITY).unwrap();
            prop_assert!(d <= least + 1e-12 && d >= least - 0.02 * 3.0_f64.sqrt(), "{d} {least}");
        }
    }

    #[test]
    fn floors_are_those_of_the_standard_library() {
        for x in [
            0.0,
            -0.0,
            0.5,
            -0.5,
            3.0,
            -3.0,
            -3.000_001,
            1e12,
            -1e12,
            2_147_483_647.5,
        ] {
            assert_eq!(floor(x), x.floor() as i32, "{x}");
        }
    }

    #[test]
    fn stray_points_and_none_are_no_tree() {
        let stray = [Point3::new(0.0, 0.0, 0.0), Point3::new(f64::NAN, 0.0, 0.0)];
        assert!(PointTree::of_points(&stray, 0.01, 2).is_empty());
        assert!(PointTree::of_points(&stray, 0.0, 1).is_empty());
        assert_eq!(PointTree::of_points(&stray, 0.01, 1).len(), 1);
        assert!(PointTree::default().nearest(|_| 0.0, 1.0, 0.0).is_none());
    }
}
