//! Scores with thresholds and weights of each datum's own.

use pomona_ransac::{
    Estimator, Exhaustive, FixedCount, Flat, InlierCount, Kernel, Lossless, Marginal,
    MarginalScore, Msac, PerDatum, Quadratic, Ransac, Reweighted, Scorer, Tukey,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use crate::numbers::Numbers;

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(11)
}

fn same<E: Estimator>(a: &impl Scorer<E>, b: &impl Scorer<E>, estimator: &E, model: &E::Model) {
    let score = |s: f64| (s * 1e9).round();
    let of_a = a.score(estimator, model, f64::NEG_INFINITY).map(score);
    let of_b = b.score(estimator, model, f64::NEG_INFINITY).map(score);
    assert_eq!(of_a, of_b);
    let (mut of_a, mut of_b) = (vec![], vec![]);
    a.select(estimator, model, &mut of_a);
    b.select(estimator, model, &mut of_b);
    assert_eq!(of_a, of_b);
}

fn equal<K: Kernel>(kernel: K, threshold: f64) -> PerDatum<K> {
    PerDatum::new(kernel, vec![threshold; 3000]).expect("thresholds")
}

#[test]
fn equal_thresholds_give_the_plain_scores() {
    let data = Numbers::noisy(1, 3000);
    for model in [10.0, 10.3, 40.0] {
        for t in [0.0, 0.7, f64::INFINITY] {
            same(&equal(Flat, t), &InlierCount::within(t), &data, &model);
            same(&equal(Quadratic, t), &Msac::within(t), &data, &model);
            same(
                &equal(Marginal, t),
                &MarginalScore::within(t),
                &data,
                &model,
            );
        }
    }
}

#[test]
fn weights_move_the_answer_and_thresholds_choose_the_inliers() {
    // Sixty data say 5, a hundred say 50: the many win, until they weigh half as much.
    let mut data = Numbers::noisy(0, 0);
    data.values = (0..160).map(|i| if i < 60 { 5.0 } else { 50.0 }).collect();
    let score = PerDatum::new(Quadratic, vec![0.5; 160]).unwrap();
    let plain = Ransac::new(score.clone()).run(&data, &mut rng()).unwrap();
    assert_eq!((plain.model, plain.score), (50.0, 100.0));
    let weights = (0..160).map(|i| if i < 60 { 1.0 } else { 0.5 }).collect();
    let weighted = Ransac::new(score.weights(weights).unwrap());
    let report = weighted.run(&data, &mut rng()).unwrap();
    assert_eq!(
        (report.model, report.score, report.inliers.len()),
        (5.0, 60.0, 60)
    );

    let wide: Vec<f64> = (0..160)
        .map(|i| if i % 2 == 0 { 0.5 } else { 100.0 })
        .collect();
    let report = Ransac::new(PerDatum::new(Flat, wide.clone()).unwrap())
        .run(&data, &mut rng())
        .unwrap();
    assert_eq!(report.model, 50.0);
    assert!(
        report
            .inliers
            .iter()
            .all(|&i| (data.values[i] - 50.0).abs() <= wide[i])
    );
    assert_eq!(report.inliers.len(), 130);
}

#[test]
fn giving_up_is_lossless_with_weights_too() {
    let data = Numbers::noisy(4, 4000);
    let weights = (0..4000).map(|i| f64::from(i % 10) / 9.0).collect();
    let score = PerDatum::new(Marginal, vec![0.7; 4000]).unwrap();
    let search = Ransac::new(score.weights(weights).unwrap()).stopping(FixedCount::new(400));
    let all = search.clone().preemption(Exhaustive).run(&data, &mut rng());
    let eager = search
        .preemption(Lossless::default())
        .run(&data, &mut rng());
    assert_eq!(eager.unwrap(), all.unwrap());
}

#[test]
fn reweighting_climbs_to_the_top_of_its_score() {
    // 900 data at 10 and 100 at 10.8, whose pull the mean (10.08) feels in full.
    let mut data = Numbers::noisy(0, 0);
    let value = |i| if i % 10 == 0 { 10.8 } else { 10.0 };
    data.values = (0..1000).map(value).collect();
    let score = PerDatum::new(Tukey, vec![1.0; 1000]).unwrap();
    let score_at = |model: f64| score.score(&data, &model, f64::NEG_INFINITY).unwrap();
    let on_a_grid = (0..2000).map(|i| 10.0 + f64::from(i) * 1e-4);
    let top = on_a_grid
        .max_by(|a, b| score_at(*a).total_cmp(&score_at(*b)))
        .unwrap();
    assert!(top > 10.001 && top < 10.03, "{top}");

    let report = Ransac::new(score.clone())
        .stopping(FixedCount::new(20))
        .local_optimization(Reweighted::by(Tukey::weight).rounds(100))
        .run(&data, &mut rng())
        .unwrap();
    assert!((report.model - top).abs() < 1e-4, "{} {top}", report.model);
    assert!(report.score >= score_at(top) && report.counts.refits > 2);
}

#[test]
fn the_report_tells_median_and_confidence() {
    let mut data = Numbers::noisy(0, 0);
    data.values = vec![10.0, 10.0, 10.0, 10.0, 90.0, 700.0];
    let report = Ransac::new(InlierCount::within(0.5))
        .stopping(FixedCount::new(3))
        .run(&data, &mut rng())
        .unwrap();
    assert_eq!(report.residuals.median, 0.0);
    // 4 inliers of 6: three pairs miss with (9/15)³.
    assert!((report.confidence - (1.0 - 0.6_f64.powi(3))).abs() < 1e-12);
}
