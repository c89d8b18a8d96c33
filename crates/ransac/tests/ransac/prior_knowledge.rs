//! What is known before the search: models to start with, and a prior on models.

use pomona_ransac::{
    Constraint, Draws, Exhaustive, FixedCount, LeastSquares, Lossless, Msac, NearBest, Ransac,
    RansacError, Scorer, StopReason, WithPrior,
};
use proptest::prelude::*;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use crate::lines::{Line, Points};

const THRESHOLD: f64 = 0.02;

fn line(slope: f64, intercept: f64) -> Line {
    Line { slope, intercept }
}

/// Three lines that do not cross between −1 and 1, the smallest first, and outliers.
fn three_lines() -> (Points, [Line; 3]) {
    let truth = [line(0.1, 0.6), line(-0.1, 0.0), line(0.05, -0.5)];
    let mut draws = Draws::new(5, 0);
    let mut points = Points::default();
    for (line, count) in truth.into_iter().zip([40, 60, 80]) {
        points.add_line(&mut draws, line, count, 0.004);
    }
    points.add_outliers(&mut draws, 300, 1.0);
    (points, truth)
}

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(1)
}

struct Falling;

impl Constraint<Points> for Falling {
    fn name(&self) -> &'static str {
        "falling"
    }
    fn allows_model(&self, _: &Points, line: &Line) -> bool {
        line.slope < 0.0
    }
}

#[test]
fn a_model_known_beforehand_is_compared_and_refitted() {
    let (points, truth) = three_lines();
    // One random sample would not find a line, and the models that are given are a little off.
    let near = |k: usize| line(truth[k].slope, truth[k].intercept + 0.008);
    let search = Ransac::new(Msac::within(THRESHOLD))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(1));
    let known = [near(0), near(2), near(1)];
    let report = search
        .initial_models(&known[..])
        .run(&points, &mut rng())
        .unwrap();
    assert!((report.model.intercept - truth[2].intercept).abs() < 0.003);
    // They are neither draws nor hypotheses.
    assert_eq!(report.counts.initial, 3);
    assert_eq!((report.counts.draws, report.counts.hypotheses), (1, 1));
    assert_eq!(report.counts.pruned, 1);
}

#[test]
fn known_models_obey_the_constraints() {
    let (points, truth) = three_lines();
    let search = Ransac::new(Msac::within(THRESHOLD))
        .constraint(Falling)
        .initial_models(truth.to_vec())
        .stopping(FixedCount::new(1).max_draws(1));
    let report = search.run(&points, &mut rng()).unwrap();
    assert_eq!(report.model, truth[1]);
    assert_eq!(report.counts.initial, 1);
    assert!(report.counts.rejections()[0].models >= 2);
    let refused = search.initial_models(vec![truth[0]]);
    let nothing = refused
        .stopping(FixedCount::new(0))
        .run(&points, &mut rng());
    assert_eq!(nothing.unwrap_err(), RansacError::NothingDrawn);
}

#[test]
fn a_rule_that_allows_no_sample_leaves_the_known_models() {
    let (points, truth) = three_lines();
    let search = Ransac::new(Msac::within(THRESHOLD)).stopping(FixedCount::new(0));
    let known = search.initial_models(truth.to_vec());
    let report = known.run(&points, &mut rng()).unwrap();
    assert_eq!(report.model, truth[2]);
    assert_eq!(report.stopped, StopReason::HypothesesReached);
    assert_eq!(report.counts.draws, 0);
    assert_eq!(report.confidence, 0.0);
    let nothing = search.run(&points, &mut rng());
    assert_eq!(nothing.unwrap_err(), RansacError::NothingDrawn);
}

#[test]
fn candidates_are_the_best_different_models_in_whatever_order_they_come() {
    let (points, [small, middle, large]) = three_lines();
    let shifted = |l: Line| line(l.slope, l.intercept + 0.002);
    let best_first = [large, middle, small];
    for order in [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ] {
        let models: Vec<Line> = order
            .iter()
            .flat_map(|&k| [shifted(best_first[k]), best_first[k]])
            .collect();
        let search = Ransac::new(Msac::within(THRESHOLD))
            .initial_models(models)
            .stopping(FixedCount::new(0));
        for most in 1..=3 {
            let found = search.candidates(&points, most, &mut rng()).unwrap();
            let models: Vec<Line> = found.iter().map(|c| c.model).collect();
            assert_eq!(models.len(), most, "{order:?}");
            // Of two that are much the same, noise decides which is better.
            let same = |(a, b): (&Line, &Line)| (a.intercept - b.intercept).abs() < 0.003;
            assert!(models.iter().zip(&best_first).all(same), "{order:?}");
            assert!(found.is_sorted_by(|a, b| a.score >= b.score));
        }
    }
}

#[test]
fn a_prior_turns_the_choice_and_is_part_of_the_score() {
    let (points, truth) = three_lines();
    let plain = Msac::within(THRESHOLD);
    let gain = |line: &Line| plain.score(&points, line, f64::NEG_INFINITY).unwrap();
    // More than the largest line has inliers.
    let low = |line: &Line| if line.intercept < -0.3 { -100.0 } else { 0.0 };
    let scorer = WithPrior::new(plain, low);
    let report = Ransac::new(scorer)
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(2000))
        .run(&points, &mut rng())
        .unwrap();
    assert!((report.model.intercept - truth[1].intercept).abs() < 0.003);
    assert_eq!(report.score, gain(&report.model));
    let of_large = Scorer::<Points>::score(&scorer, &points, &truth[2], f64::NEG_INFINITY);
    assert_eq!(of_large, Some(gain(&truth[2]) - 100.0));
    assert_eq!(
        Scorer::<Points>::score(&scorer, &points, &truth[2], 0.0),
        None
    );
}

#[test]
fn a_model_whose_prior_is_not_finite_is_never_taken() {
    let (points, truth) = three_lines();
    for never in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let search = |prior: f64| {
            Ransac::new(WithPrior::new(Msac::within(THRESHOLD), move |l: &Line| {
                if l.intercept < -0.3 { never } else { prior }
            }))
            .initial_models(truth.to_vec())
            .stopping(FixedCount::new(300))
        };
        let report = search(0.0).run(&points, &mut rng()).unwrap();
        assert_eq!(report.model, truth[1]);
        let none = search(never).run(&points, &mut rng());
        let none = none.unwrap_err();
        assert!(
            matches!(none, RansacError::NoConsensus { inliers: 0, .. }),
            "{none}"
        );
    }
}

#[test]
fn candidates_may_have_negative_scores() {
    let (points, [small, middle, large]) = three_lines();
    let search = Ransac::new(WithPrior::new(Msac::within(THRESHOLD), |_: &Line| -1000.0))
        .initial_models(vec![middle, large, small])
        .stopping(FixedCount::new(0));
    let found = search.candidates(&points, 3, &mut rng()).unwrap();
    let models: Vec<Line> = found.iter().map(|c| c.model).collect();
    assert_eq!(models, [large, middle, small]);
    assert!(found.iter().all(|c| c.score < -900.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// What is abandoned by prior and bound would not have been kept.
    #[test]
    fn abandoning_changes_nothing(seed in any::<u64>(), strength in 0.0..200.0f64, most in 1usize..12) {
        let (points, _) = three_lines();
        let prior = move |line: &Line| -strength * (line.intercept - 0.6).abs();
        let search = Ransac::new(WithPrior::new(Msac::within(THRESHOLD), prior))
            .stopping(FixedCount::new(200));
        let rng = || ChaCha8Rng::seed_from_u64(seed);
        let all = search.preemption(Exhaustive).candidates(&points, most, &mut rng());
        let some = search.preemption(Lossless::default()).candidates(&points, most, &mut rng());
        prop_assert_eq!(all, some);
        let near = search.local_optimization(NearBest::new(LeastSquares::default()).models(most));
        let all = near.preemption(Exhaustive).run(&points, &mut rng()).unwrap();
        let some = near.run(&points, &mut rng()).unwrap();
        prop_assert_eq!((all.model, all.score), (some.model, some.score));
    }
}
