//! Several structures in the same data: one after the other, and in competition.

use pomona_ransac::{
    Competition, Constraint, Draws, Ended, Extraction, FixedCount, InlierCount, LeastSquares, Msac,
    Ransac, RansacError, Selection, Sequential,
};
use proptest::prelude::*;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use crate::lines::{Line, Points};

const NOISE: f64 = 0.004;
const THRESHOLD: f64 = 0.015;

/// Five lines, which cross each other.
fn truth() -> [Line; 5] {
    let line = |slope, intercept| Line { slope, intercept };
    [
        line(0.0, 0.0),
        line(0.9, 0.1),
        line(-0.8, 0.1),
        line(0.3, -0.5),
        line(-0.2, 0.6),
    ]
}

fn five_lines(seed: u64) -> Points {
    let mut draws = Draws::new(seed, 0);
    let mut points = Points::default();
    for (line, count) in truth().into_iter().zip([200, 180, 160, 140, 120]) {
        points.add_line(&mut draws, line, count, NOISE);
    }
    points.add_outliers(&mut draws, 300, 1.0);
    points
}

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn subset(points: &Points, data: &[usize]) -> Points {
    Points {
        x: data.iter().map(|&i| points.x[i]).collect(),
        y: data.iter().map(|&i| points.y[i]).collect(),
    }
}

type Search = Ransac<
    Msac<f64>,
    pomona_ransac::Uniform,
    pomona_ransac::Unconstrained,
    LeastSquares,
    FixedCount,
>;

fn search() -> Search {
    Ransac::new(Msac::within(THRESHOLD))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(1500))
}

fn extract(points: &Points, rule: Sequential, seed: u64) -> Extraction<Line> {
    let mut rng = rng(seed);
    rule.run(points.x.len(), |left| {
        search().run(&subset(points, left), &mut rng)
    })
}

fn compete(points: &Points, penalty: f64, seed: u64) -> Selection<Line> {
    let found = extract(points, Sequential::default().max_structures(12), seed);
    let mut candidates: Vec<Line> = found.structures.iter().map(|r| r.model).collect();
    let more = search().candidates(points, 40, &mut rng(seed));
    candidates.extend(more.expect("models").into_iter().map(|c| c.model));
    Competition::with_penalty(penalty).run(&search().min_inliers(20), points, candidates)
}

/// Which of the true lines this is, if any.
fn known(line: &Line) -> Option<usize> {
    truth().iter().position(|t| {
        (t.slope - line.slope).abs() < 0.01 && (t.intercept - line.intercept).abs() < 0.005
    })
}

fn all_five<'a>(models: impl Iterator<Item = &'a Line>) -> bool {
    let mut found: Vec<Option<usize>> = models.map(known).collect();
    found.sort_unstable();
    found == [0, 1, 2, 3, 4].map(Some)
}

#[test]
fn one_line_after_the_other_is_found() {
    for seed in 0..20 {
        let points = five_lines(seed);
        let found = extract(&points, Sequential::default().min_inliers(60), seed);
        assert!(
            all_five(found.structures.iter().map(|r| &r.model)),
            "{seed}"
        );
        assert!(matches!(found.ended, Ended::TooSmall { needed: 60, .. }));
        // Every datum is in one place.
        let taken = found.structures.iter().flat_map(|r| &r.inliers);
        let mut all: Vec<usize> = taken.chain(&found.rest).copied().collect();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..points.x.len()));
        for report in &found.structures {
            assert!(report.inliers.is_sorted());
            let near = |&i: &usize| (points.y[i] - report.model.at(points.x[i])).abs() <= THRESHOLD;
            assert!(report.inliers.iter().all(near));
        }
        assert_eq!(
            found,
            extract(&points, Sequential::default().min_inliers(60), seed)
        );
    }
}

#[test]
fn each_rule_ends_the_sequence() {
    let points = five_lines(1);
    let two = extract(&points, Sequential::default().max_structures(2), 1);
    assert_eq!((two.structures.len(), two.ended), (2, Ended::Enough));
    let none = extract(&points, Sequential::default().max_structures(0), 1);
    assert_eq!((none.structures.len(), none.rest.len()), (0, 1100));
    // 13 % of 1100 are 143.
    let shares = extract(&points, Sequential::default().min_share(0.13), 1);
    assert!(shares.structures.iter().all(|r| r.inliers.len() >= 143));
    assert!(matches!(shares.ended, Ended::TooSmall { needed: 143, .. }));
    let huge = extract(&points, Sequential::default().min_share(f64::INFINITY), 1);
    assert!(huge.structures.is_empty());

    let mut rng = rng(1);
    let wanted = |found: &[_], _: &_| found.len() < 3;
    let rule = Sequential::default();
    let left = |left: &[usize]| search().run(&subset(&points, left), &mut rng);
    let three = rule.run_while(1100, left, wanted);
    assert_eq!((three.structures.len(), three.ended), (3, Ended::Refused));

    // To the last datum.
    let all = extract(&points, Sequential::default(), 1);
    assert!(matches!(all.ended, Ended::NoModel(_)) && all.rest.len() < 20);
    let empty = extract(&Points::default(), Sequential::default(), 1);
    let error = RansacError::TooFewData {
        needed: 2,
        available: 0,
    };
    assert_eq!(empty.ended, Ended::NoModel(error));
}

#[test]
fn a_report_of_nothing_or_of_nonsense_ends_the_sequence() {
    let mut report = search().run(&five_lines(0), &mut rng(0)).unwrap();
    report.inliers = vec![7, 2, 2, 5000];
    let strange = Sequential::default().run(10, |_| Ok(report.clone()));
    // Data 2 and 7 are taken, then those that have moved to these places, until none is left there.
    assert_eq!(strange.structures[0].inliers, [2, 7]);
    assert_eq!(strange.rest, [0, 1]);
    report.inliers.clear();
    let nothing = Sequential::default()
        .min_inliers(0)
        .run(10, |_| Ok(report.clone()));
    let (inliers, needed) = (0, 1);
    assert_eq!(nothing.ended, Ended::TooSmall { inliers, needed });
}

#[test]
fn models_share_out_the_data_and_the_wrong_ones_go() {
    for seed in 0..20 {
        let points = five_lines(seed);
        let found = compete(&points, 40.0, seed);
        let models: Vec<Line> = found.instances.iter().map(|i| i.model).collect();
        assert!(all_five(models.iter()), "{seed} {models:?}");
        // Every datum is with the nearest model, if that is near enough.
        let off = |m: &Line, i: usize| (points.y[i] - m.at(points.x[i])).abs();
        for (k, instance) in found.instances.iter().enumerate() {
            for &i in &instance.data {
                let nearest = models.iter().map(|m| off(m, i)).fold(f64::MAX, f64::min);
                assert!(off(&models[k], i) <= nearest && nearest <= THRESHOLD);
            }
            assert!((instance.sigma.unwrap() / NOISE - 1.0).abs() < 0.25);
            assert_eq!(instance.covariance.as_ref().unwrap().size(), 2);
        }
        for &i in &found.rest {
            assert!(models.iter().all(|m| off(m, i) > THRESHOLD));
        }
        let gains: f64 = found.instances.iter().map(|i| i.score).sum();
        assert!((found.worth - (gains - 200.0)).abs() < 1e-6);
        assert_eq!(found, compete(&points, 40.0, seed));
    }
}

#[test]
fn the_competition_finds_the_best_of_all_sets() {
    let score = |points: &Points, lines: &[Line]| -> f64 {
        let gain = |i: usize| {
            let off = lines
                .iter()
                .map(|m| (points.y[i] - m.at(points.x[i])).abs());
            let u = off.fold(f64::INFINITY, f64::min) / THRESHOLD;
            if u <= 1.0 { 1.0 - u * u } else { 0.0 }
        };
        (0..points.x.len()).map(gain).sum()
    };
    let mut best_found = 0;
    for seed in 0..30 {
        let points = five_lines(seed);
        let mut draws = Draws::new(seed, 9);
        let mut candidates: Vec<Line> = truth().to_vec();
        // Copies that are a little off, and lines through two points of any kind.
        for k in 0..7 {
            let mut copy = truth()[k % 5];
            copy.intercept += 0.006 * (crate::lines::unit(&mut draws) - 0.5);
            copy.slope += 0.006 * (crate::lines::unit(&mut draws) - 0.5);
            candidates.push(copy);
        }
        for penalty in [0.5, 10.0, 60.0, 95.0, 1000.0] {
            let found = Competition::with_penalty(penalty).rounds(0).run(
                &search(),
                &points,
                candidates.clone(),
            );
            let models: Vec<Line> = found.instances.iter().map(|i| i.model).collect();
            let worth = score(&points, &models) - penalty * models.len() as f64;
            assert!((found.worth - worth).abs() < 1e-6);
            // All 4096 sets, of some scenes.
            if seed < 2 {
                let chosen = |set: u32| -> Vec<Line> {
                    let all = candidates.iter().enumerate();
                    all.filter(|(k, _)| set >> k & 1 == 1)
                        .map(|(_, line)| *line)
                        .collect()
                };
                let best = (0..1_u32 << candidates.len())
                    .map(chosen)
                    .map(|lines| score(&points, &lines) - penalty * lines.len() as f64)
                    .fold(f64::NEG_INFINITY, f64::max);
                assert!(found.worth <= best + 1e-6);
                best_found += u32::from(found.worth >= best - 1e-6);
            }
        }
    }
    assert!(best_found >= 9, "{best_found} of 10");
}

#[test]
fn refits_raise_the_worth_and_the_order_of_candidates_does_not_matter() {
    for seed in 0..10 {
        let points = five_lines(seed);
        let mut draws = Draws::new(seed, 5);
        let mut rough: Vec<Line> = truth().to_vec();
        for line in &mut rough {
            line.intercept += 0.01 * (crate::lines::unit(&mut draws) - 0.5);
        }
        let run = |lines: &[Line], rounds: usize| {
            let rule = Competition::with_penalty(30.0).rounds(rounds);
            rule.run(&search(), &points, lines.iter().copied())
        };
        let before = run(&rough, 0);
        let after = run(&rough, 20);
        assert!(after.worth > before.worth && after.rounds > 0);
        assert!(all_five(after.instances.iter().map(|i| &i.model)));
        let turned: Vec<Line> = rough.iter().rev().copied().collect();
        let other = run(&turned, 20);
        assert!((other.worth - after.worth).abs() < 1e-6);
    }
}

/// Refuses lines that rise.
struct Falling;

impl Constraint<Points> for Falling {
    fn name(&self) -> &'static str {
        "falling"
    }
    fn allows_model(&self, _: &Points, line: &Line) -> bool {
        line.slope <= -0.001
    }
}

#[test]
fn constraints_hold_for_candidates_and_refits() {
    for seed in 0..10 {
        let points = five_lines(seed);
        let search = search().constraint(Falling);
        let mut candidates = truth().to_vec();
        // The level line, tilted so that its refit rises again half of the time.
        candidates[0].slope = -0.001;
        let found = Competition::with_penalty(30.0).run(&search, &points, candidates);
        assert_eq!(found.instances.len(), 3);
        assert!(found.instances.iter().all(|i| i.model.slope <= -0.001));
    }
}

#[test]
fn nothing_comes_of_nothing() {
    let points = five_lines(0);
    let run = |penalty, points: &Points, lines: Vec<Line>| {
        Competition::with_penalty(penalty).run(&search(), points, lines)
    };
    let none = run(10.0, &points, vec![]);
    assert!(none.instances.is_empty() && none.worth == 0.0 && none.rest.len() == 1100);
    let none = run(10.0, &Points::default(), truth().to_vec());
    assert!(none.instances.is_empty() && none.rest.is_empty());
    let nan = Line {
        slope: f64::NAN,
        intercept: 0.0,
    };
    assert!(run(10.0, &points, vec![nan; 3]).instances.is_empty());
    assert!(
        run(f64::INFINITY, &points, truth().to_vec())
            .instances
            .is_empty()
    );
    for penalty in [f64::NAN, -5.0, 0.0] {
        assert_eq!(run(penalty, &points, truth().to_vec()).instances.len(), 5);
    }
    // A copy of a model is worth nothing, even where models cost nothing.
    let copies =
        Competition::with_penalty(0.0)
            .rounds(0)
            .run(&search(), &points, vec![truth()[0]; 4]);
    assert_eq!(copies.instances.len(), 1);
    let few = search().min_inliers(100_000);
    let none = Competition::with_penalty(0.0).run(&few, &points, truth());
    assert!(none.instances.is_empty() && none.worth == 0.0);

    let empty = search().candidates(&Points::default(), 5, &mut rng(0));
    assert!(matches!(empty, Err(RansacError::TooFewData { .. })));
    for count in [0, 1, 3] {
        let some = search().candidates(&points, count, &mut rng(0)).unwrap();
        assert_eq!(some.len(), count.max(1));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_points_are_shared_out(
        xy in prop::collection::vec((
            prop_oneof![-1.0..1.0f64, Just(0.0), Just(f64::NAN), Just(f64::INFINITY), Just(1e300)],
            prop_oneof![-1.0..1.0f64, Just(0.0), Just(f64::NAN), Just(f64::NEG_INFINITY)],
        ), 0..40),
        threshold in prop_oneof![0.0..0.5f64, Just(0.0), Just(f64::NAN), Just(-1.0), Just(f64::INFINITY)],
        penalty in prop_oneof![0.0..5.0f64, Just(f64::NAN)],
        seed in any::<u64>(),
    ) {
        let (x, y): (Vec<f64>, Vec<f64>) = xy.into_iter().unzip();
        let points = Points { x, y };
        let search = Ransac::new(InlierCount::within(threshold))
            .local_optimization(LeastSquares::default())
            .stopping(FixedCount::new(20));
        let mut rng = rng(seed);
        let found = Sequential::default().run(points.x.len(), |left| {
            search.run(&subset(&points, left), &mut rng)
        });
        let taken: usize = found.structures.iter().map(|r| r.inliers.len()).sum();
        prop_assert_eq!(taken + found.rest.len(), points.x.len());
        let candidates = found.structures.into_iter().map(|r| r.model);
        let shared = Competition::with_penalty(penalty).run(&search, &points, candidates);
        let taken: usize = shared.instances.iter().map(|i| i.data.len()).sum();
        prop_assert_eq!(taken + shared.rest.len(), points.x.len());
        prop_assert!(shared.worth >= 0.0);
    }
}
