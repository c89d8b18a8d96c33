use pomona_settings::settings;

settings! {
    /// How large the fruit is: one window of radii for detection and for both methods.
    pub struct FruitConfig {
        /// Smallest plausible radius of a fruit. Smaller: more dents and leaves pass for fruit.
        radius_min_m: f64 = 0.020, "metres", above(0.0).at_most(1.0);
        /// Largest plausible radius of a fruit. Larger: more spheres that take leaves for their surface.
        radius_max_m: f64 = 0.050, "metres", above(0.0).at_most(1.0);
    }
    order {
        radius_max_m > radius_min_m;
    }
}

/// By how much `robust` tries larger spheres than the window allows: before the flattening is fitted, a sphere comes out
/// larger than the fruit's mean radius, and a hidden fruit more so.
const LARGER_HYPOTHESES: f64 = 1.1;

/// By how much a radius fitted by `robust` may leave the spheres that were tried: what noise adds to a fruit at the end
/// of the window.
const FITTED_SLACK: f64 = 0.1;

/// How far below the window the depth check takes a sphere for a fruit: it is rougher than either method, and must not
/// refuse what they would accept.
const CHECK_SMALLER: f64 = 0.9;

/// And how far above it: the spheres of partly hidden fruit come out large.
const CHECK_LARGER: f64 = 1.2;

/// Where in the window the prior of a radius has its mean, as a share of the window's width. The window is wider below,
/// where small fruit and noise are; 38 mm for 20 to 50 mm, about the radius of a dessert apple.
const PRIOR_MEAN: f64 = 0.6;

/// Standard deviation of that prior as a share of the window's width, so that the ends of the window lie two and three of
/// them from the mean; 6 mm for 20 to 50 mm.
const PRIOR_SD: f64 = 0.2;

/// Radii between two ends, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Radii {
    pub(crate) least: f64,
    pub(crate) most: f64,
}

impl Radii {
    /// Whether `radius` is one of them.
    pub(crate) fn contains(&self, radius: f64) -> bool {
        (self.least..=self.most).contains(&radius)
    }
}

impl FruitConfig {
    /// The window itself, as the method `paper` uses it.
    pub(crate) fn radii(&self) -> Radii {
        Radii {
            least: self.radius_min_m,
            most: self.radius_max_m,
        }
    }

    /// Spheres that the method `robust` tries.
    pub(crate) fn hypotheses(&self) -> Radii {
        Radii {
            least: self.radius_min_m,
            most: LARGER_HYPOTHESES * self.radius_max_m,
        }
    }

    /// Fitted radii that the method `robust` accepts.
    pub(crate) fn fitted(&self) -> Radii {
        let tried = self.hypotheses();
        Radii {
            least: (1.0 - FITTED_SLACK) * tried.least,
            most: (1.0 + FITTED_SLACK) * tried.most,
        }
    }

    /// Spheres that the depth check takes for a fruit.
    pub(crate) fn checked(&self) -> Radii {
        Radii {
            least: CHECK_SMALLER * self.radius_min_m,
            most: CHECK_LARGER * self.radius_max_m,
        }
    }

    fn width(&self) -> f64 {
        self.radius_max_m - self.radius_min_m
    }

    /// Mean of the radius before anything is seen, metres.
    pub(crate) fn prior_mean(&self) -> f64 {
        self.radius_min_m + PRIOR_MEAN * self.width()
    }

    /// Standard deviation of the radius before anything is seen, metres.
    pub(crate) fn prior_sd(&self) -> f64 {
        PRIOR_SD * self.width()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_window_gives_each_stage_its_own() {
        let fruit = FruitConfig::default();
        let near = |radii: Radii, least: f64, most: f64| {
            (radii.least - least).abs() < 1e-12 && (radii.most - most).abs() < 1e-12
        };
        assert!(near(fruit.radii(), 0.020, 0.050));
        assert!(near(fruit.hypotheses(), 0.020, 0.055));
        assert!(near(fruit.fitted(), 0.018, 0.0605));
        assert!(near(fruit.checked(), 0.018, 0.060));
        assert!((fruit.prior_mean() - 0.038).abs() < 1e-12);
        assert!((fruit.prior_sd() - 0.006).abs() < 1e-12);
    }
}
