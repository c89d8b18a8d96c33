//! The noise and the covariance that a report tells, held against repeated draws of the same scene.

use pomona_ransac::{
    Candidates, Draws, Estimator, FixedCount, LeastSquares, Linearization, Msac, PerDatum,
    Quadratic, Ransac,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::ops::Range;

use crate::lines::{Line, Points, gaussian, unit};

const TRUTH: Line = Line {
    slope: 0.7,
    intercept: -0.2,
};
/// 95 % quantile of χ² with two degrees of freedom.
const QUANTILE: f64 = 5.991_464_547_107_982;
const DRAWS: u64 = 2000;

/// Shares of draws whose 95 % ellipsoid covers the truth, and the mean of σ, at a threshold.
fn coverage(noise: f64, threshold: f64) -> (f64, f64) {
    let search = Ransac::new(Msac::within(threshold))
        .local_optimization(LeastSquares::rounds(100))
        .stopping(FixedCount::new(60));
    let (mut covered, mut sigmas) = (0.0, 0.0);
    for seed in 0..DRAWS {
        let mut draws = Draws::new(seed, 0);
        let mut points = Points::default();
        points.add_line(&mut draws, TRUTH, 300, noise);
        points.add_outliers(&mut draws, 100, 40.0);
        let report = search
            .run(&points, &mut ChaCha8Rng::seed_from_u64(seed))
            .expect("a model with a covariance");
        let deviation = [
            report.model.slope - TRUTH.slope,
            report.model.intercept - TRUTH.intercept,
        ];
        let covariance = report.covariance.expect("a model with a covariance");
        let distance = covariance
            .mahalanobis_squared(&deviation)
            .expect("a model with a covariance");
        covered += f64::from(u8::from(distance <= QUANTILE));
        sigmas += report.sigma.expect("a model with a covariance");
    }
    (covered / DRAWS as f64, sigmas / DRAWS as f64)
}

#[test]
fn the_ellipsoid_covers_the_truth_as_often_as_it_says() {
    // 0.5 % is one standard error of the share.
    for (cut, off) in [(5.0, 0.01), (3.0, 0.01), (2.0, 0.02)] {
        let (covered, sigma) = coverage(0.05, 0.05 * cut);
        println!("threshold {cut} sigma: {covered} covered, sigma {sigma}");
        assert!((0.93..=0.97).contains(&covered), "{cut}: {covered}");
        assert!((sigma / 0.05 - 1.0).abs() < off, "{cut}: {sigma}");
    }
}

/// The middle of points of a plane: two rows for each datum.
struct Middle(Vec<[f64; 2]>);

impl Estimator for Middle {
    type Model = [f64; 2];
    const SAMPLE_SIZE: usize = 1;
    const PARAMETERS: usize = 2;

    fn len(&self) -> usize {
        self.0.len()
    }
    fn fit(&self, sample: &[usize], candidates: &mut Candidates<[f64; 2]>) {
        candidates.push(self.0[sample[0]]);
    }
    fn refit(&self, inliers: &[usize], _: &[f64; 2]) -> Option<[f64; 2]> {
        let n = inliers.len() as f64;
        let mean = |k: usize| inliers.iter().map(|&i| self.0[i][k]).sum::<f64>() / n;
        Some([mean(0), mean(1)])
    }
    fn residuals(&self, model: &[f64; 2], block: Range<usize>, out: &mut [f64]) {
        for (r, p) in out.iter_mut().zip(&self.0[block]) {
            *r = (p[0] - model[0]).hypot(p[1] - model[1]);
        }
    }
    fn linearize(&self, model: &[f64; 2], datum: usize, rows: &mut Linearization) {
        rows.push(model[0] - self.0[datum][0], &[1.0, 0.0]);
        rows.push(model[1] - self.0[datum][1], &[0.0, 1.0]);
    }
}

#[test]
fn two_rows_for_each_datum_are_two_components_of_the_noise() {
    for cut in [2.0, 3.0, 6.0] {
        let search =
            Ransac::new(Msac::within(cut * 0.1)).local_optimization(LeastSquares::rounds(50));
        let (mut sigmas, mut squares, mut deviations) = (0.0, 0.0, 0.0);
        let runs = 300;
        for seed in 0..runs {
            let mut draws = Draws::new(seed, 3);
            let around = |_| [0.1 * gaussian(&mut draws), 0.1 * gaussian(&mut draws)];
            let data = Middle((0..400).map(around).collect());
            let search = search.stopping(FixedCount::new(30));
            let report = search
                .run(&data, &mut ChaCha8Rng::seed_from_u64(seed))
                .unwrap();
            let covariance = report.covariance.unwrap();
            sigmas += report.sigma.unwrap() / runs as f64;
            deviations += report.model[0].powi(2) + report.model[1].powi(2);
            squares += covariance.get(0, 0).unwrap() + covariance.get(1, 1).unwrap();
            assert_eq!(covariance.get(0, 1), Some(0.0));
        }
        assert!((sigmas - 0.1).abs() < 0.002, "{cut}: {sigmas}");
        // A sum of 600 squares: its standard error is 6 %.
        let ratio: f64 = deviations / squares;
        assert!((0.8..1.2).contains(&ratio), "{cut}: {ratio}");
    }
}

#[test]
fn thresholds_of_each_datum_weigh_its_rows() {
    // Noise of 0.01 on one half and 0.1 on the other, and thresholds in proportion.
    let mut draws = Draws::new(1, 1);
    let mut points = Points::default();
    points.add_line(&mut draws, TRUTH, 1000, 0.01);
    points.add_line(&mut draws, TRUTH, 1000, 0.1);
    let thresholds: Vec<f64> = (0..2000)
        .map(|i| if i < 1000 { 0.04 } else { 0.4 })
        .collect();
    let run = |weights: Vec<f64>| {
        let score = PerDatum::new(Quadratic, thresholds.clone()).unwrap();
        Ransac::new(score.weights(weights).unwrap())
            .local_optimization(LeastSquares::default())
            .run(&points, &mut ChaCha8Rng::seed_from_u64(5))
            .unwrap()
    };
    let report = run(vec![1.0; 2000]);
    // σ belongs to the largest threshold.
    assert!((report.sigma.unwrap() - 0.1).abs() < 0.004, "{report:?}");
    // 1000 data of σ = 0.01 and 1000 of 0.1 determine the intercept to 1/√(1000/0.01² + 1000/0.1²).
    let intercept = report.covariance.unwrap().standard_deviation(1).unwrap();
    let expected = (1000.0 / 0.01_f64.powi(2) + 1000.0 / 0.1_f64.powi(2))
        .sqrt()
        .recip();
    assert!(
        (intercept / expected - 1.0).abs() < 0.06,
        "{intercept} {expected}"
    );
    // A quarter of the weight is twice the noise.
    let quarter = run(vec![0.25; 2000]).sigma.unwrap();
    assert!((quarter / 0.05 - 1.0).abs() < 0.04, "{quarter}");
}

#[test]
fn where_nothing_is_determined_nothing_is_told() {
    let search = Ransac::new(Msac::within(0.1));
    let run = |points: &Points| {
        search
            .run(points, &mut ChaCha8Rng::seed_from_u64(1))
            .unwrap()
    };
    // Two points leave no freedom.
    let mut points = Points::default();
    points.push(0.0, 1.0);
    points.push(1.0, 3.0);
    let report = run(&points);
    assert!(report.sigma.is_none() && report.covariance.is_none());
    // Three on a line without noise.
    points.push(2.0, 5.0);
    let report = run(&points);
    assert_eq!(report.sigma, Some(0.0));
    assert_eq!(report.covariance.unwrap().standard_deviation(0), Some(0.0));
    // An evenly filled band does not tell its noise.
    let mut draws = Draws::new(0, 0);
    let mut band = Points::default();
    (0..500).for_each(|_| band.push(unit(&mut draws), unit(&mut draws)));
    let report = run(&band);
    assert_eq!(report.sigma, Some(0.1));
}
