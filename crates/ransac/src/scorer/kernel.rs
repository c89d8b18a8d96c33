/// The gain of a datum whose residual is a given fraction of its threshold.
pub trait Kernel: Sync {
    /// Between 0 and 1, falling; asked for fractions from 0 to 1 only, a datum further off gains 0.
    fn gain(&self, fraction: f64) -> f64;
}

/// 1 for every inlier: the count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flat;

impl Kernel for Flat {
    fn gain(&self, _: f64) -> f64 {
        1.0
    }
}

/// 1 − u², as in [`Msac`](crate::Msac).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quadratic;

impl Kernel for Quadratic {
    fn gain(&self, fraction: f64) -> f64 {
        1.0 - fraction * fraction
    }
}

/// (1 − u²)³: Tukey's biweight (Beaton and Tukey 1974, doi 10.1080/00401706.1974.10489171).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tukey;

impl Tukey {
    /// Weight in a refit of a datum whose residual is `fraction` of its threshold: (1 − u²)².
    pub fn weight(fraction: f64) -> f64 {
        (1.0 - fraction * fraction).powi(2)
    }
}

impl Kernel for Tukey {
    fn gain(&self, fraction: f64) -> f64 {
        (1.0 - fraction * fraction).powi(3)
    }
}

/// A gain averaged over all noise levels up to a largest one: the loss of MAGSAC++.
///
/// The noise's σ is unknown and uniform up to σₘₐₓ, residuals at a given σ are those of three
/// Gaussian coordinates, and the threshold is k σₘₐₓ with k² the 99 % quantile of χ² with three degrees
/// of freedom. The weight of a residual r is then proportional to
/// Γ(1, r²/2σₘₐₓ²) − Γ(1, k²/2), and the loss is ∫ r w(r) dr (Barath et al. 2020, section 3,
/// arXiv 1912.05909). For three degrees the incomplete gamma function is an exponential: with K = k²/2
/// and u = r/(k σₘₐₓ), loss(u) ∝ 1 − exp(−K u²) − K u² exp(−K), and the gain is 1 − loss(u)/loss(1).
///
/// So the threshold can be generous: a residual of half of it loses three quarters of the gain,
/// where [`Quadratic`] takes one quarter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marginal;

/// Half the 99 % quantile of χ² with three degrees of freedom.
const HALF_QUANTILE: f64 = 11.344_866_730_144_373 / 2.0;

impl Marginal {
    /// Weight in a refit of a datum whose residual is `fraction` of its threshold, 1 for none:
    /// exp(−K u²) − exp(−K), scaled.
    pub fn weight(fraction: f64) -> f64 {
        let floor = (-HALF_QUANTILE).exp();
        ((-HALF_QUANTILE * fraction * fraction).exp() - floor) / (1.0 - floor)
    }
}

impl Kernel for Marginal {
    fn gain(&self, fraction: f64) -> f64 {
        let floor = (-HALF_QUANTILE).exp();
        let loss = |x: f64| 1.0 - (-x).exp() - x * floor;
        1.0 - loss(HALF_QUANTILE * fraction * fraction) / loss(HALF_QUANTILE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn falls_from_one(kernel: &impl Kernel) {
        let gains: Vec<f64> = (0..=1000)
            .map(|i| kernel.gain(f64::from(i) / 1000.0))
            .collect();
        assert!((gains[0] - 1.0).abs() < 1e-15);
        assert!(gains.iter().rev().is_sorted());
        assert!(gains.iter().all(|g| (0.0..=1.0).contains(g)));
    }

    #[test]
    fn gains_fall_from_one() {
        falls_from_one(&Flat);
        falls_from_one(&Quadratic);
        falls_from_one(&Tukey);
        falls_from_one(&Marginal);
        assert_eq!(Marginal.gain(1.0), 0.0);
    }

    #[test]
    fn a_weight_is_the_slope_of_the_gain_over_the_residual() {
        fn check(kernel: &impl Kernel, weight: fn(f64) -> f64) {
            let slope = |u: f64| (kernel.gain(u - 1e-5) - kernel.gain(u + 1e-5)) / 2e-5 / u;
            let scale = slope(0.5) / weight(0.5);
            for u in [0.1, 0.3, 0.7, 0.9] {
                assert!((slope(u) / scale - weight(u)).abs() < 1e-6, "{u}");
            }
        }
        check(&Tukey, Tukey::weight);
        check(&Marginal, Marginal::weight);
        check(&Quadratic, |_| 1.0);
    }

    #[test]
    fn the_marginal_loss_is_the_integral_of_its_weight() {
        // By the trapezoid rule, from the weight as the paper has it.
        let weight = |u: f64| (-HALF_QUANTILE * u * u).exp() - (-HALF_QUANTILE).exp();
        let steps = 100_000;
        let step = 1.0 / f64::from(steps);
        let mut integral = vec![0.0];
        for i in 0..steps {
            let (a, b) = (f64::from(i) * step, f64::from(i + 1) * step);
            let slice = 0.5 * step * (a * weight(a) + b * weight(b));
            integral.push(integral[i as usize] + slice);
        }
        let whole = integral[steps as usize];
        for u in [0.1, 0.25, 0.5, 0.9] {
            let part = integral[(u * f64::from(steps)).round() as usize];
            let gain = 1.0 - part / whole;
            assert!((Marginal.gain(u) - gain).abs() < 1e-8, "{u}");
        }
    }
}
