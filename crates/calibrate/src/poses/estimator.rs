//! Pose pairs for the engine.

use super::motions::{self, LEAST_ROTATION_RAD};
use super::refine::least_squares;
use super::system::{PosePair, PoseSolution, Scale};
use super::{daniilidis, park, shah};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use pomona_ransac::{Candidates, Estimator};
use std::ops::Range;

/// What finds the unknowns from few samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum PoseSolver {
    /// Park and Martin 1994, doi 10.1109/70.326576: AX = XB, rotation first, then translation.
    Park,
    /// Daniilidis 1999, doi 10.1177/02783649922066213: AX = XB by dual quaternions, both at once.
    Daniilidis,
    /// Shah 2013, doi 10.1115/1.4024473: AX = ZB by the Kronecker product.
    Shah,
}

impl PoseSolver {
    /// The published algorithm on all `pairs` alike, without weights or refinement.
    pub(crate) fn solve(self, pairs: &[PosePair]) -> Option<PoseSolution> {
        let camera = match self {
            Self::Park => park::solve(&motions::between(pairs)),
            Self::Daniilidis => daniilidis::solve(&motions::between(pairs)),
            Self::Shah => return shah::solve(pairs),
        }?;
        let target = mean(pairs.iter().map(|p| p.carrier.inv_mul(&(camera * p.seen))))?;
        let model = PoseSolution { camera, target };
        model.is_finite().then_some(model)
    }
}

/// The mean of transforms that are all about the same: of the translations, and of the quaternions with signs
/// made to agree.
fn mean(transforms: impl Iterator<Item = Isometry3<f64>>) -> Option<Isometry3<f64>> {
    let (mut sum, mut place, mut n) = (Quaternion::new(0.0, 0.0, 0.0, 0.0), Vector3::zeros(), 0.0);
    for t in transforms {
        let q = *t.rotation.quaternion();
        sum += if sum.dot(&q) < 0.0 { -q } else { q };
        place += t.translation.vector;
        n += 1.0;
    }
    let rotation = UnitQuaternion::try_new(sum, 1e-6)?;
    Some(Isometry3::from_parts(
        Translation3::from(place / n),
        rotation,
    ))
}

/// Samples of three, and an offset in units of the tolerances as the residual.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PosePairs<'a> {
    pub(crate) pairs: &'a [PosePair],
    pub(crate) solver: PoseSolver,
    pub(crate) tolerance: Scale,
}

impl Estimator for PosePairs<'_> {
    type Model = PoseSolution;
    const SAMPLE_SIZE: usize = 3;

    fn len(&self) -> usize {
        self.pairs.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<PoseSolution>) {
        let pairs: Vec<PosePair> = sample.iter().map(|&i| self.pairs[i]).collect();
        // Three poses that hardly turn, or about one axis only, leave the answer to the noise.
        let spread = motions::spread(&pairs);
        if spread.across_rad < LEAST_ROTATION_RAD {
            return;
        }
        if let Some(model) = self.solver.solve(&pairs) {
            candidates.push(model);
        }
    }

    fn refit(&self, inliers: &[usize], current: &PoseSolution) -> Option<PoseSolution> {
        let pairs: Vec<PosePair> = inliers.iter().map(|&i| self.pairs[i]).collect();
        least_squares(&pairs, &vec![1.0; pairs.len()], current, &self.tolerance)
    }

    fn residuals(&self, model: &PoseSolution, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = model.offset(&self.pairs[i]).squared(&self.tolerance).sqrt();
        }
    }
}
