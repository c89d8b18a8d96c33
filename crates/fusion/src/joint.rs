//! Positions of all apples and motions of all frames, estimated together.
//!
//! An observation of apple a in frame k is m = xₐ + Jₘ δₖ + e with Jₘ = [−[m − c]× I]: its own error e with the
//! observation's covariance, and the frame's small motion δₖ = (rotation, shift) about the centroid c of the tree. The
//! prior of δₖ is what the pose states of its error and how far trees sway. The problem is linear, and so it is solved
//! in one step; the apples are eliminated first (Schur complement: Triggs et al. 2000, section 6.1, doi
//! 10.1007/3-540-44480-7_21), which leaves six unknowns for each frame.

use crate::observation::Observation;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Mat, Side};
use nalgebra::{Matrix3, Matrix3x6, Matrix6, SMatrix, Vector3, Vector6};

/// Observations of one apple, as indices, at most one of each frame.
pub(crate) type Track = Vec<usize>;

/// Fraction of an observation's variance that is added to the covariance of its residual: where an observation is the only
/// one of its apple that covariance is 0 but for rounding.
const RESIDUAL_VARIANCE_FLOOR: f64 = 1e-9;

/// An apple's estimated position.
#[derive(Clone, Debug)]
pub(crate) struct EstimatedPosition {
    pub(crate) center: Vector3<f64>,
    pub(crate) covariance: Matrix3<f64>,
    /// By how much the position follows the motion of each frame that shows the apple, with the opposite sign.
    gains: Vec<(usize, Matrix3x6<f64>)>,
}

/// The joint estimate.
#[derive(Clone, Debug)]
pub(crate) struct JointEstimate<'a> {
    pub(crate) observations: &'a [Observation],
    pub(crate) tracks: Vec<Track>,
    /// The position of each track.
    pub(crate) positions: Vec<EstimatedPosition>,
    /// The point about which frames turn, metres.
    pub(crate) centroid: Vector3<f64>,
    motions: Vec<Vector6<f64>>,
    /// Covariance of all motions.
    covariance: Mat<f64>,
}

/// An apple before the motions are known.
struct Eliminated {
    /// Its covariance, were the motions known.
    inverse: Matrix3<f64>,
    /// Its weighted sum of observations relative to the centroid.
    sum: Vector3<f64>,
    gains: Vec<(usize, Matrix3x6<f64>)>,
}

/// How a frame's motion moves an observation.
pub(crate) fn jacobian(center: &Vector3<f64>, centroid: &Vector3<f64>) -> Matrix3x6<f64> {
    let mut j = Matrix3x6::zeros();
    j.fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&-(center - centroid).cross_matrix());
    j.fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&Matrix3::identity());
    j
}

/// vᵀ C⁻¹ v, the squared Mahalanobis distance; infinite where C is not positive definite.
pub(crate) fn squared_distance(v: &Vector3<f64>, covariance: &Matrix3<f64>) -> f64 {
    covariance
        .cholesky()
        .map_or(f64::INFINITY, |c| v.dot(&c.solve(v)))
}

impl<'a> JointEstimate<'a> {
    /// Solves for the `tracks`; `priors` holds the covariance of each frame's motion about `centroid`.
    ///
    /// `None` where a covariance is not positive definite.
    pub(crate) fn solve(
        observations: &'a [Observation],
        tracks: Vec<Track>,
        priors: &[Matrix6<f64>],
        centroid: Vector3<f64>,
    ) -> Option<Self> {
        let mut system = Mat::zeros(6 * priors.len(), 6 * priors.len());
        let mut right = Mat::zeros(6 * priors.len(), 1);
        for (k, prior) in priors.iter().enumerate() {
            add(&mut system, k, k, &prior.cholesky()?.inverse());
        }
        let eliminated: Vec<Eliminated> = tracks
            .iter()
            .map(|track| eliminate(observations, track, &centroid, &mut system, &mut right))
            .collect::<Option<_>>()?;
        let factor = system.llt(Side::Lower).ok()?;
        let solution = factor.solve(&right);
        let motions = (0..priors.len())
            .map(|k| Vector6::from_fn(|r, _| solution[(6 * k + r, 0)]))
            .collect();
        let mut estimate = Self {
            observations,
            tracks,
            positions: Vec::with_capacity(eliminated.len()),
            centroid,
            motions,
            covariance: factor.inverse(),
        };
        for apple in eliminated {
            let position = estimate.position(apple);
            estimate.positions.push(position);
        }
        Some(estimate)
    }

    /// The position of an apple now that the motions are known.
    fn position(&self, apple: Eliminated) -> EstimatedPosition {
        let followed: Vector3<f64> = apple
            .gains
            .iter()
            .map(|(frame, gain)| gain * self.motions[*frame])
            .sum();
        let spread = self.common(&apple.gains, &apple.gains);
        EstimatedPosition {
            center: self.centroid + apple.inverse * apple.sum - followed,
            covariance: apple.inverse + spread,
            gains: apple.gains,
        }
    }

    /// Covariance that two positions have in common because they follow the same motions.
    fn common(&self, a: &[(usize, Matrix3x6<f64>)], b: &[(usize, Matrix3x6<f64>)]) -> Matrix3<f64> {
        let mut sum = Matrix3::zeros();
        for (f, gain) in a {
            for (g, other) in b {
                sum += gain * self.block::<6>(6 * f, 6 * g) * other.transpose();
            }
        }
        sum
    }

    /// A block of the motions' covariance.
    fn block<const N: usize>(&self, row: usize, column: usize) -> SMatrix<f64, N, N> {
        SMatrix::from_fn(|r, c| self.covariance[(row + r, column + c)])
    }

    /// How frame `k` has moved: rotation, radians, then shift, metres.
    pub(crate) fn motion(&self, k: usize) -> Vector6<f64> {
        self.motions[k]
    }

    /// The observation's centre with its frame's motion taken off.
    pub(crate) fn corrected(&self, observation: &Observation) -> Vector3<f64> {
        let j = jacobian(&observation.center, &self.centroid);
        observation.center - j * self.motion(observation.frame)
    }

    /// Shift of frame `k` from frame `reference` at the centroid of the tree, and its covariance.
    pub(crate) fn shift(&self, k: usize, reference: usize) -> (Vector3<f64>, Matrix3<f64>) {
        let shift = |f: usize| self.motions[f].fixed_rows::<3>(3).into_owned();
        let block = |a: usize, b: usize| self.block::<3>(6 * a + 3, 6 * b + 3);
        let cross = block(k, reference);
        let covariance = block(k, k) + block(reference, reference) - cross - cross.transpose();
        (shift(k) - shift(reference), covariance)
    }

    /// Squared Mahalanobis distance of an observation from the apple of track `a`; `counted` tells whether the track
    /// includes it.
    ///
    /// Either way it is a chi-square of three degrees of freedom where the observation is one of that apple at rest.
    pub(crate) fn distance(&self, observation: &Observation, a: usize, counted: bool) -> f64 {
        let position = &self.positions[a];
        let frame = observation.frame;
        let residual = self.corrected(observation) - position.center;
        let j = jacobian(&observation.center, &self.centroid);
        let mut follows = Matrix3x6::zeros();
        for (f, gain) in &position.gains {
            follows -= gain * self.block::<6>(6 * f, 6 * frame);
        }
        let cross = follows * j.transpose();
        let motion = j * self.block::<6>(6 * frame, 6 * frame) * j.transpose();
        let predicted = position.covariance + motion + cross + cross.transpose();
        let covariance = if counted {
            observation.covariance - predicted
        } else {
            observation.covariance + predicted
        };
        let symmetric = (covariance + covariance.transpose()) * 0.5;
        let floor = observation.covariance.trace() * RESIDUAL_VARIANCE_FLOOR;
        squared_distance(&residual, &(symmetric + Matrix3::identity() * floor))
    }

    /// The way from the position of track `b` to that of track `a`, and its covariance.
    pub(crate) fn difference(&self, a: usize, b: usize) -> (Vector3<f64>, Matrix3<f64>) {
        let (a, b) = (&self.positions[a], &self.positions[b]);
        let common = self.common(&a.gains, &b.gains);
        let covariance = a.covariance + b.covariance - common - common.transpose();
        (a.center - b.center, covariance)
    }

    /// The observations of a track.
    pub(crate) fn observations_of(&self, track: usize) -> impl Iterator<Item = &Observation> {
        self.tracks[track].iter().map(|&i| &self.observations[i])
    }
}

/// Takes the apple of `track` out of the unknowns: what it tells about the motions goes into the system.
///
/// Of a track of one observation nothing is left: it tells nothing about its frame.
fn eliminate(
    observations: &[Observation],
    track: &[usize],
    centroid: &Vector3<f64>,
    system: &mut Mat<f64>,
    right: &mut Mat<f64>,
) -> Option<Eliminated> {
    let mut weight = Matrix3::zeros();
    let mut sum = Vector3::zeros();
    let mut coupling = Vec::with_capacity(track.len());
    for observation in track.iter().map(|&i| &observations[i]) {
        let w = observation.covariance.cholesky()?.inverse();
        let j = jacobian(&observation.center, centroid);
        let m = observation.center - centroid;
        weight += w;
        sum += w * m;
        let frame = observation.frame;
        add(system, frame, frame, &(j.transpose() * w * j));
        add_rows(right, frame, &(j.transpose() * w * m));
        coupling.push((frame, w * j));
    }
    let inverse = weight.cholesky()?.inverse();
    let gains: Vec<_> = coupling
        .iter()
        .map(|(frame, block)| (*frame, inverse * block))
        .collect();
    for (f, block) in &coupling {
        for (g, gain) in &gains {
            add(system, *f, *g, &-(block.transpose() * gain));
        }
    }
    for (frame, gain) in &gains {
        add_rows(right, *frame, &-(gain.transpose() * sum));
    }
    Some(Eliminated {
        inverse,
        sum,
        gains,
    })
}

fn add(system: &mut Mat<f64>, row: usize, column: usize, block: &Matrix6<f64>) {
    for r in 0..6 {
        for c in 0..6 {
            system[(6 * row + r, 6 * column + c)] += block[(r, c)];
        }
    }
}

fn add_rows(right: &mut Mat<f64>, row: usize, block: &Vector6<f64>) {
    for r in 0..6 {
        right[(6 * row + r, 0)] += block[r];
    }
}
