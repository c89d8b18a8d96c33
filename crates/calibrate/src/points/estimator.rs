//! Point pairs for the engine.

use super::similarity::{self, Similarity};
use nalgebra::Point3;
use pomona_ransac::{Candidates, Estimator};
use std::ops::Range;

/// Samples of three pairs, and the distance in the robot's frame as the residual.
#[derive(Clone, Debug)]
pub(crate) struct PointPairs {
    pub(crate) camera: Vec<Point3<f64>>,
    pub(crate) robot: Vec<Point3<f64>>,
    /// Whether the scale is fitted too, to find out what is wrong with it.
    pub(crate) free_scale: bool,
}

impl PointPairs {
    pub(crate) fn fit_to(&self, chosen: &[usize], weights: Option<&[f64]>) -> Option<Similarity> {
        let pairs = chosen.iter().enumerate().map(|(k, &i)| {
            let weight = weights.map_or(1.0, |w| w[k]);
            (self.camera[i], self.robot[i], weight)
        });
        similarity::fit(pairs, self.free_scale)
    }

    pub(crate) fn residual(&self, model: &Similarity, i: usize) -> f64 {
        nalgebra::distance(&model.apply(&self.camera[i]), &self.robot[i])
    }

    /// The pairs with the camera's z reversed: a left-handed frame made right-handed.
    pub(crate) fn mirrored(&self) -> Self {
        let mut mirrored = self.clone();
        mirrored.camera.iter_mut().for_each(|p| p.z = -p.z);
        mirrored
    }
}

impl Estimator for PointPairs {
    type Model = Similarity;
    const SAMPLE_SIZE: usize = 3;

    fn len(&self) -> usize {
        self.camera.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Similarity>) {
        if let Some(model) = self.fit_to(sample, None) {
            candidates.push(model);
        }
    }

    fn refit(&self, inliers: &[usize], _current: &Similarity) -> Option<Similarity> {
        self.fit_to(inliers, None)
    }

    fn refit_weighted(
        &self,
        inliers: &[usize],
        weights: &[f64],
        _current: &Similarity,
    ) -> Option<Similarity> {
        self.fit_to(inliers, Some(weights))
    }

    fn residuals(&self, model: &Similarity, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = self.residual(model, i);
        }
    }
}
