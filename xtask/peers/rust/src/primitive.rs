use crate::Job;
use nalgebra::{Matrix3, Matrix4, SymmetricEigen, Vector3, Vector4};

pub type Point = Vector3<f64>;

/// A sphere or a line: what the peers that know neither are given.
pub trait Primitive: Copy {
    /// Points in a minimal sample.
    const SAMPLE: usize;

    /// Through a minimal sample that the job's bounds allow.
    fn through(sample: &[Point], job: &Job) -> Option<Self>;

    /// Fitted to its inliers by their distances.
    fn refitted(self, inliers: &[Point]) -> Option<Self>;

    fn distance(&self, point: &Point) -> f64;

    fn coefficients(&self) -> Vec<f64>;

    /// Refitted to those of `points` that are its inliers; itself where that fails.
    fn settled(self, points: &[Point], job: &Job) -> Self {
        let inliers: Vec<Point> = points
            .iter()
            .copied()
            .filter(|p| self.distance(p) <= job.threshold)
            .collect();
        self.refitted(&inliers).unwrap_or(self)
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    pub center: Point,
    pub radius: f64,
}

impl Primitive for Sphere {
    const SAMPLE: usize = 4;

    fn through(sample: &[Point], job: &Job) -> Option<Self> {
        let [a, b, c, d] = sample else { return None };
        let edges = [b - a, c - a, d - a];
        let rows = Matrix3::from_rows(&edges.map(|edge| edge.transpose()));
        let half_squares = Vector3::from(edges.map(|edge| 0.5 * edge.norm_squared()));
        let offset = rows.try_inverse()? * half_squares;
        let radius = offset.norm();
        (job.min <= radius && radius <= job.max).then(|| Self {
            center: a + offset,
            radius,
        })
    }

    /// Gauss-Newton on the distances.
    fn refitted(self, inliers: &[Point]) -> Option<Self> {
        let mut sphere = self;
        for _ in 0..10 {
            let (mut matrix, mut right) = (Matrix4::zeros(), Vector4::zeros());
            for p in inliers {
                let offset = p - sphere.center;
                let distance = offset.norm();
                let row = (-offset / distance).push(-1.0);
                matrix += row * row.transpose();
                right -= row * (distance - sphere.radius);
            }
            let step = matrix.cholesky()?.solve(&right);
            sphere.center += step.xyz();
            sphere.radius += step.w;
            if step.norm() < 1e-9 {
                break;
            }
        }
        Some(sphere)
    }

    fn distance(&self, point: &Point) -> f64 {
        ((point - self.center).norm() - self.radius).abs()
    }

    fn coefficients(&self) -> Vec<f64> {
        self.center.push(self.radius).iter().copied().collect()
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Line {
    pub point: Point,
    pub direction: Vector3<f64>,
}

impl Primitive for Line {
    const SAMPLE: usize = 2;

    fn through(sample: &[Point], job: &Job) -> Option<Self> {
        let [a, b] = sample else { return None };
        let line = Self {
            point: *a,
            direction: (b - a).try_normalize(1e-12)?,
        };
        let distance = line.distance(&job.point);
        (job.min <= distance && distance <= job.max).then_some(line)
    }

    /// The principal axis.
    fn refitted(self, inliers: &[Point]) -> Option<Self> {
        let centroid = inliers.iter().sum::<Point>() / inliers.len() as f64;
        let spread: Matrix3<f64> = inliers
            .iter()
            .map(|p| (p - centroid) * (p - centroid).transpose())
            .sum();
        let eigen = SymmetricEigen::try_new(spread, 1e-15, 100)?;
        let direction = eigen
            .eigenvectors
            .column(eigen.eigenvalues.imax())
            .into_owned();
        Some(Self {
            point: centroid,
            direction,
        })
    }

    fn distance(&self, point: &Point) -> f64 {
        (point - self.point).cross(&self.direction).norm()
    }

    fn coefficients(&self) -> Vec<f64> {
        self.point
            .iter()
            .chain(self.direction.iter())
            .copied()
            .collect()
    }
}
