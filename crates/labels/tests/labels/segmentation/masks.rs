//! Masks as truth in place of strokes.

use super::orchard::{
    BRANCH, ByColor, Channel, HEIGHT, Mark, OPTIONS, Orchard, WIDTH, by_width, is, painted, red,
    says, source,
};
use pomona_cloud::GrayImage;
use pomona_labels::{
    LabelsError, PixelVerdict, SegmentationEvaluation, SegmentationImage, TruthKind,
    evaluate_segmentation, judge_pixels, masked_images,
};
use std::path::Path;
use tempfile::TempDir;

const CLASSES: (&str, u8) = ("classes.png", 1);

/// Writes a mask with a value in some rows, each from one to before another.
fn mask(path: &Path, rows: &[[usize; 2]], value: u8) {
    let mut values = vec![0; WIDTH * HEIGHT];
    for [start, end] in rows {
        values[start * WIDTH..end * WIDTH].fill(value);
    }
    let mask = GrayImage {
        width: WIDTH,
        height: HEIGHT,
        values,
    };
    mask.write(path).unwrap();
}

/// One image with these marks and a mask with wood in these rows.
fn bench(rows: &[[usize; 2]], marks: &[Mark]) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    std::fs::create_dir(dir.path().join("masks")).unwrap();
    let image = painted([WIDTH, HEIGHT], marks);
    image.write(dir.path().join("a.png")).unwrap();
    mask(&dir.path().join("masks/a.png"), rows, 255);
    dir
}

fn images(dir: &TempDir) -> Result<Vec<SegmentationImage>, LabelsError> {
    masked_images(dir.path(), &dir.path().join("masks"), CLASSES)
}

/// What the red channel is worth.
fn measured(dir: &TempDir) -> Result<SegmentationEvaluation, LabelsError> {
    let segmenter = ByColor::new(Channel::Red);
    evaluate_segmentation(
        "masks",
        &images(dir)?,
        &[],
        &[source(&segmenter)],
        &OPTIONS,
        &|| {},
    )
}

#[test]
fn the_figures_are_those_of_the_same_strokes() {
    let marks = [
        red(20, 0..60),
        red(24, 70..100),
        red(60, 0..20),
        red(40, 0..20),
    ];
    // The bands of a stroke 5 px wide and of one of 3 px.
    let of_masks = measured(&bench(&[[18, 23], [59, 62]], &marks)).unwrap();
    let strokes = "wood 0,20.5,2.5 100,20.5,2.5\nwood 0,60.5,1.5 100,60.5,1.5\n";
    let of_strokes = Orchard::with(strokes, &marks).red();
    assert_eq!(of_masks.strokes.truth, TruthKind::Masks);
    assert_eq!(of_strokes.strokes.truth, TruthKind::Strokes);
    assert_eq!((of_masks.strokes.images, of_masks.strokes.wood), (1, 0));
    assert!((of_masks.strokes.wood_length_px - 200.0).abs() < 1e-9);
    let [a, b] = [&of_masks.results[0], &of_strokes.results[0]];
    for (a, b) in [
        (a.recall_wide, b.recall_wide),
        (a.recall_thin, b.recall_thin),
        (a.precision, b.precision),
        (a.iou, b.iou),
    ] {
        is(a, b.unwrap().value);
    }
    assert_eq!(by_width(&a.by_width), by_width(&b.by_width));
    assert_eq!(a.posts, None);
    assert_eq!(a.worst, b.worst);
}

#[test]
fn a_mark_is_right_within_the_tolerance_of_a_pixel_of_wood() {
    for (row, precise) in [(25, 1.0), (26, 0.0)] {
        let evaluation = measured(&bench(&[[18, 23]], &[red(row, 0..100)])).unwrap();
        is(evaluation.results[0].precision, precise);
    }
}

#[test]
fn edges_do_not_count_for_calibration() {
    // Half of a band of eight rows: what is marked is right but for the rows along its edges.
    let marks: Vec<Mark> = (20..28).map(|row| red(row, 0..100)).collect();
    let evaluation = measured(&bench(&[[20, 28]], &marks)).unwrap();
    let sure = evaluation.results[0].calibration.last().unwrap();
    assert_eq!((sure.pixels, sure.share), (600, 1.0));
}

#[test]
fn images_are_those_of_the_masks() {
    let dir = bench(&[[18, 23]], &[]);
    let at = |name: &str| dir.path().join(name);
    for folder in ["images", "scene-1", "masks/scene-1"] {
        std::fs::create_dir(at(folder)).unwrap();
    }
    let image = painted([WIDTH, HEIGHT], &[red(20, 0..100)]);
    for name in ["images/b_1.jpg", "scene-1/color.png", "c.png"] {
        image.write(at(name)).unwrap();
    }
    mask(&at("masks/b_1.png"), &[[18, 23]], 255);
    mask(&at("masks/scene-1/classes.png"), &[[18, 23]], 1);
    let names = |dir: &TempDir| -> Vec<String> {
        images(dir).unwrap().into_iter().map(|i| i.name).collect()
    };
    assert_eq!(names(&dir), ["a.png", "b_1.jpg", "scene-1"]);
    let evaluation = measured(&dir).unwrap();
    assert_eq!(
        (evaluation.strokes.images, evaluation.strokes.photographs),
        (3, 3)
    );

    // With masks that say what they are, other images in the folder are none.
    mask(&at("masks/c.wood.png"), &[[18, 23]], 255);
    assert_eq!(names(&dir), ["c.png", "scene-1"]);

    let frame = masked_images(&at("scene-1"), &at("masks/scene-1"), CLASSES).unwrap();
    assert_eq!(frame[0].path, at("scene-1/color.png"));
    // A mask is not its own image.
    let beside = masked_images(&at("masks"), &at("masks"), CLASSES).unwrap_err();
    says(&beside, &["c", "is not there"]);
}

#[test]
fn classes_that_are_not_wood_are_none_and_unseen_pixels_do_not_count() {
    let dir = tempfile::tempdir().unwrap();
    let image = painted(
        [WIDTH, HEIGHT],
        &[red(20, 0..50), red(40, 0..100), red(60, 0..100)],
    );
    image.write(dir.path().join("color.png")).unwrap();
    let path = dir.path().join("classes.png");
    mask(&path, &[[18, 23]], 1);
    let mut classes = GrayImage::read(&path).unwrap();
    classes.values[40 * WIDTH..41 * WIDTH].fill(2);
    classes.values[60 * WIDTH..61 * WIDTH].fill(255);
    classes.write(&path).unwrap();
    let images = masked_images(dir.path(), dir.path(), CLASSES).unwrap();
    let segmenter = ByColor::new(Channel::Red);
    let evaluation =
        evaluate_segmentation("f", &images, &[], &[source(&segmenter)], &OPTIONS, &|| {});
    let evaluation = evaluation.unwrap();
    is(evaluation.results[0].precision, 50.0 / 150.0);
    is(evaluation.results[0].recall_wide, 0.53);

    let p = vec![1.0; WIDTH * HEIGHT];
    let verdicts = judge_pixels(&images[0], [WIDTH, HEIGHT], &p, &OPTIONS).unwrap();
    let row = |row: usize| verdicts[row * WIDTH];
    assert_eq!(row(20), PixelVerdict::Right);
    assert_eq!(row(40), PixelVerdict::Wrong);
    assert_eq!(row(60), PixelVerdict::Outside);
    let none = vec![0.0; WIDTH * HEIGHT];
    let verdicts = judge_pixels(&images[0], [WIDTH, HEIGHT], &none, &OPTIONS).unwrap();
    assert_eq!(verdicts[20 * WIDTH], PixelVerdict::Missed);
    assert_eq!(verdicts[40 * WIDTH], PixelVerdict::Rest);
    let short = judge_pixels(&images[0], [WIDTH, HEIGHT], &none[1..], &OPTIONS);
    says(&short.unwrap_err(), &["color.png", "7999 probabilities"]);
}

#[test]
fn verdicts_add_up_to_the_figures() {
    let strokes = format!("{BRANCH}far 0,40.5,2 100,40.5,2\n");
    let marks = [red(20, 0..60), red(40, 0..30), red(70, 0..20)];
    let orchard = Orchard::with(&strokes, &marks);
    // One apple of radius 15 in the middle of the branch.
    let boxes = "0 0.5 0.25 0.3 0.375\n";
    std::fs::write(orchard.dir.path().join("boxes.txt"), boxes).unwrap();
    for apple_radii in [None, Some(1.0)] {
        let mut options = OPTIONS;
        options.apple_radii = apple_radii;
        let evaluation = orchard.channels(&[Channel::Red], options);
        let images = orchard.images().unwrap();
        let p: Vec<f32> = painted([WIDTH, HEIGHT], &marks)
            .pixels
            .iter()
            .map(|pixel| f32::from(pixel[0]) / 255.0)
            .collect();
        let verdicts = judge_pixels(&images[0], [WIDTH, HEIGHT], &p, &options).unwrap();
        let count = |verdict| verdicts.iter().filter(|v| **v == verdict).count() as f64;
        let (right, wrong) = (count(PixelVerdict::Right), count(PixelVerdict::Wrong));
        is(evaluation.results[0].precision, right / (right + wrong));
        let missed = count(PixelVerdict::Missed);
        assert!(missed > 0.0);
        let is_outside = |k: usize| verdicts[k] == PixelVerdict::Outside;
        assert_eq!(is_outside(70 * WIDTH), apple_radii.is_some());
        assert!(!is_outside(20 * WIDTH + 50));
        assert_eq!(
            verdicts[40 * WIDTH + 20],
            if apple_radii.is_some() {
                PixelVerdict::Outside
            } else {
                PixelVerdict::Rest
            }
        );
    }
}

#[test]
fn what_is_no_mask_of_the_image_is_refused() {
    let dir = bench(&[[18, 23]], &[]);
    let at = |name: &str| dir.path().join(name);
    let refused = |words: &[&str]| says(&measured(&dir).unwrap_err(), words);
    mask(&at("masks/a.png"), &[[18, 23]], 254);
    refused(&["a.png", "the value 254 at (0, 18)", "255 for wood and 0"]);
    let small = GrayImage {
        width: 3,
        height: 2,
        values: vec![0; 6],
    };
    small.write(at("masks/a.png")).unwrap();
    refused(&["a.png", "3x2 pixels for an image of 100x80", "own size"]);
    painted([WIDTH, HEIGHT], &[])
        .write(at("masks/a.png"))
        .unwrap();
    refused(&["a.png", "grey"]);
    mask(&at("masks/gone.png"), &[], 255);
    refused(&["gone", "gone.png", "is not there", "images/"]);
    for name in ["a.png", "gone.png"] {
        std::fs::remove_file(at("masks").join(name)).unwrap();
    }
    refused(&["masks", "NAME.wood.png", "classes.png"]);
    std::fs::remove_dir(at("masks")).unwrap();
    refused(&["masks"]);
}
