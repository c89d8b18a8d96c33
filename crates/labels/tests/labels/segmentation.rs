//! Masks of wood against strokes: every figure on images whose answer is known, and what it must not depend on.

mod definition;
mod masks;
mod orchard;
mod photographs;
mod refused;

use orchard::{
    BRANCH, ByColor, Channel, Mark, OPTIONS, Orchard, TWIG, WIDTH, WIRE, blue, by_width, green, is,
    of_value, red, says, source,
};
use pomona_labels::segmentation_page;
use std::ops::Range;

#[test]
fn every_figure_is_the_one_by_hand() {
    let marks = [
        red(20, 0..60),
        // Near the branch's band, and 4 px from its centre line.
        red(24, 70..100),
        red(60, 0..20),
        red(40, 0..20),
        red(72, 0..30),
    ];
    let evaluation = Orchard::with(&format!("{BRANCH}{TWIG}{WIRE}"), &marks).red();
    let strokes = &evaluation.strokes;
    assert_eq!(
        (strokes.images, strokes.photographs, strokes.wood),
        (1, 1, 2)
    );
    assert!((strokes.wood_length_px - 200.0).abs() < 1e-9);
    assert!((strokes.post_length_px - 100.0).abs() < 1e-9);

    let result = &evaluation.results[0];
    // The last marks are in the columns 59 and 19, and a point of a centre line is in the middle of each column.
    is(result.recall_wide, 0.63);
    is(result.recall_thin, 0.23);
    is(result.precision, 110.0 / 160.0);
    // 60 and 20 marked pixels lie in the bands of 500 and 300.
    is(result.iou, 80.0 / (160.0 + 800.0 - 80.0));
    is(result.posts, 0.3);
    assert_eq!(
        by_width(&result.by_width),
        [
            (0.0, 0.0),
            (100.0, 0.23),
            (100.0, 0.63),
            (0.0, 0.0),
            (0.0, 0.0)
        ]
    );
    let worst = &result.worst[0];
    assert!((worst.missed_px - (37.0 + 77.0)).abs() < 1e-9);
    assert_eq!((&*worst.image, worst.false_pixels), ("a.png", 50));
    assert_eq!(result.segmenter.as_ref().unwrap().name, "red");
}

#[test]
fn a_perfect_mask_has_one_everywhere_and_a_blind_segmenter_misses_all() {
    let bands = (18..=22).chain(59..=61).map(|v| green(v, 0..100));
    let bands: Vec<Mark> = bands.collect();
    let orchard = Orchard::with(&format!("{BRANCH}{TWIG}{WIRE}"), &bands);
    let evaluation = orchard.channels(&[Channel::Green, Channel::Red], OPTIONS);
    let [perfect, blind] = [0, 1].map(|i| &evaluation.results[i]);
    for figure in [
        perfect.recall_wide,
        perfect.recall_thin,
        perfect.precision,
        perfect.iou,
    ] {
        is(figure, 1.0);
    }
    is(perfect.posts, 0.0);
    assert_eq!(perfect.calibration_error, 0.0);
    assert!(perfect.worst.is_empty());

    is(blind.recall_wide, 0.0);
    is(blind.iou, 0.0);
    assert!(blind.precision.is_none(), "nothing is marked");
    assert_eq!(blind.curve[0].precision, 1.0);
    assert!((blind.worst[0].missed_px - 200.0).abs() < 1e-9);
    assert!(
        evaluation.differences.is_empty(),
        "one of them has no precision"
    );
}

#[test]
fn an_image_that_somebody_looked_at_in_vain_counts_for_precision_only() {
    let result = &Orchard::with("", &[red(5, 0..10)]).red().results[0];
    assert!(result.recall_wide.is_none() && result.recall_thin.is_none());
    assert!(result.posts.is_none());
    is(result.precision, 0.0);
    is(result.iou, 0.0);
    assert_eq!(result.worst[0].false_pixels, 10);
}

#[test]
fn wood_is_found_within_the_tolerance_and_no_further() {
    for (row, recall, precise) in [
        (23, 1.0, 1.0),
        (24, 0.0, 1.0),
        (25, 0.0, 1.0),
        (26, 0.0, 0.0),
    ] {
        for row in [row, 40 - row] {
            let result = &Orchard::with(BRANCH, &[red(row, 0..100)]).red().results[0];
            is(result.recall_wide, recall);
            is(result.precision, precise);
        }
    }
}

#[test]
fn without_a_tolerance_the_pixels_of_the_line_itself_count() {
    let mut options = OPTIONS;
    options.tolerance_px = 0.0;
    let strokes = "wood 0,20.2,2 100,20.2,2";
    for (row, recall) in [(19, 0.0), (20, 0.4), (21, 0.0)] {
        let orchard = Orchard::with(strokes, &[red(row, 0..40)]);
        let result = &orchard.channels(&[Channel::Red], options).results[0];
        is(result.recall_wide, recall);
        is(result.precision, 1.0);
    }
}

#[test]
fn a_branch_that_thickens_counts_piece_by_piece() {
    // 2 px wide at the left, 6 px at the right.
    let strokes = "wood 0,20.5,1 100,20.5,3";
    let result = &Orchard::with(strokes, &[red(20, 30..100)]).red().results[0];
    // Marked from the column 30 on, found from the column 27 on.
    is(result.recall_thin, 23.0 / 25.0);
    is(result.recall_wide, 1.0);
    assert_eq!(
        by_width(&result.by_width)[..3],
        [(25.0, 0.0), (25.0, 0.92), (50.0, 1.0)]
    );
    let thick = "wood 0,20.5,4 100,20.5,12";
    let result = &Orchard::with(thick, &[red(20, 0..50)]).red().results[0];
    assert_eq!(
        by_width(&result.by_width)[3..],
        [(50.0, 1.0), (50.0, 3.0 / 50.0)]
    );
}

#[test]
fn only_the_part_of_a_stroke_inside_the_image_counts() {
    let strokes = "wood -60,20.5,2 50,20.5,2";
    let result = &Orchard::with(strokes, &[red(20, 0..22)]).red().results[0];
    assert_eq!(by_width(&result.by_width)[2], (50.0, 0.5));
    is(result.recall_wide, 0.5);
    let across = "wood -50,20.5,2 150,20.5,2";
    let result = &Orchard::with(across, &[red(20, 0..22)]).red().results[0];
    assert_eq!(by_width(&result.by_width)[2], (100.0, 0.25));
}

#[test]
fn far_wood_need_not_be_found_and_is_not_wrong() {
    let marks = [red(20, 0..100), red(40, 0..100), red(70, 0..100)];
    let far = "far 0,40.5,1 100,40.5,1\n";
    let without = &Orchard::with(BRANCH, &marks).red().results[0];
    is(without.precision, 1.0 / 3.0);
    let with = &Orchard::with(&format!("{BRANCH}{far}"), &marks)
        .red()
        .results[0];
    is(with.precision, 0.5);
    is(with.iou, 100.0 / 600.0);
    is(with.recall_wide, 1.0);
    assert_eq!(by_width(&with.by_width)[1], (0.0, 0.0));
    assert_eq!(with.worst[0].false_pixels, 100);
    // Whoever leaves it out is worth the same.
    let left_out = [red(20, 0..100), red(70, 0..100)];
    let left_out = &Orchard::with(&format!("{BRANCH}{far}"), &left_out).red();
    assert_eq!(left_out.results[0].precision, with.precision);
    assert_eq!(left_out.results[0].iou, with.iou);
}

#[test]
fn far_wood_behind_a_branch_takes_nothing_from_it() {
    let marks = [red(20, 0..50), red(27, 0..50), red(40, 0..10)];
    let far = "far 0,20.5,6 100,20.5,6\n";
    let result = &Orchard::with(&format!("{BRANCH}{far}"), &marks)
        .red()
        .results[0];
    // The row 27 lies near far wood only, the row 40 near nothing.
    is(result.precision, 50.0 / 60.0);
    is(result.iou, 50.0 / (60.0 + 500.0 - 50.0));
    is(result.recall_wide, 0.53);
}

#[test]
fn about_apples_only_what_is_within_their_radii_counts() {
    let marks = [red(20, 0..60), red(45, 0..100), red(70, 0..100)];
    let orchard = Orchard::with(BRANCH, &marks);
    let mut near_apples = OPTIONS;
    near_apples.apple_radii = Some(2.0);
    let segmenter = ByColor::new(Channel::Red);
    let refused = orchard.measured(&[source(&segmenter)], near_apples);
    says(
        &refused.unwrap_err(),
        &["a.png", "boxes.xml", "whole images"],
    );

    // An apple of 20 px about (50, 20.5): of the row 20, the columns 30 to 69 are within 20 px.
    let boxes = orchard.dir.path().join("boxes.txt");
    std::fs::write(&boxes, "0 0.5 0.25625 0.2 0.25\n").unwrap();
    let result = &orchard.channels(&[Channel::Red], near_apples).results[0];
    assert_eq!(by_width(&result.by_width)[2], (40.0, 33.0 / 40.0));
    is(result.recall_wide, 33.0 / 40.0);
    is(result.precision, 1.0);
    assert_eq!(result.worst[0].false_pixels, 0);

    // Nothing is drawn where there is no apple.
    std::fs::write(&boxes, "").unwrap();
    let result = &orchard.channels(&[Channel::Red], near_apples).results[0];
    assert!(result.recall_wide.is_none() && result.precision.is_none());
}

#[test]
fn a_pixel_is_marked_from_the_threshold_on() {
    // 102 of 255 is 0.4, 204 is 0.8.
    let marks = [
        of_value(red(20, 0..50), 204),
        of_value(red(20, 50..100), 102),
    ];
    let orchard = Orchard::with(BRANCH, &marks);
    for (threshold, counts_as, recall) in [
        (0.0, 0.01, 1.0),
        (0.4, 0.4, 1.0),
        (0.404, 0.4, 1.0),
        (0.41, 0.41, 0.53),
        (0.8, 0.8, 0.53),
        (0.81, 0.81, 0.0),
    ] {
        let mut options = OPTIONS;
        options.threshold = threshold;
        let evaluation = orchard.channels(&[Channel::Red], options);
        assert!((evaluation.threshold - counts_as).abs() < 1e-12);
        let result = &evaluation.results[0];
        is(result.recall_wide, recall);
        let mut on_curve = result.curve.iter();
        let level = on_curve.find(|l| (l.threshold - counts_as).abs() < 1e-9);
        let level = level.unwrap();
        assert!((level.recall_wide - recall).abs() < 1e-12, "{level:?}");
    }
}

#[test]
fn over_the_thresholds_less_and_less_is_found() {
    let marks: Vec<Mark> = (0..WIDTH)
        .map(|u| of_value(red(20 + u % 7, u..u + 1), (2 * u) as u8))
        .collect();
    let result = &Orchard::with(&format!("{BRANCH}{TWIG}"), &marks)
        .red()
        .results[0];
    assert_eq!(result.curve.len(), 99);
    for pair in result.curve.windows(2) {
        assert!(pair[0].threshold < pair[1].threshold);
        assert!(pair[0].recall_wide >= pair[1].recall_wide, "{pair:?}");
    }
}

#[test]
fn what_nobody_looked_at_is_not_marked() {
    let marks = [red(20, 0..100), blue(20, 50..100)];
    let result = &Orchard::with(BRANCH, &marks).red().results[0];
    is(result.recall_wide, 0.53);
    is(result.iou, 50.0 / 500.0);
    let looked_at: u64 = result.calibration.iter().map(|bin| bin.pixels).sum();
    // Of 80 rows, 6 are along the branch's edges.
    assert_eq!(looked_at, 74 * 100 - 50);
}

/// A trunk of 20 px along the row 40: for sure are wood the rows 32 to 48, the rest are rows 0 to 28 and 52 to 79.
const TRUNK: &str = "wood 0,40.5,10 100,40.5,10\n";

fn rows(rows: Range<usize>, value: u8) -> impl Iterator<Item = Mark> {
    rows.map(move |v| of_value(red(v, 0..100), value))
}

#[test]
fn calibration_compares_probabilities_with_shares_away_from_the_edges() {
    let marks: Vec<Mark> = rows(0..80, 38).chain(rows(30..51, 216)).collect();
    let result = &Orchard::with(TRUNK, &marks).red().results[0];
    let [unlikely, likely] = [1, 8].map(|bin| result.calibration[bin]);
    assert_eq!((unlikely.pixels, unlikely.share), (5700, 0.0));
    assert_eq!((likely.pixels, likely.share), (1700, 1.0));
    let [low, high] = [38.0 / 255.0, 216.0 / 255.0];
    assert!((unlikely.probability - low).abs() < 1e-6);
    assert!((likely.probability - high).abs() < 1e-6);
    let expected = (5700.0 * low + 1700.0 * (1.0 - high)) / 7400.0;
    assert!((result.calibration_error - expected).abs() < 1e-6);

    // The same probability everywhere, and that is the share of wood but for rounding.
    let evenly: Vec<Mark> = rows(0..80, 59).collect();
    let result = &Orchard::with(TRUNK, &evenly).red().results[0];
    let bin = result.calibration[2];
    assert_eq!(bin.pixels, 7400);
    assert!((bin.share - 1700.0 / 7400.0).abs() < 1e-12);
    let expected = (59.0 / 255.0 - 1700.0 / 7400.0_f64).abs();
    assert!((result.calibration_error - expected).abs() < 1e-6);
}

#[test]
fn empty_bins_of_the_calibration_lie_in_their_middle() {
    let result = &Orchard::with(TRUNK, &[]).red().results[0];
    assert_eq!(result.calibration.len(), 10);
    let empty = result.calibration[4];
    assert_eq!((empty.pixels, empty.share), (0, 0.0));
    assert!((empty.probability - 0.45).abs() < 1e-12);
}

#[test]
fn the_worst_images_come_first_and_flawless_ones_not_at_all() {
    let mut orchard = Orchard::new();
    orchard.add("flawless.png", BRANCH, &[red(20, 0..100)]);
    orchard.add("half.png", BRANCH, &[red(20, 0..47)]);
    orchard.add("blind.png", BRANCH, &[]);
    orchard.add("dreaming.png", "", &[red(5, 0..100), red(6, 0..20)]);
    let evaluation = orchard.red();
    let result = &evaluation.results[0];
    let worst: Vec<_> = result
        .worst
        .iter()
        .map(|w| (&*w.image, w.missed_px.round(), w.false_pixels))
        .collect();
    assert_eq!(
        worst,
        [
            ("blind.png", 100.0, 0),
            ("half.png", 50.0, 0),
            ("dreaming.png", 0.0, 120)
        ]
    );
    let page = segmentation_page(&evaluation, &["worst-1.png".to_owned()]).unwrap();
    for word in ["worst-1.png", "dreaming.png", "orchard", "<svg"] {
        assert!(page.contains(word), "no {word} in the page");
    }
    assert!(!page.contains("flawless.png"));
}
