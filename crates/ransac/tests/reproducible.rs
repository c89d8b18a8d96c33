//! The same report, bit for bit, however the work is divided.

use pomona_ransac::{
    Confidence, Estimator, Exhaustive, FixedCount, InlierCount, LeastSquares, Lossless, Msac,
    Preemption, Ransac, Report, Statistical, Stopping,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

mod numbers;
use numbers::Numbers;

fn search<T: Stopping, B: Preemption>(
    stopping: T,
    preemption: B,
) -> Ransac<Msac<f64>, pomona_ransac::Uniform, pomona_ransac::Unconstrained, LeastSquares, T, B> {
    Ransac::new(Msac::within(0.7))
        .local_optimization(LeastSquares::default())
        .stopping(stopping)
        .preemption(preemption)
}

/// Everything a report holds, scores and models as bits.
fn bits(report: &Report<f64>) -> (u64, u64, String) {
    (
        report.model.to_bits(),
        report.score.to_bits(),
        format!("{:?} {:?}", report.counts, report.inliers),
    )
}

fn check<T: Stopping + Copy, B: Preemption + Copy>(stopping: T, preemption: B) {
    for seed in 0..5 {
        let data = Numbers::noisy(seed, 5000);
        let run = |round: usize| {
            let report = search(stopping, preemption)
                .round(round)
                .run(&data, &mut ChaCha8Rng::seed_from_u64(seed));
            bits(&report.expect("a model"))
        };
        let one_by_one = run(1);
        for round in [2, 7, 32, 1000] {
            assert_eq!(run(round), one_by_one, "round of {round}, seed {seed}");
        }
        #[cfg(feature = "rayon")]
        for threads in [1, 2, 8, 64] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads");
            let report = pool.install(|| {
                search(stopping, preemption)
                    .parallel()
                    .run(&data, &mut ChaCha8Rng::seed_from_u64(seed))
            });
            let report = report.expect("a model");
            assert_eq!(bits(&report), one_by_one, "{threads} threads");
        }
    }
}

#[test]
fn a_fixed_count_is_reproducible() {
    check(FixedCount::new(500), Lossless::default());
}

#[test]
fn a_search_that_stops_by_confidence_is_reproducible() {
    check(Confidence::new(0.9999, 2000), Lossless::default());
}

#[test]
fn a_statistical_bound_is_reproducible() {
    // An error probability so large that models are lost: the same ones must be lost everywhere.
    check(FixedCount::new(500), Statistical::with_error(0.9));
    check(Confidence::new(0.9999, 2000), Statistical::with_error(0.9));
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
            assert_eq!(bits(&eager), bits(&all), "every {interval}");
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
