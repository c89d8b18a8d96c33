//! The same report, bit for bit, however the work is divided.

use pomona_ransac::{
    Confidence, Constraint, Constraints, Draws, Estimator, Exhaustive, FixedCount, InitialModels,
    InlierCount, LeastSquares, Local, LocalOptimization, Lossless, Marginal, MarginalScore, Msac,
    NearBest, Pairs, Partners, PerDatum, Preemption, Prosac, Ransac, Report, Reweighted, Sampler,
    Scorer, Statistical, Stopping, Tukey, Unconstrained, Uniform, WithPrior,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use crate::lines::{Line, Points};
use crate::numbers::Numbers;

type Search<T, B> = Ransac<Msac<f64>, Uniform, Unconstrained, LeastSquares, T, B>;

fn search<T: Stopping, B: Preemption>(stopping: T, preemption: B) -> Search<T, B> {
    Ransac::new(Msac::within(0.7))
        .local_optimization(LeastSquares::default())
        .stopping(stopping)
        .preemption(preemption)
}

/// Everything a report holds, with all digits.
fn digits<M: std::fmt::Debug>(report: &Report<M>) -> String {
    format!("{report:?}")
}

#[cfg(feature = "rayon")]
static POOLS: std::sync::LazyLock<Vec<rayon::ThreadPool>> = std::sync::LazyLock::new(|| {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = [1, 2, 8, 64].map(pool);
    pools.into_iter().map(|p| p.expect("threads")).collect()
});

/// The same digits for rounds of any size, on any number of threads.
fn check<E, S, P, C, L, T, B, G>(search: &Ransac<S, P, C, L, T, B, G>, data: &E, seed: u64)
where
    E: Estimator<Model: std::fmt::Debug>,
    S: Scorer<E> + Clone,
    P: Sampler<E> + Clone,
    C: Constraints<E> + Clone,
    L: LocalOptimization<E> + Sync + Clone,
    T: Stopping + Clone,
    B: Preemption + Clone,
    G: InitialModels<E::Model> + Clone,
{
    let run = |search: Ransac<S, P, C, L, T, B, G>| {
        let report = search.run(data, &mut ChaCha8Rng::seed_from_u64(seed));
        digits(&report.expect("a model"))
    };
    let one_by_one = run(search.clone().round(1));
    for round in [2, 7, 32, 1000] {
        let report = run(search.clone().round(round));
        assert_eq!(report, one_by_one, "round of {round}, seed {seed}");
    }
    #[cfg(feature = "rayon")]
    for pool in POOLS.iter() {
        let threads = pool.current_num_threads();
        let report = pool.install(|| run(search.clone().parallel()));
        assert_eq!(report, one_by_one, "{threads} threads");
        let report = pool.install(|| run(search.clone().parallel().round(3)));
        assert_eq!(report, one_by_one, "{threads} threads, round of 3");
    }
}

fn check_numbers<T: Stopping + Copy, B: Preemption + Copy>(stopping: T, preemption: B) {
    for seed in 0..5 {
        check(
            &search(stopping, preemption),
            &Numbers::noisy(seed, 5000),
            seed,
        );
    }
}

#[test]
fn a_fixed_count_is_reproducible() {
    check_numbers(FixedCount::new(500), Lossless::default());
}

#[test]
fn a_search_that_stops_by_confidence_is_reproducible() {
    check_numbers(Confidence::new(0.9999, 2000), Lossless::default());
}

#[test]
fn a_statistical_bound_is_reproducible() {
    // An error probability so large that models are lost: the same ones must be lost everywhere.
    check_numbers(FixedCount::new(500), Statistical::with_error(0.9));
    check_numbers(Confidence::new(0.9999, 2000), Statistical::with_error(0.9));
}

/// A line among outliers, in random order.
fn scene(seed: u64) -> Points {
    let mut draws = Draws::new(seed, 0);
    let mut points = Points::default();
    let line = Line {
        slope: 0.4,
        intercept: 0.1,
    };
    for _ in 0..50 {
        points.add_line(&mut draws, line, 20, 0.03);
        points.add_outliers(&mut draws, 40, 1.0);
    }
    points
}

/// With each bound, each way to refit, and two ways to end.
fn check_rest<S, P>(scorer: &S, sampler: &P)
where
    S: Scorer<Points> + Clone,
    P: Sampler<Points> + Clone,
{
    for seed in 0..2 {
        let data = scene(seed);
        let plain = Ransac::new(scorer.clone())
            .sampler(sampler.clone())
            .constraint(NotSteep)
            .stopping(FixedCount::new(200).or(Confidence::new(0.9999, 1000).accepted_only()));
        let bold = Statistical::with_error(0.9);
        check(&plain, &data, seed);
        let squares = plain.clone().local_optimization(LeastSquares::default());
        check(&squares.clone().preemption(bold), &data, seed);
        check(&squares.preemption(Lossless::every(700)), &data, seed);
        let weighed = Reweighted::by(Marginal::weight);
        check(&plain.clone().local_optimization(weighed), &data, seed);
        let near = plain.local_optimization(NearBest::new(LeastSquares::default()));
        check(&near, &data, seed);
        check(&near.clone().preemption(bold), &data, seed);
        let known: Vec<Line> = (0..40)
            .map(|k| Line {
                slope: 0.03 * f64::from(k),
                intercept: 0.1,
            })
            .collect();
        let known = near.initial_models(known);
        check(&known, &data, seed);
        check(&known.preemption(bold), &data, seed);
    }
}

/// Refuses every other line.
#[derive(Clone, Copy)]
struct NotSteep;

impl Constraint<Points> for NotSteep {
    fn name(&self) -> &'static str {
        "not steep"
    }
    fn allows_model(&self, _: &Points, line: &Line) -> bool {
        line.slope.abs() < 1.0
    }
}

/// The ten data about it.
fn about(datum: usize, out: &mut Vec<usize>) {
    out.extend(datum.saturating_sub(5)..datum + 6);
}

#[derive(Clone)]
struct Later;

impl Partners for Later {
    fn count(&self, datum: usize) -> usize {
        2999 - datum
    }
    fn get(&self, datum: usize, k: usize) -> usize {
        datum + 1 + k
    }
}

#[test]
fn every_sampler_is_reproducible() {
    let quality: Vec<f64> = (0..3000).map(|i| f64::from(i % 60)).collect();
    let msac = Msac::within(0.06);
    check_rest(&msac, &Uniform);
    check_rest(&msac, &Prosac::by_quality(&quality, 2, 300));
    check_rest(
        &msac,
        &Local::new(about).spread(|a: usize, b: usize| a.abs_diff(b) > 1),
    );
    check_rest(&msac, &Pairs::new(3000, Later));
}

#[test]
fn every_scorer_is_reproducible() {
    let thresholds = (0..3000).map(|i| 0.04 + 0.001 * f64::from(i % 40));
    let weights = (0..3000).map(|i| f64::from(i % 7) / 6.0).collect();
    let each = PerDatum::new(Tukey, thresholds.collect()).expect("thresholds");
    check_rest(&InlierCount::within(0.06), &Uniform);
    check_rest(&MarginalScore::within(0.1), &Uniform);
    check_rest(&each.clone(), &Uniform);
    check_rest(&each.weights(weights).expect("weights"), &Uniform);
}

#[test]
fn a_prior_is_reproducible() {
    let flat = |line: &Line| -20.0 * line.slope.abs();
    check_rest(&WithPrior::new(Msac::within(0.06), flat), &Uniform);
    check_rest(&WithPrior::new(InlierCount::within(0.06), flat), &Uniform);
}

#[test]
fn candidates_are_reproducible() {
    let data = scene(3);
    let run = |round: usize| {
        let search = search(FixedCount::new(300), Lossless::default()).round(round);
        let rng = &mut ChaCha8Rng::seed_from_u64(3);
        format!("{:?}", search.candidates(&data, 20, rng))
    };
    assert!([2, 32, 500].iter().all(|&round| run(round) == run(1)));
}

#[test]
fn a_lossless_bound_gives_the_bits_of_scoring_everything() {
    for seed in 0..20 {
        let data = Numbers::noisy(seed, 5000);
        let rng = || ChaCha8Rng::seed_from_u64(seed);
        let all = search(FixedCount::new(300), Exhaustive)
            .run(&data, &mut rng())
            .unwrap();
        for interval in [1, 128, 1000, 3000, usize::MAX] {
            let eager = search(FixedCount::new(300), Lossless::every(interval))
                .run(&data, &mut rng())
                .unwrap();
            assert_eq!(digits(&eager), digits(&all), "every {interval}");
        }
        // With runners-up to keep as well, and a score that is not a sum of ones.
        let data = scene(seed);
        let near = Ransac::new(MarginalScore::within(0.1))
            .local_optimization(NearBest::new(LeastSquares::default()));
        let all = near.preemption(Exhaustive).run(&data, &mut rng()).unwrap();
        for interval in [1, 300, 1024, 2500] {
            let eager = near.preemption(Lossless::every(interval));
            let eager = eager.run(&data, &mut rng()).unwrap();
            assert_eq!(digits(&eager), digits(&all), "every {interval}");
        }
    }
}

#[test]
fn a_statistical_bound_loses_no_more_than_it_may() {
    // The data stand in random order by construction. Sampling is uniform and nothing is
    // refitted, so the guarantee covers the whole search.
    let (runs, allowed) = (2000, 0.05);
    let mut lost = 0;
    for seed in 0..runs {
        let data = Numbers::noisy(seed, 1500);
        let stopping = FixedCount::new(60);
        let plain = Ransac::new(InlierCount::within(0.3)).stopping(stopping);
        let rng = || ChaCha8Rng::seed_from_u64(seed);
        let all = plain.preemption(Exhaustive).run(&data, &mut rng()).unwrap();
        let bold = plain
            .preemption(Statistical::with_error(allowed))
            .run(&data, &mut rng())
            .unwrap();
        lost += u32::from(bold.score < all.score);
        assert!(bold.score <= all.score && bold.inliers.len() as f64 == bold.score);
    }
    assert!(
        f64::from(lost) <= allowed * runs as f64,
        "{lost} of {runs} lost"
    );
}

#[test]
fn a_statistical_bound_saves_most_of_the_work() {
    let data = Numbers::noisy(1, 20_000);
    let scored = |run: &dyn Fn()| {
        data.scored.store(0, std::sync::atomic::Ordering::Relaxed);
        run();
        data.scored.load(std::sync::atomic::Ordering::Relaxed)
    };
    let plain = Ransac::new(InlierCount::within(0.3)).stopping(FixedCount::new(300));
    let rng = || ChaCha8Rng::seed_from_u64(1);
    let all = scored(&|| drop(plain.preemption(Exhaustive).run(&data, &mut rng())));
    let lossless = scored(&|| drop(plain.run(&data, &mut rng())));
    let bold = Statistical::with_error(0.001);
    let statistical = scored(&|| drop(plain.preemption(bold).run(&data, &mut rng())));
    assert!(all >= 300 * data.len());
    assert!(
        lossless < all && statistical < all / 5,
        "{all} {lossless} {statistical}"
    );
}
