//! Detections against labels: what the figures are on sets whose answer is known, and what they must not depend on.

use pomona_cloud::{ColorImage, LabelKind, LabelledBox, PixelBox};
use pomona_detect::{DetectError, Detection, Detector, DetectorReport};
use pomona_labels::{
    Curve, DetectionEvaluation, DetectionOptions, DetectionSource, LabelForm, LabelledDataset,
    LabelledImage, MatchedImage, evaluate_detections,
};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

fn label(x: f64, y: f64, side: f64) -> LabelledBox {
    LabelledBox::new(PixelBox {
        name: "apple".to_owned(),
        x_min: x,
        y_min: y,
        x_max: x + side,
        y_max: y + side,
        score: 1.0,
    })
}

fn seen(x: f64, y: f64, side: f64, score: f64) -> Detection {
    Detection {
        x_min: x,
        y_min: y,
        x_max: x + side,
        y_max: y + side,
        score,
        class: 0,
    }
}

fn unit(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.next_u32()) / f64::from(u32::MAX)
}

/// Images with labels in a grid, a detector that shifts some, misses some and invents some.
fn orchard(seed: u64, images: usize, recall: f64) -> (LabelledDataset, Vec<Vec<Detection>>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut labelled, mut detections) = (Vec::new(), Vec::new());
    for number in 0..images {
        let (mut labels, mut found) = (Vec::new(), Vec::new());
        for cell in 0..9 {
            let (x, y) = (f64::from(cell % 3) * 130.0, f64::from(cell / 3) * 130.0);
            let side = 10.0 + 90.0 * unit(&mut rng);
            if unit(&mut rng) < 0.7 {
                labels.push(label(x, y, side));
                if unit(&mut rng) < recall {
                    let shift = 0.4 * side * unit(&mut rng);
                    found.push(seen(x + shift, y, side, 0.3 + 0.7 * unit(&mut rng)));
                }
            } else if unit(&mut rng) < 0.5 {
                found.push(seen(x, y, side, 0.8 * unit(&mut rng)));
            }
        }
        let name = format!("{number:03}.png");
        let mut image = LabelledImage::new(name.clone(), name, 400, 400);
        image.boxes = labels;
        labelled.push(image);
        detections.push(found);
    }
    let dataset = LabelledDataset::new("orchard", LabelForm::LabelFolder, labelled);
    (dataset, detections)
}

fn outcomes(dataset: &LabelledDataset, detections: &[Vec<Detection>]) -> Vec<MatchedImage> {
    let pairs = dataset.images.iter().zip(detections);
    pairs
        .map(|(image, found)| MatchedImage::new(&image.boxes, found.clone()))
        .collect()
}

const OPTIONS: DetectionOptions = DetectionOptions::new(0.5, 7);

fn evaluated(
    dataset: &LabelledDataset,
    named: &[(&str, &[Vec<Detection>])],
) -> DetectionEvaluation {
    let sources: Vec<DetectionSource<'_>> = named
        .iter()
        .map(|(name, detections)| DetectionSource::Boxes {
            name: (*name).to_owned(),
            detections: detections.to_vec(),
        })
        .collect();
    evaluate_detections(dataset, &sources, &OPTIONS, &|| {})
        .unwrap()
        .0
}

#[test]
fn a_perfect_detector_has_one_everywhere_and_a_blind_one_nothing() {
    let (dataset, _) = orchard(1, 6, 1.0);
    let exact = |label: &LabelledBox| {
        let b = &label.bounds;
        seen(b.x_min, b.y_min, b.width(), 0.9)
    };
    let perfect: Vec<Vec<Detection>> = dataset
        .images
        .iter()
        .map(|image| image.boxes.iter().map(exact).collect())
        .collect();
    let blind = vec![Vec::new(); 6];
    let evaluation = evaluated(&dataset, &[("perfect", &perfect), ("blind", &blind)]);
    let best = &evaluation.results[0];
    for figure in [
        &best.ap50,
        &best.ap50_95,
        &best.f1,
        &best.recall,
        &best.precision,
    ] {
        let figure = figure.unwrap();
        assert!((figure.value - 1.0).abs() < 1e-12 && (figure.low - 1.0).abs() < 1e-12);
    }
    let curve = best.curve.as_ref().unwrap();
    assert!((curve.ap50_95_101 - 1.0).abs() < 1e-12);
    assert_eq!(best.at_threshold.mean_iou, Some(1.0));
    assert_eq!(
        (best.at_threshold.missed, best.at_threshold.false_positives),
        (0, 0)
    );
    assert!(best.worst.is_empty());

    let none = &evaluation.results[1];
    assert_eq!(none.ap50.unwrap().value, 0.0);
    assert_eq!(none.at_threshold.missed, evaluation.dataset.labels);
    assert_eq!(none.curve.as_ref().unwrap().best_f1, None);
    assert_eq!(evaluation.differences[0].ap50.high, -1.0);
}

#[test]
fn counts_at_the_threshold_are_those_by_hand() {
    let labels = vec![
        label(0.0, 0.0, 20.0),
        label(100.0, 0.0, 40.0),
        label(200.0, 0.0, 100.0),
    ];
    let mut dataset = orchard(1, 1, 1.0).0;
    dataset.images[0].boxes = labels;
    let mut ignored = label(300.0, 0.0, 30.0);
    ignored.kind = LabelKind::Difficult;
    dataset.images[0].boxes.push(ignored);
    let found = vec![vec![
        seen(0.0, 0.0, 20.0, 0.9),
        // Found, but under the threshold.
        seen(100.0, 0.0, 40.0, 0.4),
        // Half of the large one: an overlap of exactly 0.5 is one.
        Detection {
            y_max: 50.0,
            ..seen(200.0, 0.0, 100.0, 0.8)
        },
        seen(300.0, 0.0, 30.0, 0.7),
        seen(0.0, 200.0, 30.0, 0.6),
        seen(50.0, 200.0, 30.0, 0.1),
    ]];
    let evaluation = evaluated(&dataset, &[("a", &found)]);
    assert_eq!(
        (evaluation.dataset.labels, evaluation.dataset.ignored_labels),
        (3, 1)
    );
    let result = &evaluation.results[0];
    let at = result.at_threshold;
    assert_eq!((at.found, at.missed, at.false_positives), (2, 1, 1));
    assert_eq!(at.false_positives_per_image, 1.0);
    assert_eq!(at.mean_iou, Some(0.75));
    assert!((result.recall.unwrap().value - 2.0 / 3.0).abs() < 1e-12);
    assert!((result.precision.unwrap().value - 2.0 / 3.0).abs() < 1e-12);
    let sizes: Vec<_> = result
        .by_size
        .iter()
        .map(|s| {
            (
                s.size.name,
                s.at_threshold.count,
                s.at_any_score.count,
                s.at_any_score.of,
            )
        })
        .collect();
    assert_eq!(
        sizes,
        [("small", 1, 1, 1), ("medium", 0, 1, 1), ("large", 1, 1, 1)]
    );
    let worst = &result.worst[0];
    assert_eq!(
        (worst.found, worst.missed, worst.false_positives),
        (2, 1, 1)
    );
}

#[test]
fn a_set_without_labels_has_counts_and_no_recall() {
    let (mut dataset, found) = orchard(3, 4, 1.0);
    for image in &mut dataset.images {
        image.boxes.clear();
    }
    let evaluation = evaluated(&dataset, &[("a", &found)]);
    let result = &evaluation.results[0];
    assert!(result.ap50.is_none() && result.curve.is_none() && evaluation.differences.is_empty());
    assert_eq!(evaluation.dataset.background_images, 4);
    assert!(result.at_threshold.false_positives > 0);
}

#[test]
fn intervals_hold_the_figure_and_pairs_are_narrower_than_the_two_apart() {
    let (dataset, good) = orchard(5, 40, 0.9);
    // The same detections with every third one gone: much in common.
    let worse: Vec<Vec<Detection>> = good
        .iter()
        .map(|image| {
            let kept = image.iter().enumerate().filter(|(i, _)| i % 3 != 0);
            kept.map(|(_, d)| *d).collect()
        })
        .collect();
    let evaluation = evaluated(&dataset, &[("good", &good), ("worse", &worse)]);
    let [a, b] = [0, 1].map(|i| evaluation.results[i].ap50.unwrap());
    assert!(a.low < a.value && a.value < a.high);
    let difference = evaluation.differences[0].ap50;
    assert!((difference.value - (b.value - a.value)).abs() < 1e-12);
    assert!(difference.high < 0.0, "{difference:?}");
    let apart = (a.high - a.low).hypot(b.high - b.low);
    assert!(difference.high - difference.low < apart);
}

#[test]
fn the_interval_covers_the_truth_about_as_often_as_it_says() {
    // A detector that finds each label exactly, with a probability of 0.8.
    let covered = (0..60)
        .filter(|&seed| {
            let (dataset, _) = orchard(1000 + seed, 20, 1.0);
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut find = |label: &LabelledBox| {
                let b = &label.bounds;
                (unit(&mut rng) < 0.8).then(|| seen(b.x_min, b.y_min, b.width(), 0.9))
            };
            let found: Vec<Vec<Detection>> = dataset
                .images
                .iter()
                .map(|image| image.boxes.iter().filter_map(&mut find).collect())
                .collect();
            let result = &evaluated(&dataset, &[("a", &found)]).results[0];
            let recall = result.recall.unwrap();
            recall.low <= 0.8 && 0.8 <= recall.high
        })
        .count();
    // Of 60 intervals that each hold the truth with a probability of 0.95, at most 50 do once in a thousand times.
    assert!(covered > 50, "{covered} of 60");
}

#[test]
fn the_outcome_does_not_depend_on_the_number_of_threads() {
    let (dataset, found) = orchard(8, 20, 0.8);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| evaluated(&dataset, &[("a", &found)]))
    };
    assert_eq!(with(1), with(4));
}

/// Sees one box in the middle of every image.
struct Middle;

impl Detector for Middle {
    fn detect(&self, image: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        if image.width == 1 {
            return Err(DetectError::Other {
                detector: "middle".to_owned(),
                source: "too small".into(),
            });
        }
        let (x, y) = (image.width as f64 / 4.0, image.height as f64 / 4.0);
        Ok(vec![seen(x, y, image.width as f64 / 2.0, 0.9)])
    }

    fn report(&self) -> DetectorReport {
        DetectorReport::new("middle")
    }
}

#[test]
fn a_detector_of_ones_own_is_run_on_every_image_and_its_failure_names_the_image() {
    let dir = tempfile::tempdir().unwrap();
    let place = |name: &str| dir.path().join(name);
    std::fs::create_dir_all(place("images")).unwrap();
    std::fs::create_dir_all(place("labels")).unwrap();
    for name in ["a", "b"] {
        let image = ColorImage::filled(40, 40, [9; 3]);
        image.write(place(&format!("images/{name}.png"))).unwrap();
    }
    std::fs::write(place("labels/a.txt"), "0 0.5 0.5 0.5 0.5\n").unwrap();
    let run = |dataset: &LabelledDataset| {
        let source = DetectionSource::Detector {
            name: "own".to_owned(),
            detector: &Middle,
        };
        evaluate_detections(dataset, &[source], &OPTIONS, &|| {})
    };
    let dataset = LabelledDataset::read(dir.path(), None).unwrap();
    let (evaluation, outcomes) = run(&dataset).unwrap();
    let result = &evaluation.results[0];
    assert_eq!(result.detector.as_ref().unwrap().name, "middle");
    assert_eq!(
        (
            result.at_threshold.found,
            result.at_threshold.false_positives
        ),
        (1, 1)
    );
    assert_eq!(evaluation.dataset.images_without_label_file, 1);
    assert_eq!(outcomes[0][1].false_positives(0.5).len(), 1);

    ColorImage::filled(1, 5, [0; 3])
        .write(place("images/c.png"))
        .unwrap();
    let dataset = LabelledDataset::read(dir.path(), None).unwrap();
    let message = run(&dataset).unwrap_err().to_string();
    assert!(
        message.contains("c.png") && message.contains("too small"),
        "{message}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_order_of_images_decides_nothing(seed in 0..1000_u64, shift in 0..12_usize) {
        let (mut dataset, mut found) = orchard(seed, 12, 0.8);
        // Coarse scores, so that many are equal.
        for d in found.iter_mut().flatten() {
            d.score = (d.score * 5.0).round() / 5.0;
        }
        let before = Curve::of(&outcomes(&dataset, &found));
        dataset.images.rotate_left(shift);
        found.rotate_left(shift);
        dataset.images.swap(0, 7);
        found.swap(0, 7);
        prop_assert_eq!(before, Curve::of(&outcomes(&dataset, &found)));
    }

    #[test]
    fn a_monotone_map_of_the_scores_leaves_the_areas_as_they_are(seed in 0..1000_u64, power in 0.2..5.0_f64) {
        let (dataset, mut found) = orchard(seed, 10, 0.8);
        let before = Curve::of(&outcomes(&dataset, &found)).unwrap();
        for d in found.iter_mut().flatten() {
            d.score = d.score.powf(power);
        }
        let after = Curve::of(&outcomes(&dataset, &found)).unwrap();
        prop_assert_eq!(
            (before.ap50, before.ap50_101, before.ap50_95, before.ap50_95_101),
            (after.ap50, after.ap50_101, after.ap50_95, after.ap50_95_101)
        );
        prop_assert_eq!(before.best_f1.map(|b| b.f1), after.best_f1.map(|b| b.f1));
    }

    #[test]
    fn moving_and_scaling_everything_changes_nothing(seed in 0..1000_u64, scale in 1..5_u8, shift in -50..50_i8) {
        let (mut dataset, mut found) = orchard(seed, 6, 0.8);
        let before = Curve::of(&outcomes(&dataset, &found)).unwrap().ap50;
        // Powers of two and whole numbers keep the edges exact enough for overlaps that are not at a limit.
        let to = |v: &mut f64| *v = *v * f64::from(1_u32 << scale) + f64::from(shift);
        for b in dataset.images.iter_mut().flat_map(|i| &mut i.boxes).map(|l| &mut l.bounds) {
            for edge in [&mut b.x_min, &mut b.y_min, &mut b.x_max, &mut b.y_max] {
                to(edge);
            }
        }
        for d in found.iter_mut().flatten() {
            for edge in [&mut d.x_min, &mut d.y_min, &mut d.x_max, &mut d.y_max] {
                to(edge);
            }
        }
        prop_assert_eq!(before, Curve::of(&outcomes(&dataset, &found)).unwrap().ap50);
    }

    #[test]
    fn a_false_positive_below_all_others_leaves_ap_and_a_true_positive_raises_it(seed in 0..1000_u64) {
        let (dataset, mut found) = orchard(seed, 6, 0.6);
        let before = Curve::of(&outcomes(&dataset, &found)).unwrap().ap50;
        found[0].push(seen(1000.0, 1000.0, 10.0, 0.0001));
        let with_more = Curve::of(&outcomes(&dataset, &found)).unwrap().ap50;
        prop_assert_eq!(before, with_more);
        let missed = outcomes(&dataset, &found).iter().map(|o| o.missed(0.0)).collect::<Vec<_>>();
        if let Some((at, missed)) = missed.iter().enumerate().find_map(|(i, m)| Some((i, m.first()?))) {
            let [x, y, x_max, _] = missed.edges;
            found[at].push(seen(x, y, x_max - x, 1.0));
            prop_assert!(Curve::of(&outcomes(&dataset, &found)).unwrap().ap50 > before);
        }
    }
}
