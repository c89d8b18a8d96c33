//! Refits of the hypotheses near the best.

use pomona_ransac::{
    Draws, Exhaustive, FixedCount, LeastSquares, LocalOptimization, Lossless, Msac, NearBest,
    NoRefit, Ransac, RefitOnce, Report,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use crate::lines::{Line, Points};

/// Two crossing lines of almost the same size, noise as wide as the threshold, and many outliers.
fn hard(seed: u64) -> Points {
    let mut draws = Draws::new(seed, 0);
    let mut points = Points::default();
    let line = |slope, intercept| Line { slope, intercept };
    points.add_line(&mut draws, line(0.5, 0.1), 80, 0.03);
    points.add_line(&mut draws, line(-0.6, 0.0), 74, 0.03);
    points.add_outliers(&mut draws, 250, 1.0);
    points
}

fn run<L: LocalOptimization<Points>>(local: L, seed: u64) -> Report<Line> {
    Ransac::new(Msac::within(0.05))
        .local_optimization(local)
        .stopping(FixedCount::new(80))
        .run(&hard(seed), &mut ChaCha8Rng::seed_from_u64(seed))
        .expect("a model")
}

#[test]
fn the_score_is_never_lower_and_often_higher() {
    let (mut higher, mut more, mut missed) = (0, 0.0, [0, 0]);
    let runs = 300;
    let wrong = |line: &Line| u32::from((line.slope - 0.5).abs() > 0.1);
    for seed in 0..runs {
        let alone = run(LeastSquares::default(), seed);
        let near = run(NearBest::new(LeastSquares::default()), seed);
        assert!(near.score >= alone.score, "{seed}");
        assert_eq!(near.counts.draws, alone.counts.draws);
        higher += u32::from(near.score > alone.score);
        more += (near.score - alone.score) / alone.score / f64::from(runs as u32);
        missed[0] += wrong(&alone.model);
        missed[1] += wrong(&near.model);
    }
    println!("{higher} of {runs} higher, by {more} of the score on average; wrong {missed:?}");
    assert!(higher >= 60, "{higher} of {runs}");
    assert!(missed[1] < missed[0], "{missed:?}");
}

#[test]
fn what_was_found_is_a_fixed_point_of_the_refit() {
    for seed in 0..20 {
        let report = run(NearBest::new(LeastSquares::rounds(100)), seed);
        let data = hard(seed);
        let refitted = data.fit_weighted(&report.inliers, |_| 1.0).expect("a line");
        let score: f64 = (0..data.x.len())
            .map(|i| (data.y[i] - refitted.at(data.x[i])).abs() / 0.05)
            .map(|u| if u <= 1.0 { 1.0 - u * u } else { 0.0 })
            .sum();
        assert!(score <= report.score + 1e-9, "{seed}");
    }
}

#[test]
fn any_settings_give_an_answer_no_worse() {
    for seed in 0..10 {
        let plain = run(NoRefit, seed).score;
        for share in [-1.0, 0.0, 0.3, 1.0, 7.0, f64::NAN] {
            for models in [0, 1, 50] {
                let near = NearBest::new(NoRefit).models(models).share(share);
                // Nothing is refitted: the best stays the best.
                assert_eq!(run(near, seed).score, plain);
                let near = NearBest::new(LeastSquares::default());
                let near = near.models(models).share(share);
                assert!(run(near, seed).score >= run(LeastSquares::default(), seed).score);
            }
        }
        // Of refits that may lower the score, the best outcome is taken.
        let near = run(NearBest::new(RefitOnce).share(0.0), seed);
        assert!(near.score >= run(RefitOnce, seed).score);
    }
}

#[test]
fn giving_up_early_changes_nothing() {
    for seed in 0..20 {
        let search = Ransac::new(Msac::within(0.05))
            .local_optimization(NearBest::new(LeastSquares::default()))
            .stopping(FixedCount::new(200));
        let rng = || ChaCha8Rng::seed_from_u64(seed);
        let data = hard(seed);
        let all = search.preemption(Exhaustive).run(&data, &mut rng());
        let eager = search.preemption(Lossless::default());
        assert_eq!(eager.run(&data, &mut rng()), all);
    }
}
