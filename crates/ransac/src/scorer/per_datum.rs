use super::kernel::Kernel;
use super::scoring::{Scorer, fraction};
use crate::{Estimator, estimator::blocks};
use std::{error::Error, fmt, ops::Range};

/// A score in which every datum has a threshold and a weight of its own.
///
/// A depth reading at two metres is less certain than one at half a metre, and a match may be half as
/// likely as another: datum i gains wᵢ · kernel(rᵢ/tᵢ) where rᵢ ≤ tᵢ, and nothing beyond. It is an inlier
/// where rᵢ ≤ tᵢ, whatever its weight. The estimator measures plain residuals and knows of neither.
///
/// ```
/// use pomona_ransac::{PerDatum, Quadratic, Ransac};
///
/// // Noise grows with the square of the distance.
/// let depth_m: [f64; 3] = [0.5, 1.0, 2.0];
/// let thresholds = depth_m.iter().map(|z| 0.004 * z * z).collect();
/// let search = Ransac::new(PerDatum::new(Quadratic, thresholds)?.weights(vec![1.0, 1.0, 0.5])?);
/// # Ok::<(), pomona_ransac::PerDatumError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PerDatum<K> {
    kernel: K,
    thresholds: Vec<f64>,
    /// Without an entry where all weights are 1.
    weights: Vec<f64>,
    /// Sum of the weights from each datum on.
    left: Vec<f64>,
}

/// Thresholds or weights that make no score.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PerDatumError {
    /// A threshold is negative or NaN.
    Threshold {
        /// Number of the datum.
        datum: usize,
        /// Its threshold.
        threshold: f64,
    },
    /// A weight is not between 0 and 1.
    Weight {
        /// Number of the datum.
        datum: usize,
        /// Its weight.
        weight: f64,
    },
    /// There are not as many weights as thresholds.
    Lengths {
        /// How many weights were given.
        weights: usize,
        /// How many thresholds there are.
        thresholds: usize,
    },
}

impl fmt::Display for PerDatumError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Threshold { datum, threshold } => write!(
                f,
                "the threshold of datum {datum} is {threshold}: give one of 0 or more"
            ),
            Self::Weight { datum, weight } => write!(
                f,
                "the weight of datum {datum} is {weight}: give one between 0 and 1"
            ),
            Self::Lengths {
                weights,
                thresholds,
            } => write!(f, "{weights} weights for {thresholds} thresholds"),
        }
    }
}

impl Error for PerDatumError {}

impl<K: Kernel> PerDatum<K> {
    /// A threshold for each datum, in the order of the data; all weights are 1.
    ///
    /// Data past the end of the list are never inliers.
    ///
    /// # Errors
    ///
    /// [`PerDatumError::Threshold`] for one that is negative or NaN.
    pub fn new(kernel: K, thresholds: Vec<f64>) -> Result<Self, PerDatumError> {
        let wrong = thresholds.iter().position(|t| !(*t >= 0.0));
        if let Some(datum) = wrong {
            let threshold = thresholds[datum];
            return Err(PerDatumError::Threshold { datum, threshold });
        }
        Ok(Self {
            kernel,
            thresholds,
            weights: Vec::new(),
            left: Vec::new(),
        })
    }

    /// A weight for each datum.
    ///
    /// # Errors
    ///
    /// [`PerDatumError::Weight`] for one outside of 0..=1, [`PerDatumError::Lengths`] where there
    /// are not as many as thresholds.
    pub fn weights(self, weights: Vec<f64>) -> Result<Self, PerDatumError> {
        if weights.len() != self.thresholds.len() {
            return Err(PerDatumError::Lengths {
                weights: weights.len(),
                thresholds: self.thresholds.len(),
            });
        }
        let wrong = weights.iter().position(|w| !(0.0..=1.0).contains(w));
        if let Some(datum) = wrong {
            let weight = weights[datum];
            return Err(PerDatumError::Weight { datum, weight });
        }
        // Summed from the end, so that what is left of the last few keeps its digits.
        let mut left = vec![0.0; weights.len() + 1];
        for datum in (0..weights.len()).rev() {
            left[datum] = left[datum + 1] + weights[datum];
        }
        Ok(Self {
            weights,
            left,
            ..self
        })
    }

    fn weight(&self, datum: usize) -> f64 {
        self.weights.get(datum).copied().unwrap_or(1.0)
    }

    fn is_inlier(&self, datum: usize, residual: f64) -> bool {
        self.thresholds.get(datum).is_some_and(|&t| residual <= t)
    }
}

impl<E: Estimator, K: Kernel> Scorer<E> for PerDatum<K> {
    fn block_gain(&self, estimator: &E, model: &E::Model, block: Range<usize>) -> f64 {
        estimator.fold_residuals(model, block, 0.0, |gain, datum, residual| {
            if !self.is_inlier(datum, residual) {
                return gain;
            }
            let fraction = fraction(residual, self.thresholds[datum]);
            gain + self.weight(datum) * self.kernel.gain(fraction)
        })
    }

    /// The largest of all thresholds.
    fn threshold(&self, _: &E::Model) -> f64 {
        self.thresholds.iter().copied().fold(0.0, f64::max)
    }

    fn threshold_of(&self, _: &E::Model, datum: usize) -> f64 {
        self.thresholds.get(datum).copied().unwrap_or(f64::NAN)
    }

    fn weight_of(&self, datum: usize) -> f64 {
        self.weight(datum)
    }

    fn gain_at(&self, fraction: f64) -> f64 {
        self.kernel.gain(fraction)
    }

    fn most_gain(&self, _: &E, range: Range<usize>) -> f64 {
        let from = |datum: usize| self.left.get(datum).copied().unwrap_or(0.0);
        if self.weights.is_empty() {
            range.len() as f64
        } else if range.end >= self.weights.len() {
            from(range.start)
        } else {
            from(range.start) - from(range.end)
        }
    }

    fn count(&self, estimator: &E, model: &E::Model) -> usize {
        blocks(estimator.len())
            .map(|block| {
                estimator.fold_residuals(model, block, 0, |count, datum, residual| {
                    count + usize::from(self.is_inlier(datum, residual))
                })
            })
            .sum()
    }

    fn select(&self, estimator: &E, model: &E::Model, out: &mut Vec<usize>) {
        out.clear();
        for block in blocks(estimator.len()) {
            estimator.fold_residuals(model, block, (), |(), datum, residual| {
                if self.is_inlier(datum, residual) {
                    out.push(datum);
                }
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Quadratic;

    #[test]
    fn what_makes_no_score_is_refused() {
        let score = |t: f64| PerDatum::new(Quadratic, vec![1.0, t]);
        for wrong in [-1.0, f64::NAN] {
            let error = score(wrong).unwrap_err();
            assert!(matches!(error, PerDatumError::Threshold { datum: 1, .. }));
        }
        let good = score(0.0).unwrap();
        let short = good.clone().weights(vec![1.0]).unwrap_err();
        let (weights, thresholds) = (1, 2);
        assert_eq!(
            short,
            PerDatumError::Lengths {
                weights,
                thresholds
            }
        );
        for wrong in [-0.1, 1.1, f64::NAN] {
            let error = good.clone().weights(vec![wrong, 1.0]).unwrap_err();
            assert!(matches!(error, PerDatumError::Weight { datum: 0, .. }));
        }
    }
}
