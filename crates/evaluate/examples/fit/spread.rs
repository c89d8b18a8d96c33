//! How well the stated uncertainties hold: the standard deviations of directions and the covariances of centres.

use crate::scenes::Apple;
use nalgebra::{Point3, Vector3};

/// Errors over what is stated for them.
pub(crate) struct Ratio {
    suite: &'static str,
    /// Angle error over the standard deviation, of an answer at most 20° off.
    direction: Option<f64>,
    /// Squared error of the centre in units of its covariance.
    center: f64,
}

/// Errors up to this angle are those of the right branch, radians (20°).
const RIGHT_RAD: f64 = 0.349;

/// Of a Rayleigh distribution the shares within one and two.
const RAYLEIGH: [f64; 2] = [0.393, 0.865];

/// Quantiles of χ² with three degrees of freedom: 50 and 95 %.
const CHI_SQUARED: [f64; 2] = [2.366, 7.815];

/// What `apple` adds.
pub(crate) fn of_scene(apple: &Apple<'_>) -> Vec<Ratio> {
    let ratio = || {
        let fitted = apple.answer.apple.as_ref()?;
        let covariance = fitted.center_covariance?.matrix_m2();
        let off = fitted.center.point() - Point3::from(apple.truth.center);
        let direction = || {
            let pick = apple.answer.pick.as_ref()?;
            let truth = Vector3::from(apple.truth.direction?);
            let error = pick.direction.vector().angle(&truth);
            (error <= RIGHT_RAD).then_some(error / pick.sd_rad?)
        };
        Some(Ratio {
            suite: apple.suite,
            direction: direction(),
            center: off.dot(&(covariance.try_inverse()? * off)),
        })
    };
    ratio().into_iter().collect()
}

/// Prints for each suite what holds, and the factor of the standard deviations with which the second would.
pub(crate) fn print(ratios: &[Ratio]) {
    let [one, two] = RAYLEIGH.map(|share| 100.0 * share);
    println!(
        "| suite | directions | within 1 sd ({one:.1} %) | within 2 ({two:.1} %) | factor | centres | in the 50 % \
         ellipsoid | in the 95 % ellipsoid | factor |\n|---|---|---|---|---|---|---|---|---|"
    );
    let mut suites: Vec<&str> = ratios.iter().map(|r| r.suite).collect();
    suites.dedup();
    for suite in suites {
        let own = || ratios.iter().filter(|r| r.suite == suite);
        let directions: Vec<f64> = own().filter_map(|r| r.direction).collect();
        let centers: Vec<f64> = own().map(|r| r.center).collect();
        let factor = quantile(&directions, RAYLEIGH[1]) / 2.0;
        let center_factor = (quantile(&centers, 0.95) / CHI_SQUARED[1]).sqrt();
        println!(
            "| {suite} | {} | {:.1} % | {:.1} % | {factor:.2} | {} | {:.1} % | {:.1} % | {center_factor:.2} |",
            directions.len(),
            100.0 * share_up_to(&directions, 1.0),
            100.0 * share_up_to(&directions, 2.0),
            centers.len(),
            100.0 * share_up_to(&centers, CHI_SQUARED[0]),
            100.0 * share_up_to(&centers, CHI_SQUARED[1]),
        );
    }
}

fn share_up_to(values: &[f64], most: f64) -> f64 {
    values.iter().filter(|v| **v <= most).count() as f64 / values.len().max(1) as f64
}

fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = (share * sorted.len() as f64) as usize;
    sorted
        .get(place.min(sorted.len().saturating_sub(1)))
        .copied()
        .unwrap_or(f64::NAN)
}
