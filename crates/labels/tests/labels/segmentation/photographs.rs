//! Intervals over photographs, and several sources beside each other.

use super::orchard::{
    BRANCH, ByColor, Channel, OPTIONS, Orchard, TWIG, WIRE, is, read, red, row_of_trees, source,
};
use pomona_cloud::ColorImage;
use pomona_labels::{
    ImageStrokes, LabelsError, SegmentationEvaluation, SegmentationImage, SegmentationSource,
    agreement, evaluate_segmentation, segmentation_page,
};

#[test]
fn intervals_contain_the_figure_and_come_from_the_photographs() {
    let of_tiles = row_of_trees(|tile| format!("tree-{tile}.png")).red();
    let of_trees = row_of_trees(|tile| format!("tree-{}_{tile}.png", tile % 3)).red();
    let of_one = row_of_trees(|tile| format!("tree_{tile}.png")).red();
    for (evaluation, photographs) in [(&of_tiles, 12), (&of_trees, 3), (&of_one, 1)] {
        assert_eq!(evaluation.strokes.images, 12);
        assert_eq!(evaluation.strokes.photographs, photographs);
        // Three more columns than are marked.
        is(
            evaluation.results[0].recall_wide,
            (0..12).map(|tile| f64::from(8 + 7 * tile)).sum::<f64>() / 1200.0,
        );
    }
    let recall = |evaluation: &SegmentationEvaluation| evaluation.results[0].recall_wide.unwrap();
    let [tiles, trees, one] = [&of_tiles, &of_trees, &of_one].map(recall);
    for wide in [tiles, trees] {
        assert!(wide.low < wide.value && wide.value < wide.high, "{wide:?}");
    }
    assert_eq!((one.low, one.high), (one.value, one.value));
}

#[test]
fn of_two_photographs_one_found_the_interval_is_everything() {
    let mut orchard = Orchard::new();
    orchard.add("seen.png", BRANCH, &[red(20, 0..100)]);
    orchard.add("missed.png", BRANCH, &[red(50, 0..100)]);
    let result = &orchard.red().results[0];
    for figure in [result.recall_wide.unwrap(), result.precision.unwrap()] {
        assert_eq!((figure.low, figure.value, figure.high), (0.0, 0.5, 1.0));
    }
}

#[test]
fn a_figure_that_one_photograph_has_alone_has_an_interval() {
    let mut orchard = Orchard::new();
    for name in ["a.png", "b.png", "c.png", "d.png"] {
        let more = if name == "a.png" {
            [WIRE, TWIG]
        } else {
            [""; 2]
        };
        let marks = [red(20, 0..100), red(60, 0..17), red(72, 0..40)];
        orchard.add(name, &(BRANCH.to_owned() + &more.concat()), &marks);
    }
    let result = &orchard.red().results[0];
    for (figure, expected) in [(result.posts, 0.4), (result.recall_thin, 0.2)] {
        is(figure, expected);
        let figure = figure.unwrap();
        for end in [figure.low, figure.high] {
            assert!((end - expected).abs() < 1e-12, "{figure:?}");
        }
    }
}

#[test]
fn differences_are_paired_over_the_photographs() {
    let orchard = row_of_trees(|tile| format!("tree-{tile}.png"));
    let evaluation = orchard.channels(&[Channel::Red, Channel::Green], OPTIONS);
    let [difference] = &evaluation.differences[..] else {
        panic!("{:?}", evaluation.differences);
    };
    assert_eq!((&*difference.first, &*difference.second), ("red", "green"));
    let [a, b] = [0, 1].map(|i| &evaluation.results[i]);
    let iou = b.iou.unwrap().value - a.iou.unwrap().value;
    assert!((difference.iou.value - iou).abs() < 1e-12);
    // Ten columns more in each image, however the images are drawn.
    for end in [
        difference.recall_wide.low,
        difference.recall_wide.value,
        difference.recall_wide.high,
    ] {
        assert!((end - 0.1).abs() < 1e-12, "{difference:?}");
    }
    let precision = difference.precision;
    assert_eq!(
        (precision.low, precision.value, precision.high),
        (0.0, 0.0, 0.0)
    );
}

#[test]
fn three_sources_have_three_differences_and_each_its_own_figures() {
    let orchard = row_of_trees(|tile| format!("tree-{tile}.png"));
    let evaluation = orchard.channels(&[Channel::Red, Channel::Green, Channel::Red], OPTIONS);
    let pairs: Vec<_> = evaluation
        .differences
        .iter()
        .map(|d| (&*d.first, &*d.second))
        .collect();
    assert_eq!(pairs, [("red", "green"), ("red", "red"), ("green", "red")]);
    assert_eq!(evaluation.results[0], evaluation.results[2]);
    let alone = orchard.channels(&[Channel::Green], OPTIONS);
    assert_eq!(evaluation.results[1], alone.results[0]);
    assert_eq!(evaluation.differences[1].iou.high, 0.0);
}

#[test]
fn neither_threads_nor_the_order_of_the_images_change_a_figure() {
    let orchard = row_of_trees(|tile| format!("tree-{}_{tile}.png", tile % 4));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| orchard.channels(&[Channel::Red, Channel::Green], OPTIONS))
    };
    assert_eq!(with(1), with(4));

    let segmenter = ByColor::new(Channel::Red);
    let mut images = orchard.images().unwrap();
    images.reverse();
    let sources = [source(&segmenter)];
    let reversed =
        evaluate_segmentation("orchard", &images, &[], &sources, &OPTIONS, &|| {}).unwrap();
    let (a, b) = (&orchard.red().results[0], &reversed.results[0]);
    assert_eq!((a.recall_wide, a.iou), (b.recall_wide, b.iou));
    assert_eq!(a.curve, b.curve);
}

#[test]
fn another_seed_moves_the_interval_and_nothing_else() {
    let orchard = row_of_trees(|tile| format!("tree-{tile}.png"));
    let with = |seed: u64| {
        let mut options = OPTIONS;
        options.seed = seed;
        let evaluation = orchard.channels(&[Channel::Red], options);
        evaluation.results[0].recall_wide.unwrap()
    };
    let (a, b) = (with(1), with(2));
    assert_eq!(a.value, b.value);
    assert_ne!((a.low, a.high), (b.low, b.high));
    assert_eq!(with(1), a);
}

#[test]
fn masks_that_say_what_a_segmenter_says_have_its_figures() {
    let orchard = row_of_trees(|tile| format!("tree-{tile}.png"));
    let segmenter = ByColor::new(Channel::Red);
    let read = |image: &SegmentationImage, size: [usize; 2]| -> Result<Vec<f32>, LabelsError> {
        let pixels = ColorImage::read(&image.path)?;
        assert_eq!(size, [pixels.width, pixels.height]);
        let red = pixels
            .pixels
            .iter()
            .map(|[red, _, _]| f32::from(*red) / 255.0);
        Ok(red.collect())
    };
    let masks = SegmentationSource::Masks {
        name: "theirs".to_owned(),
        read: &read,
    };
    assert_eq!(masks.name(), "theirs");
    let evaluation = orchard
        .measured(&[source(&segmenter), masks], OPTIONS)
        .unwrap();
    let [own, theirs] = [0, 1].map(|i| &evaluation.results[i]);
    assert_eq!((&*theirs.name, &theirs.segmenter), ("theirs", &None));
    assert_eq!(own.recall_wide, theirs.recall_wide);
    assert_eq!(own.curve, theirs.curve);
    assert_eq!(own.calibration, theirs.calibration);
    assert_eq!(own.worst, theirs.worst);
}

#[test]
fn a_second_persons_strokes_are_the_ceiling() {
    let orchard = Orchard::with(BRANCH, &[red(20, 0..100)]);
    let second = read("image a.png\nwood 0,22.5,2 50,22.5,2\nimage of_nobody.png\n");
    let segmenter = ByColor::new(Channel::Red);
    let images = orchard.images().unwrap();
    let sources = [source(&segmenter)];
    let evaluation =
        evaluate_segmentation("orchard", &images, &second, &sources, &OPTIONS, &|| {}).unwrap();
    let found = evaluation.agreement.as_ref().unwrap();
    assert_eq!(found.images, 1);
    // The lines are 2 px apart, so that 3 px reach 2.2 px beyond the end: two columns.
    assert_eq!((found.recall.count, found.recall.of), (52, 100));
    assert_eq!((found.precision.count, found.precision.of), (50, 50));
    assert_eq!(
        (found.first_length_px, found.second_length_px),
        (100.0, 50.0)
    );
    let first: Vec<ImageStrokes> = images
        .iter()
        .map(|i| i.strokes().unwrap().clone())
        .collect();
    assert_eq!(agreement(&first, &second, 3.0).as_ref(), Some(found));
    let page = segmentation_page(&evaluation, &["worst-1.png".to_owned()]).unwrap();
    assert!(page.contains("A second person"), "{page}");
    assert!(orchard.red().agreement.is_none());
}

#[test]
fn each_image_is_counted_once_when_it_is_done() {
    let orchard = row_of_trees(|tile| format!("tree-{tile}.png"));
    let done = std::sync::atomic::AtomicUsize::new(0);
    let segmenter = ByColor::new(Channel::Red);
    let count = || {
        done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let images = orchard.images().unwrap();
    let sources = [source(&segmenter)];
    evaluate_segmentation("orchard", &images, &[], &sources, &OPTIONS, &count).unwrap();
    assert_eq!(done.into_inner(), 12);
}
