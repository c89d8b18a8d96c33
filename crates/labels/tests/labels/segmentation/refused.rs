//! Where images are found, and which images, strokes and masks are refused.

use super::orchard::{
    BRANCH, HEIGHT, OPTIONS, Orchard, STROKES, WIDTH, is, painted, read, red, says,
};
use pomona_labels::{LabelsError, SegmentationImage, SegmentationSource, segmentation_images};
use std::path::Path;

#[test]
fn images_are_found_beside_the_strokes_in_a_folder_of_images_and_in_frames() {
    let mut orchard = Orchard::new();
    let root = orchard.dir.path().to_owned();
    let frame = root.join("frame-7");
    for place in [root.join("images"), frame.clone()] {
        std::fs::create_dir(place).unwrap();
    }
    let image = painted([WIDTH, HEIGHT], &[red(20, 0..100)]);
    image.write(root.join("images/b.png")).unwrap();
    image.write(frame.join("color.png")).unwrap();
    orchard.add("a.png", BRANCH, &[red(20, 0..100)]);
    orchard.name("b.png", BRANCH);
    orchard.name("frame-7", BRANCH);
    let paths: Vec<_> = orchard
        .images()
        .unwrap()
        .into_iter()
        .map(|i| i.path)
        .collect();
    let expected = ["a.png", "images/b.png", "frame-7/color.png"].map(|name| root.join(name));
    assert_eq!(paths, expected);
    is(orchard.red().results[0].recall_wide, 1.0);

    let of_frame = segmentation_images(&frame, read("image frame-7\n"), Path::new(STROKES));
    assert_eq!(of_frame.unwrap()[0].path, frame.join("color.png"));
}

#[test]
fn strokes_of_no_image_are_refused() {
    says(
        &Orchard::new().images().unwrap_err(),
        &[STROKES, "names no image"],
    );
    let mut orchard = Orchard::new();
    orchard.name("gone.png", BRANCH);
    says(
        &orchard.images().unwrap_err(),
        &["gone.png", STROKES, "is not there", "images/"],
    );
}

#[test]
fn strokes_outside_the_image_are_refused() {
    Orchard::with("wood 120,20.5,2 180,20.5,2", &[]).refused(&[
        "a.png",
        "100x80",
        "(120, 20.5)",
        "another image",
    ]);
    Orchard::with(&format!("{BRANCH}post 10,90,2 20,95,2"), &[]).refused(&["a.png", "(10, 90)"]);
}

#[test]
fn images_that_cannot_be_used_are_named() {
    let mut orchard = Orchard::new();
    orchard.add("a.png", BRANCH, &[]);
    std::fs::write(orchard.dir.path().join("b.png"), "no picture").unwrap();
    orchard.name("b.png", BRANCH);
    orchard.refused(&["b.png"]);

    let mut orchard = Orchard::new();
    let narrow = painted([3, 9], &[]);
    narrow.write(orchard.dir.path().join("n.png")).unwrap();
    orchard.name("n.png", "wood 1,0,1 1,9,1");
    orchard.refused(&["n.png", "red", "too narrow"]);
}

#[test]
fn masks_of_another_size_and_those_that_cannot_be_read_are_refused() {
    let orchard = Orchard::with(BRANCH, &[]);
    for count in [0, WIDTH * HEIGHT - 1, WIDTH * HEIGHT + 1] {
        let read = |_: &SegmentationImage, _: [usize; 2]| -> Result<Vec<f32>, LabelsError> {
            Ok(vec![1.0; count])
        };
        let masks = SegmentationSource::Masks {
            name: "theirs".to_owned(),
            read: &read,
        };
        let refused = orchard.measured(&[masks], OPTIONS).unwrap_err();
        let count = format!("{count} probabilities");
        says(&refused, &["a.png", "100x80", "`theirs`", &count]);
    }
    let unreadable = |image: &SegmentationImage, _: [usize; 2]| -> Result<Vec<f32>, LabelsError> {
        Err(LabelsError::Malformed {
            path: image.path.with_extension("mask.png"),
            problem: "is not there".to_owned(),
            remedy: "write it".to_owned(),
        })
    };
    let masks = SegmentationSource::Masks {
        name: "theirs".to_owned(),
        read: &unreadable,
    };
    let refused = orchard.measured(&[masks], OPTIONS).unwrap_err();
    says(&refused, &["a.mask.png", "write it"]);
}
