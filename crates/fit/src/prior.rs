use thiserror::Error;

/// A Gaussian prior whose mean or standard deviation is not a positive finite number.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("a radius of {mean} ± {sigma}: give two positive finite numbers")]
#[non_exhaustive]
pub struct PriorError {
    /// Mean given.
    pub mean: f64,
    /// Standard deviation given.
    pub sigma: f64,
}

/// What is known of a radius before any point is seen: a Gaussian.
///
/// It counts in a refit like one more measurement, ((r − mean)/sigma)² beside the points'
/// Σ (dᵢ/σᵢ)², so the points' own noise σᵢ has to be given wherever a prior is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusPrior {
    mean: f64,
    sigma: f64,
}

impl RadiusPrior {
    /// A radius of `mean` ± `sigma` (one standard deviation), in the points' unit of length.
    ///
    /// # Errors
    ///
    /// Unless both are positive and finite.
    pub fn new(mean: f64, sigma: f64) -> Result<Self, PriorError> {
        if mean > 0.0 && sigma > 0.0 && mean.is_finite() && sigma.is_finite() {
            Ok(Self { mean, sigma })
        } else {
            Err(PriorError { mean, sigma })
        }
    }

    /// Its mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Its standard deviation.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// (`radius` − mean)/sigma.
    pub(crate) fn deviation(&self, radius: f64) -> f64 {
        (radius - self.mean) / self.sigma
    }
}

/// A prior on the radius together with the standard deviation of the points about the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Knowledge {
    pub(crate) prior: RadiusPrior,
    pub(crate) point_sigma: f64,
}

impl Knowledge {
    /// Refuses a standard deviation that is not positive and finite.
    pub(crate) fn new(prior: RadiusPrior, point_sigma: f64) -> Result<Self, PriorError> {
        RadiusPrior::new(prior.mean, point_sigma).map(|_| Self { prior, point_sigma })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn senseless_priors_are_refused() {
        assert!(RadiusPrior::new(0.04, 0.002).is_ok());
        for (mean, sigma) in [
            (0.0, 1.0),
            (1.0, 0.0),
            (f64::NAN, 1.0),
            (1.0, f64::INFINITY),
        ] {
            assert!(RadiusPrior::new(mean, sigma).is_err());
        }
    }
}
