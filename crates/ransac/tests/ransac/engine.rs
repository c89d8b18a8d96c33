//! The engine's contract, held against a model so simple that every answer is known:
//! the mean of numbers, most of which agree.

use pomona_ransac::{
    Candidates, Confidence, Constraint, Estimator, Exhaustive, FixedCount, InlierCount,
    LeastSquares, Msac, Ransac, RansacError, RefitOnce, Report, StopReason, Stopping,
};
use proptest::prelude::*;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::ops::Range;

struct Numbers(Vec<f64>);

impl Estimator for Numbers {
    type Model = f64;
    const SAMPLE_SIZE: usize = 2;

    fn len(&self) -> usize {
        self.0.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<f64>) {
        let (a, b) = (self.0[sample[0]], self.0[sample[1]]);
        // Two numbers far apart have no common value: the degenerate sample of this model.
        if (a - b).abs() < 5.0 {
            candidates.push(f64::midpoint(a, b));
        }
    }

    fn refit(&self, inliers: &[usize], _: &f64) -> Option<f64> {
        let sum: f64 = inliers.iter().map(|&i| self.0[i]).sum();
        (!inliers.is_empty()).then(|| sum / inliers.len() as f64)
    }

    fn residuals(&self, model: &f64, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = (self.0[i] - model).abs();
        }
    }
}

#[derive(Clone, Copy)]
struct AtMost(f64);

impl Constraint<Numbers> for AtMost {
    fn name(&self) -> &'static str {
        "at most"
    }
    fn allows_model(&self, _: &Numbers, model: &f64) -> bool {
        *model <= self.0
    }
}

struct NotDatum(usize);

impl Constraint<Numbers> for NotDatum {
    fn name(&self) -> &'static str {
        "not this datum"
    }
    fn allows_sample(&self, _: &Numbers, sample: &[usize]) -> bool {
        !sample.contains(&self.0)
    }
    fn allows_model(&self, _: &Numbers, _: &f64) -> bool {
        true
    }
}

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn mostly_ten() -> Numbers {
    Numbers(
        (0..3000)
            .map(|i| {
                if i % 3 == 0 {
                    f64::from(i)
                } else {
                    10.0 + f64::from(i % 5) * 0.1
                }
            })
            .collect(),
    )
}

fn check<M: PartialEq + std::fmt::Debug>(report: &Report<M>) {
    assert!(report.inliers.is_sorted());
    assert!(report.residuals.mean <= report.residuals.rms + 1e-12);
    assert!(report.residuals.rms <= report.residuals.max + 1e-12);
}

#[test]
fn report_belongs_to_the_final_model() {
    let data = mostly_ten();
    let report = Ransac::new(InlierCount::within(0.5))
        .local_optimization(RefitOnce)
        .run(&data, &mut rng(1))
        .unwrap();
    check(&report);
    let inliers: Vec<usize> = (0..data.len())
        .filter(|&i| (data.0[i] - report.model).abs() <= 0.5)
        .collect();
    assert_eq!(report.inliers, inliers);
    assert_eq!(report.score, inliers.len() as f64);
    let squares: f64 = inliers
        .iter()
        .map(|&i| (data.0[i] - report.model).powi(2))
        .sum();
    assert!((report.residuals.rms - (squares / inliers.len() as f64).sqrt()).abs() < 1e-12);
    assert_eq!(report.stopped, StopReason::HypothesesReached);
    assert_eq!(report.counts.hypotheses, 1000);
    assert_eq!(report.counts.refits, 1);
    assert!(report.counts.draws >= report.counts.hypotheses + report.counts.degenerate);
}

#[test]
fn same_seed_same_report() {
    let run = |seed| {
        Ransac::new(Msac::within(0.5))
            .local_optimization(LeastSquares::default())
            .run(&mostly_ten(), &mut rng(seed))
            .unwrap()
    };
    assert_eq!(run(5), run(5));
}

#[test]
fn giving_up_early_does_not_change_the_outcome() {
    for seed in 0..20 {
        let eager = Ransac::new(InlierCount::within(0.15)).run(&mostly_ten(), &mut rng(seed));
        let patient = Ransac::new(InlierCount::within(0.15))
            .preemption(Exhaustive)
            .run(&mostly_ten(), &mut rng(seed));
        assert_eq!(eager, patient);
    }
}

#[test]
fn a_constraint_holds_through_the_refit() {
    // The inliers' mean is 10.2; a model may be at most 10.1, so the refit must be refused.
    let data = mostly_ten();
    let report = Ransac::new(InlierCount::within(0.5))
        .constraint(AtMost(10.1))
        .local_optimization(RefitOnce)
        .run(&data, &mut rng(2))
        .unwrap();
    check(&report);
    assert!(report.model <= 10.1);
    let [at_most] = report.counts.rejections() else {
        panic!("one rule")
    };
    assert_eq!((at_most.constraint, at_most.refits), ("at most", 1));
    assert!(at_most.models > 0);
}

#[test]
fn each_constraint_is_counted_by_itself() {
    let data = mostly_ten();
    let report = Ransac::new(InlierCount::within(0.5))
        .constraint(AtMost(12.0))
        .constraint(NotDatum(1))
        .stopping(FixedCount::new(20_000).max_draws(20_000))
        .run(&data, &mut rng(2))
        .unwrap();
    let [at_most, not_datum] = report.counts.rejections() else {
        panic!("two rules")
    };
    assert!(at_most.models > 0 && at_most.samples == 0);
    assert!(not_datum.models == 0 && not_datum.samples > 0);
    let c = &report.counts;
    assert_eq!(
        c.draws,
        c.degenerate + c.accepted + at_most.models + not_datum.samples
    );
}

#[test]
fn every_failure_has_its_own_error() {
    let search = Ransac::new(InlierCount::within(0.1));
    let run = |data: Vec<f64>| search.run(&Numbers(data), &mut rng(0)).unwrap_err();
    assert_eq!(
        run(vec![]),
        RansacError::TooFewData {
            needed: 2,
            available: 0
        }
    );
    assert_eq!(
        run(vec![1.0]),
        RansacError::TooFewData {
            needed: 2,
            available: 1
        }
    );
    assert!(matches!(
        run(vec![f64::NAN; 10]),
        RansacError::AllDegenerate { .. }
    ));
    assert!(matches!(
        run(vec![0.0, 100.0, 200.0]),
        RansacError::AllDegenerate { .. }
    ));

    let ten = Numbers(vec![10.0; 10]);
    let never = search
        .constraint(AtMost(9.0))
        .run(&ten, &mut rng(0))
        .unwrap_err();
    assert!(matches!(
        never,
        RansacError::ConstraintNeverMet {
            constraint: "at most",
            ..
        }
    ));
    let few = search.min_inliers(11).run(&ten, &mut rng(0)).unwrap_err();
    assert_eq!(
        few,
        RansacError::NoConsensus {
            inliers: 10,
            needed: 11
        }
    );
    let none = search
        .stopping(FixedCount::new(0))
        .run(&ten, &mut rng(0))
        .unwrap_err();
    assert_eq!(none, RansacError::NothingDrawn);
    for threshold in [f64::NAN, -1.0] {
        let nothing = Ransac::new(InlierCount::within(threshold)).run(&ten, &mut rng(0));
        assert_eq!(
            nothing.unwrap_err(),
            RansacError::NoConsensus {
                inliers: 0,
                needed: 2
            }
        );
    }
}

#[test]
fn a_threshold_may_depend_on_the_model() {
    let data = mostly_ten();
    let tenth = |model: &f64| model.abs() / 10.0;
    let report = Ransac::new(InlierCount::within(tenth))
        .run(&data, &mut rng(3))
        .unwrap();
    assert!(
        report
            .inliers
            .iter()
            .all(|&i| (data.0[i] - report.model).abs() <= report.model / 10.0)
    );
}

#[test]
fn confidence_ends_a_search_early_and_not_without_a_model() {
    let search = Ransac::new(InlierCount::within(0.5)).stopping(Confidence::new(0.99, 10_000));
    let report = search.run(&mostly_ten(), &mut rng(4)).unwrap();
    assert_eq!(report.stopped, StopReason::Confident);
    assert!(report.counts.draws < 100, "{}", report.counts.draws);
    let empty = search
        .run(&Numbers(vec![f64::NAN; 5]), &mut rng(4))
        .unwrap_err();
    assert_eq!(empty, RansacError::AllDegenerate { draws: 10_000 });
}

#[test]
fn the_confidence_told_is_that_of_the_rule() {
    // Two thirds of the models are refused.
    let constrained = Ransac::new(InlierCount::within(0.5)).constraint(AtMost(10.1));
    let counts = Confidence::new(0.99, 100_000).min_draws(3);
    let all = constrained.stopping(counts).run(&mostly_ten(), &mut rng(4));
    let accepted = constrained
        .stopping(counts.accepted_only())
        .run(&mostly_ten(), &mut rng(4));
    let miss = |report: &Report<f64>, samples: u64| {
        let (inliers, data) = (report.inliers.len() as f64, 3000.0);
        (1.0 - inliers / data * (inliers - 1.0) / (data - 1.0)).powf(samples as f64)
    };
    let (all, accepted) = (all.unwrap(), accepted.unwrap());
    let counts = accepted.counts;
    assert!(counts.accepted < counts.draws && all.counts.draws < counts.draws);
    assert!((accepted.confidence - (1.0 - miss(&accepted, counts.accepted))).abs() < 1e-9);
    assert!((all.confidence - (1.0 - miss(&all, all.counts.draws))).abs() < 1e-9);
    assert!(accepted.confidence >= 0.99 && accepted.stopped == StopReason::Confident);
    // The same through a rule that has nothing to say of it.
    let either = constrained
        .stopping(FixedCount::new(100_000).or(Confidence::new(0.99, 100_000).accepted_only()))
        .run(&mostly_ten(), &mut rng(4))
        .unwrap();
    assert!((either.confidence - (1.0 - miss(&either, either.counts.accepted))).abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn local_optimisation_never_lowers_the_score(
        data in prop::collection::vec(-20.0..20.0f64, 2..200), seed in any::<u64>(),
    ) {
        let data = Numbers(data);
        let plain = Ransac::new(InlierCount::within(1.0)).stopping(FixedCount::new(1).max_draws(500));
        let local = plain.local_optimization(LeastSquares::default());
        if let (Ok(plain), Ok(local)) = (plain.run(&data, &mut rng(seed)), local.run(&data, &mut rng(seed))) {
            prop_assert!(local.score >= plain.score);
        }
    }

    #[test]
    fn any_numbers_give_an_answer_or_an_error(
        data in prop::collection::vec(prop_oneof![
            -1e3..1e3f64, Just(f64::NAN), Just(f64::INFINITY), Just(f64::MAX), Just(0.0),
        ], 0..50),
        threshold in prop_oneof![0.0..10.0f64, Just(f64::NAN), Just(f64::INFINITY)],
        seed in any::<u64>(),
    ) {
        let result = Ransac::new(Msac::within(threshold))
            .local_optimization(LeastSquares::default())
            .stopping(FixedCount::new(50))
            .run(&Numbers(data), &mut rng(seed));
        if let Ok(report) = result {
            prop_assert!(report.model.is_finite());
        }
    }
}
