//! Places of all apples and shifts of all frames, estimated together.
//!
//! A sighting of apple a in frame k is m = xₐ + J δₖ + e with J = [−[m − c]× I]: its own error e with the
//! sighting's covariance, and the frame's small motion δₖ = (rotation, shift) about the middle c of the tree, which has as
//! its prior what the pose states of its error and what trees sway. Linear, and so solved at once; the apples are
//! eliminated first (Schur complement), which leaves six unknowns for each frame.

use crate::sighting::Sighting;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3x6, Matrix6, Vector3, Vector6};

/// Sightings of one apple, as indices, of different frames.
pub(crate) type Track = Vec<usize>;

/// An apple's place, and what its error has to do with the frames'.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub(crate) center: Vector3<f64>,
    pub(crate) covariance: Matrix3<f64>,
    /// Covariance of the place with all frames' motions.
    cross: DMatrix<f64>,
    /// By how much it follows them.
    gain: DMatrix<f64>,
}

/// The joint estimate.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    middle: Vector3<f64>,
    motions: DVector<f64>,
    covariance: DMatrix<f64>,
    pub(crate) places: Vec<Place>,
}

/// The middle of all sightings.
pub(crate) fn middle_of(sightings: &[Sighting]) -> Vector3<f64> {
    let sum: Vector3<f64> = sightings.iter().map(|s| s.center).sum();
    sum / (sightings.len().max(1) as f64)
}

/// How a frame's motion moves a sighting.
pub(crate) fn jacobian(center: &Vector3<f64>, middle: &Vector3<f64>) -> Matrix3x6<f64> {
    let mut j = Matrix3x6::zeros();
    j.fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&-(center - middle).cross_matrix());
    j.fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&Matrix3::identity());
    j
}

/// vᵀ C⁻¹ v; infinite where C is no covariance.
pub(crate) fn squared_distance(v: &Vector3<f64>, covariance: &Matrix3<f64>) -> f64 {
    covariance
        .cholesky()
        .map_or(f64::INFINITY, |c| v.dot(&c.solve(v)))
}

impl Joint {
    /// Solves for the `tracks`; `priors` holds the covariance of each frame's motion about `middle`.
    ///
    /// `None` where a covariance is none.
    pub(crate) fn solve(
        sightings: &[Sighting],
        tracks: &[Track],
        priors: &[Matrix6<f64>],
        middle: Vector3<f64>,
    ) -> Option<Self> {
        let size = 6 * priors.len();
        let mut system = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        for (k, prior) in priors.iter().enumerate() {
            let weight = prior.cholesky()?.inverse();
            add(&mut system, k, k, &weight);
        }
        let mut eliminated = Vec::with_capacity(tracks.len());
        for track in tracks {
            let mut weight = Matrix3::zeros();
            let mut sum = Vector3::zeros();
            let mut coupling = DMatrix::zeros(3, size);
            for &i in track {
                let s = &sightings[i];
                let w = s.covariance.cholesky()?.inverse();
                let j = jacobian(&s.center, &middle);
                let m = s.center - middle;
                weight += w;
                sum += w * m;
                add(&mut system, s.frame, s.frame, &(j.transpose() * w * j));
                let mut part = right.fixed_rows_mut::<6>(6 * s.frame);
                part += j.transpose() * w * m;
                coupling
                    .fixed_view_mut::<3, 6>(0, 6 * s.frame)
                    .copy_from(&(w * j));
            }
            let inverse = weight.cholesky()?.inverse();
            // Of a track of one sighting nothing is left: it tells nothing of its frame.
            let gain = DMatrix::from_fn(3, 3, |r, c| inverse[(r, c)]) * &coupling;
            system -= coupling.transpose() * &gain;
            right -= gain.transpose() * DVector::from_column_slice(sum.as_slice());
            eliminated.push((inverse, sum, gain));
        }
        let symmetric = (&system + system.transpose()) * 0.5;
        let covariance = symmetric.cholesky()?.inverse();
        let motions = &covariance * right;
        let places = eliminated
            .into_iter()
            .map(|(inverse, sum, gain)| {
                let pulled = &gain * &motions;
                let cross = -(&gain * &covariance);
                let spread = &cross * gain.transpose();
                Place {
                    center: middle + inverse * sum - Vector3::new(pulled[0], pulled[1], pulled[2]),
                    covariance: inverse - Matrix3::from_fn(|r, c| spread[(r, c)]),
                    cross,
                    gain,
                }
            })
            .collect();
        Some(Self {
            middle,
            motions,
            covariance,
            places,
        })
    }

    /// How frame `k` has moved: rotation, then shift.
    pub(crate) fn motion(&self, k: usize) -> Vector6<f64> {
        self.motions.fixed_rows::<6>(6 * k).into()
    }

    /// The sighting's place with its frame's motion taken off.
    pub(crate) fn corrected(&self, s: &Sighting) -> Vector3<f64> {
        s.center - jacobian(&s.center, &self.middle) * self.motion(s.frame)
    }

    /// Shift of frame `k` from frame `reference` at the middle of the tree, and its covariance.
    pub(crate) fn shift(&self, k: usize, reference: usize) -> (Vector3<f64>, Matrix3<f64>) {
        let at = |f: usize| 6 * f + 3;
        let by: Vector3<f64> = self.motions.fixed_rows::<3>(at(k)).into_owned()
            - self.motions.fixed_rows::<3>(at(reference));
        let block = |a: usize, b: usize| -> Matrix3<f64> {
            self.covariance
                .fixed_view::<3, 3>(at(a), at(b))
                .into_owned()
        };
        let cross = block(k, reference);
        let covariance = block(k, k) + block(reference, reference) - cross - cross.transpose();
        (by, covariance)
    }

    /// Squared Mahalanobis distance of a sighting from apple `a`, in which it counts already or not.
    ///
    /// Both ways it is a chi-square of three degrees of freedom where the sighting is one of that apple at rest.
    pub(crate) fn distance(&self, s: &Sighting, a: usize, counted: bool) -> f64 {
        let place = &self.places[a];
        let residual = self.corrected(s) - place.center;
        let j = jacobian(&s.center, &self.middle);
        let own: Matrix6<f64> = self
            .covariance
            .fixed_view::<6, 6>(6 * s.frame, 6 * s.frame)
            .into_owned();
        let cross = place.cross.fixed_view::<3, 6>(0, 6 * s.frame).into_owned() * j.transpose();
        let predicted = place.covariance + j * own * j.transpose() + cross + cross.transpose();
        let covariance = if counted {
            s.covariance - predicted
        } else {
            s.covariance + predicted
        };
        let symmetric = (covariance + covariance.transpose()) * 0.5;
        let scale = s.covariance.trace() * 1e-9;
        squared_distance(&residual, &(symmetric + Matrix3::identity() * scale))
    }

    /// Covariance of the difference of two apples' places.
    pub(crate) fn difference(&self, a: usize, b: usize) -> Matrix3<f64> {
        let (a, b) = (&self.places[a], &self.places[b]);
        let common = &a.cross * b.gain.transpose();
        let common = Matrix3::from_fn(|r, c| common[(r, c)]);
        a.covariance + b.covariance + common + common.transpose()
    }
}

fn add(system: &mut DMatrix<f64>, row: usize, column: usize, block: &Matrix6<f64>) {
    let mut part = system.fixed_view_mut::<6, 6>(6 * row, 6 * column);
    part += block;
}
