//! Data and settings that no one should give, and an answer or a named error for each.

use pomona_ransac::{
    Confidence, Constraint, Constraints, Draws, Estimator, Exhaustive, FixedCount, InlierCount,
    LeastSquares, Local, LocalOptimization, Look, Lossless, Marginal, MarginalScore, Msac,
    NearBest, NoRefit, Pairs, Partners, PerDatum, Preemption, Progress, Prosac, Ransac,
    RansacError, Refiner, RefitOnce, Report, Reweighted, Sampler, Scored, Scorer, Statistical,
    StopReason, Stopping, Tukey, Uniform, Until, Workspace,
};
use proptest::prelude::*;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::ops::Range;

use crate::lines::{Line, Points, unit};

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn points(xy: &[(f64, f64)]) -> Points {
    let (x, y) = xy.iter().copied().unzip();
    Points { x, y }
}

/// Refuses lines outside of a window of slopes.
#[derive(Clone, Copy)]
struct Slopes(f64, f64);

impl Constraint<Points> for Slopes {
    fn name(&self) -> &'static str {
        "slopes"
    }
    fn allows_model(&self, _: &Points, line: &Line) -> bool {
        (self.0..=self.1).contains(&line.slope)
    }
}

#[test]
fn each_kind_of_bad_data_has_its_own_error() {
    let search = Ransac::new(Msac::within(0.1)).stopping(FixedCount::new(50));
    let run = |xy: &[(f64, f64)]| search.run(&points(xy), &mut rng(1));
    let too_few = |available| RansacError::TooFewData {
        needed: 2,
        available,
    };
    assert_eq!(run(&[]).unwrap_err(), too_few(0));
    assert_eq!(run(&[(1.0, 2.0)]).unwrap_err(), too_few(1));
    let degenerate = RansacError::AllDegenerate { draws: 5000 };
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    for hopeless in [
        // All equal; one above the other; not finite.
        [(0.5, 0.5); 20],
        std::array::from_fn(|i| (0.5, i as f64)),
        [(nan, nan); 20],
        [(inf, 1.0); 20],
        std::array::from_fn(|i| (i as f64, nan)),
        std::array::from_fn(|i| (i as f64, if i % 2 == 0 { inf } else { -inf })),
    ] {
        assert_eq!(run(&hopeless).unwrap_err(), degenerate, "{hopeless:?}");
    }
    // Collinear data are what a line is fitted to.
    let collinear: [(f64, f64); 20] = std::array::from_fn(|i| (i as f64, 2.0 * i as f64));
    assert_eq!(run(&collinear).unwrap().inliers.len(), 20);
    // Two good data among bad ones.
    let mut bad = [(nan, inf); 20];
    (bad[3], bad[17]) = ((0.0, 1.0), (1.0, 3.0));
    let search = search.stopping(FixedCount::new(1).max_draws(100_000));
    let report = search.run(&points(&bad), &mut rng(1)).unwrap();
    assert_eq!((report.inliers, report.model.slope), (vec![3, 17], 2.0));
}

#[test]
fn each_kind_of_bad_setting_has_its_own_error() {
    let data = points(&std::array::from_fn::<_, 20, _>(|i| {
        (i as f64, (i % 7) as f64)
    }));
    let run = |threshold: f64| {
        let count = Ransac::new(InlierCount::within(threshold)).run(&data, &mut rng(2));
        let msac = Ransac::new(Msac::within(threshold)).run(&data, &mut rng(2));
        let marginal = Ransac::new(MarginalScore::within(threshold)).run(&data, &mut rng(2));
        [count, msac, marginal]
    };
    for nonsense in [-1.0, f64::NAN, f64::NEG_INFINITY] {
        for outcome in run(nonsense) {
            let (inliers, needed) = (0, 2);
            let error = RansacError::NoConsensus { inliers, needed };
            assert_eq!(outcome.unwrap_err(), error);
        }
    }
    // A threshold of zero takes the data that lie on a line to the last bit, an infinite one all.
    for outcome in run(0.0) {
        assert!(outcome.unwrap().inliers.len() >= 3);
    }
    for outcome in run(f64::INFINITY) {
        assert_eq!(outcome.unwrap().inliers.len(), 20);
    }
    let search = Ransac::new(Msac::within(1.0));
    let never = search.constraint(Slopes(5.0, 4.0)).run(&data, &mut rng(2));
    let (draws, constraint) = (100_000, "slopes");
    let error = RansacError::ConstraintNeverMet { draws, constraint };
    assert_eq!(never.unwrap_err(), error);
    let most = search.min_inliers(usize::MAX).run(&data, &mut rng(2));
    assert!(matches!(most.unwrap_err(), RansacError::NoConsensus { .. }));
    for nothing in [FixedCount::new(0), FixedCount::new(5).max_draws(0)] {
        let none = search.stopping(nothing).run(&data, &mut rng(2));
        assert_eq!(none.unwrap_err(), RansacError::NothingDrawn);
    }
}

#[test]
fn settings_out_of_all_proportion_are_taken_as_large() {
    let data = points(&std::array::from_fn::<_, 20, _>(|i| {
        (i as f64, (i % 7) as f64)
    }));
    let near = NearBest::new(LeastSquares::rounds(usize::MAX)).models(usize::MAX);
    let search = Ransac::new(Msac::within(1.0))
        .stopping(FixedCount::new(20).or(Confidence::new(0.5, u64::MAX).min_draws(u64::MAX)))
        .local_optimization(near)
        .round(usize::MAX);
    #[cfg(feature = "rayon")]
    let search = search.threads(usize::MAX);
    let report = search.run(&data, &mut rng(2)).unwrap();
    assert_eq!(report.stopped, StopReason::HypothesesReached);
    assert!(search.candidates(&data, usize::MAX, &mut rng(2)).is_ok());

    let prosac = Prosac::by_quality(&[f64::NAN; 20], 2, u64::MAX);
    assert!(search.sampler(prosac).run(&data, &mut rng(2)).is_ok());
    let wrong_sizes = [(0, 0), (20, 5), (20, 0), (19, 2)];
    for (data_of_sampler, sample_size) in wrong_sizes {
        let quality = vec![1.0; data_of_sampler];
        let prosac = Prosac::by_quality(&quality, sample_size, 10);
        // An answer or an error, and an end.
        let _ = search.sampler(prosac).run(&data, &mut rng(2));
    }
    let crowd = Pairs::new(20, Crowd);
    assert!(matches!(
        search.sampler(crowd).run(&data, &mut rng(2)),
        Err(RansacError::AllDegenerate { .. })
    ));
}

/// So many partners that they cannot be counted, and none of them there.
struct Crowd;

impl Partners for Crowd {
    fn count(&self, _: usize) -> usize {
        usize::MAX
    }
    fn get(&self, _: usize, k: usize) -> usize {
        k.saturating_add(20)
    }
}

const WINDOW: f64 = 3.0;

/// What must hold of every outcome.
fn check(parts: &Parts, data: &Points, seed: u64) {
    let search = Ransac::new(parts)
        .sampler(parts)
        .constraint(Slopes(-WINDOW, WINDOW))
        .local_optimization(parts)
        .stopping(parts)
        .preemption(parts);
    match search.run(data, &mut rng(seed)) {
        Ok(report) => {
            assert!(report.model.slope.abs() <= WINDOW && report.inliers.len() >= 2);
            assert!(report.inliers.is_sorted() && report.score >= 0.0);
            assert!(report.inliers.iter().all(|&i| i < data.len()));
            assert!((0.0..=1.0).contains(&report.confidence));
            assert!(report.sigma.is_none_or(|sigma| sigma >= 0.0));
            let variance = report.covariance.and_then(|c| c.get(0, 0));
            assert!(variance.is_none_or(|v| v >= 0.0 && v.is_finite()));
        }
        Err(RansacError::NothingDrawn) => panic!("samples were allowed"),
        Err(_) => {}
    }
}

/// One of each kind of part, chosen when the test runs: the product of all kinds as types would take
/// minutes to compile.
struct Parts {
    scorer: AnyScorer,
    sampler: AnySampler,
    local: usize,
    stopping: usize,
    preemption: usize,
}

enum AnyScorer {
    Count(InlierCount<f64>),
    Msac(Msac<f64>),
    Marginal(MarginalScore<f64>),
    BySlope(Msac<fn(&Line) -> f64>),
    PerDatum(PerDatum<Tukey>),
}

enum AnySampler {
    Uniform,
    Prosac(Prosac),
    Local,
    Pairs(Pairs<Later>),
}

/// Calls a method of the scorer that was chosen.
macro_rules! of_scorer {
    ($parts:expr, $method:ident($($argument:expr),*)) => {
        match &$parts.scorer {
            AnyScorer::Count(s) => Scorer::<Points>::$method(s, $($argument),*),
            AnyScorer::Msac(s) => Scorer::<Points>::$method(s, $($argument),*),
            AnyScorer::Marginal(s) => Scorer::<Points>::$method(s, $($argument),*),
            AnyScorer::BySlope(s) => Scorer::<Points>::$method(s, $($argument),*),
            AnyScorer::PerDatum(s) => Scorer::<Points>::$method(s, $($argument),*),
        }
    };
}

impl Scorer<Points> for &Parts {
    fn block_gain(&self, data: &Points, line: &Line, block: Range<usize>) -> f64 {
        of_scorer!(self, block_gain(data, line, block))
    }
    fn threshold(&self, line: &Line) -> f64 {
        of_scorer!(self, threshold(line))
    }
    fn threshold_of(&self, line: &Line, datum: usize) -> f64 {
        of_scorer!(self, threshold_of(line, datum))
    }
    fn weight_of(&self, datum: usize) -> f64 {
        of_scorer!(self, weight_of(datum))
    }
    fn most_gain(&self, data: &Points, range: Range<usize>) -> f64 {
        of_scorer!(self, most_gain(data, range))
    }
    fn select(&self, data: &Points, line: &Line, out: &mut Vec<usize>) {
        of_scorer!(self, select(data, line, out));
    }
}

impl Sampler<Points> for &Parts {
    fn sample(&self, data: &Points, i: u64, draws: &mut Draws, sample: &mut [usize]) -> bool {
        let about = |datum: usize, out: &mut Vec<usize>| out.extend(datum..datum + 4);
        match &self.sampler {
            AnySampler::Uniform => Uniform.sample(data, i, draws, sample),
            AnySampler::Prosac(prosac) => prosac.sample(data, i, draws, sample),
            AnySampler::Local => Local::new(about).sample(data, i, draws, sample),
            AnySampler::Pairs(pairs) => pairs.sample(data, i, draws, sample),
        }
    }
}

impl LocalOptimization<Points> for &Parts {
    fn improve<S: Scorer<Points>, C: Constraints<Points>>(
        &self,
        refiner: &mut Refiner<'_, Points, S, C>,
        best: Scored<Line>,
    ) -> Scored<Line> {
        match self.local {
            2 | 4 => LeastSquares::default().improve(refiner, best),
            3 => Reweighted::by(Marginal::weight).improve(refiner, best),
            _ => best,
        }
    }
    fn finish<S: Scorer<Points>, C: Constraints<Points>>(
        &self,
        refiner: &mut Refiner<'_, Points, S, C>,
        best: Scored<Line>,
    ) -> Scored<Line> {
        match self.local {
            0 => NoRefit.finish(refiner, best),
            1 => RefitOnce.finish(refiner, best),
            _ => self.improve(refiner, best),
        }
    }
    fn runners_up(&self) -> usize {
        if self.local == 4 { 2 } else { 0 }
    }
    fn near(&self) -> f64 {
        0.5
    }
}

impl Stopping for &Parts {
    fn reason(&self, progress: &Progress) -> Option<StopReason> {
        let (few, sure) = (FixedCount::new(6), Confidence::new(0.9, 30));
        match self.stopping {
            0 => few.reason(progress),
            1 => sure.reason(progress),
            2 => sure.accepted_only().reason(progress),
            _ => Until::new(|p: &Progress| p.best_inliers > 3)
                .or(few)
                .reason(progress),
        }
    }
    fn draws_left(&self, progress: &Progress) -> u64 {
        match self.stopping {
            0 => FixedCount::new(6).draws_left(progress),
            1 => Confidence::new(0.9, 30).draws_left(progress),
            _ => u64::MAX,
        }
    }
    fn confidence(&self, progress: &Progress) -> Option<f64> {
        let sure = Confidence::new(0.9, 30).accepted_only();
        (self.stopping == 2)
            .then(|| sure.confidence(progress))
            .flatten()
    }
}

impl Preemption for &Parts {
    fn next_look(&self, seen: usize, data: usize) -> usize {
        match self.preemption {
            0 => Exhaustive.next_look(seen, data),
            1 => Lossless::every(3).next_look(seen, data),
            _ => Statistical::with_error(0.5).next_look(seen, data),
        }
    }
    fn gives_up(&self, look: &Look, bound: f64) -> bool {
        match self.preemption {
            0 => Exhaustive.gives_up(look, bound),
            1 => Lossless::every(3).gives_up(look, bound),
            _ => Statistical::with_error(0.5).gives_up(look, bound),
        }
    }
}

/// Every datum with every later one.
#[derive(Clone, Copy)]
struct Later(usize);

impl Partners for Later {
    fn count(&self, datum: usize) -> usize {
        self.0 - 1 - datum
    }
    fn get(&self, datum: usize, k: usize) -> usize {
        datum + 1 + k
    }
}

fn scorer(which: usize, threshold: f64, data: &Points) -> AnyScorer {
    match which {
        0 => AnyScorer::Count(InlierCount::within(threshold)),
        1 => AnyScorer::Msac(Msac::within(threshold)),
        2 => AnyScorer::Marginal(MarginalScore::within(threshold)),
        3 => AnyScorer::BySlope(Msac::within(|line: &Line| line.slope)),
        _ => {
            // Some data have no threshold, and those of others are anything allowed.
            let thresholds = data.x.iter().map(|x| if *x >= 0.0 { *x } else { 0.1 });
            let thresholds = thresholds.skip(data.len() / 9).collect();
            AnyScorer::PerDatum(PerDatum::new(Tukey, thresholds).expect("thresholds"))
        }
    }
}

fn sampler(which: usize, data: &Points) -> AnySampler {
    match which {
        0 => AnySampler::Uniform,
        1 => AnySampler::Prosac(Prosac::by_quality(&data.y, 2, 10)),
        2 => AnySampler::Local,
        _ => AnySampler::Pairs(Pairs::new(data.len(), Later(data.len()))),
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -2.0..2.0f64,
        2 => (-2_i8..3).prop_map(f64::from),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(f64::MAX),
        1 => Just(f64::MIN_POSITIVE),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn every_combination_gives_an_answer_or_an_error(
        xy in prop::collection::vec((coordinate(), coordinate()), 0..200),
        threshold in prop_oneof![
            0.0..2.0f64, Just(0.0), Just(-0.5), Just(f64::NAN), Just(f64::INFINITY), Just(f64::MIN_POSITIVE),
        ],
        seed in any::<u64>(),
    ) {
        let data = points(&xy);
        // 5 scorers, 4 samplers, 5 refits, 4 ends, 3 bounds.
        for combination in 0..1200 {
            let parts = Parts {
                scorer: scorer(combination % 5, threshold, &data),
                sampler: sampler(combination / 5 % 4, &data),
                local: combination / 20 % 5,
                stopping: combination / 100 % 4,
                preemption: combination / 400,
            };
            check(&parts, &data, seed);
        }
    }
}

/// A million little searches whose refits would leave the window of slopes again and again.
#[test]
fn in_a_million_searches_no_refit_breaks_a_constraint() {
    let (cases, threads) = (1_000_000_u64, 2);
    let part = |first: u64| {
        let mut workspace = Workspace::new();
        let mut tally = [0_u64; 3];
        for seed in (first..cases).step_by(threads) {
            let mut draws = Draws::new(seed, 0);
            let mut data = Points::default();
            let line = Line {
                slope: 4.0 * unit(&mut draws) - 2.0,
                intercept: unit(&mut draws),
            };
            data.add_line(&mut draws, line, 6, 0.2);
            data.add_outliers(&mut draws, 3, 1.0);
            // The window's edge is close to the line, within the noise of a refit.
            let low = line.slope - 0.3 * unit(&mut draws);
            let high = low + 0.4 * unit(&mut draws);
            let search = Ransac::new(Msac::within(0.5))
                .constraint(Slopes(low, high))
                .stopping(FixedCount::new(3).max_draws(12));
            let mut run = |outcome: Result<&Report<Line>, RansacError>| match outcome {
                Ok(report) => {
                    let slope = report.model.slope;
                    assert!(low <= slope && slope <= high, "{seed}: {slope}");
                    let [rule] = report.counts.rejections() else {
                        panic!("one rule")
                    };
                    tally[0] += 1;
                    tally[1] += u64::from(rule.refits > 0);
                }
                Err(_) => tally[2] += 1,
            };
            let mut rng = Draws::new(seed, 1);
            match seed % 4 {
                0 => run(search.local_optimization(RefitOnce).run_with(
                    &mut workspace,
                    &data,
                    &mut rng,
                )),
                1 => {
                    let squares = search.local_optimization(LeastSquares::default());
                    run(squares.run_with(&mut workspace, &data, &mut rng));
                }
                2 => {
                    let weighed = search.local_optimization(Reweighted::by(Tukey::weight));
                    run(weighed.run_with(&mut workspace, &data, &mut rng));
                }
                _ => {
                    let near = NearBest::new(LeastSquares::default());
                    run(search
                        .local_optimization(near)
                        .run_with(&mut workspace, &data, &mut rng));
                }
            }
        }
        tally
    };
    let tallies: Vec<[u64; 3]> = std::thread::scope(|scope| {
        let part = &part;
        let handles: Vec<_> = (0..threads as u64)
            .map(|first| scope.spawn(move || part(first)))
            .collect();
        handles
            .into_iter()
            .map(|h| h.join().expect("no violated constraint"))
            .collect()
    });
    let total = |k: usize| tallies.iter().map(|tally| tally[k]).sum::<u64>();
    println!(
        "{} models, {} with refused refits, {} errors",
        total(0),
        total(1),
        total(2)
    );
    assert!(total(0) > cases / 2 && total(1) > cases / 20);
}
