use super::*;
use crate::Distortion;
use crate::PointCloud;
use pomona_files::FileError;

fn frame() -> Frame {
    let readings = (0..48)
        .map(|i| if i % 3 == 0 { 0 } else { 900 + i })
        .collect();
    Frame {
        id: "row-7".to_owned(),
        camera: Camera {
            width: 8,
            height: 6,
            fx: 7.0,
            fy: 7.5,
            cx: 3.5,
            cy: 2.5,
            depth_scale: 0.001,
            frame_id: "optical".to_owned(),
            distortion: Some(Distortion {
                model: "plumb_bob".to_owned(),
                coefficients: vec![0.01; 5],
            }),
        },
        color: ColorImage {
            width: 8,
            height: 6,
            pixels: (0..48).map(|i| [i, 2 * i, 3 * i]).collect(),
        },
        depth: DepthImage {
            width: 8,
            height: 6,
            readings,
        },
        boxes: Some(vec![PixelBox {
            name: "2118".to_owned(),
            x_min: 1.0,
            y_min: 2.0,
            x_max: 4.0,
            y_max: 9.0,
            score: 0.5,
        }]),
        warnings: Vec::new(),
    }
}

fn written(frame: &Frame) -> (tempfile::TempDir, PathBuf) {
    let parent = tempfile::tempdir().unwrap();
    let dir = parent.path().join(&frame.id);
    frame.write(&dir).unwrap();
    (parent, dir)
}

#[test]
fn a_folder_reads_back_with_and_without_boxes() {
    for frame in [
        frame(),
        Frame {
            boxes: None,
            ..frame()
        },
    ] {
        let (parent, dir) = written(&frame);
        assert_eq!(Frame::read(&dir).unwrap(), frame);
        assert_eq!(
            fs::read_dir(parent.path()).unwrap().count(),
            1,
            "nothing is left beside it"
        );
        frame.write(&dir).unwrap();
        assert_eq!(
            Frame::read(dir.join("..").join("row-7")).unwrap().id,
            "row-7"
        );
    }
}

#[test]
fn a_crop_holds_the_coloured_points_of_the_box() {
    let frame = frame();
    let cloud = frame.crop(&frame.boxes.as_ref().unwrap()[0]).unwrap();
    let expected = (2..6)
        .flat_map(|v| (1..4).map(move |u| 8 * v + u))
        .filter(|i| i % 3 != 0);
    let expected: Vec<u8> = expected.collect();
    assert_eq!(cloud.len(), expected.len());
    assert_eq!(
        cloud.colors.as_ref().unwrap()[0],
        [expected[0], 2 * expected[0], 3 * expected[0]]
    );
    let organised = PointCloud::from_frame(&frame).unwrap();
    assert_eq!((organised.size, organised.len()), (Some((8, 6)), 48));
    assert_eq!(
        organised.finite_points().count(),
        frame.depth.reading_count()
    );
    assert_eq!(organised.point(usize::from(expected[0])), cloud.point(0));
}

#[test]
fn a_missing_part_is_named() {
    for (name, message) in [
        ("color.png", "no color.png or color.jpg"),
        ("depth.png", "no depth.png"),
        ("camera.json", "no camera.json"),
    ] {
        let (_parent, dir) = written(&frame());
        fs::remove_file(dir.join(name)).unwrap();
        let error = Frame::read(&dir).unwrap_err().to_string();
        assert!(
            error.contains("row-7") && error.contains(message),
            "{error}"
        );
    }
    assert!(matches!(
        Frame::read("/no/such/folder"),
        Err(CloudError::File(FileError::Read { .. }))
    ));
}

#[test]
fn parts_of_different_sizes_are_refused_by_both_names() {
    let (_parent, dir) = written(&frame());
    DepthImage::empty(4, 3)
        .write(dir.join("depth.png"))
        .unwrap();
    let error = Frame::read(&dir).unwrap_err().to_string();
    assert!(
        error.contains("colour image is 8x6") && error.contains("depth image is 4x3"),
        "{error}"
    );

    let (_parent, dir) = written(&frame());
    Camera {
        width: 16,
        ..frame().camera
    }
    .write(dir.join("camera.json"))
    .unwrap();
    let error = Frame::read(&dir).unwrap_err().to_string();
    assert!(
        error.contains("the camera is 16x6") && error.contains("8x6"),
        "{error}"
    );
}

#[test]
fn damaged_parts_are_refused_by_name() {
    for (name, bytes, message) in [
        ("color.png", &b"\x89PNG\r\n\x1a\n"[..], "PNG data"),
        ("depth.png", b"", "PNG data"),
        ("camera.json", b"{}", "missing field"),
        (
            "boxes.xml",
            b"<annotation><object/></annotation>",
            "without a box",
        ),
    ] {
        let (_parent, dir) = written(&frame());
        fs::write(dir.join(name), bytes).unwrap();
        let error = Frame::read(&dir).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(message), "{error}");
    }
    let (_parent, dir) = written(&frame());
    fs::remove_file(dir.join("boxes.xml")).unwrap();
    fs::write(dir.join("boxes.txt"), "0 5.5 0.5 0.1 0.1").unwrap();
    assert!(matches!(Frame::read(&dir), Err(CloudError::Box { .. })));
}

#[test]
fn a_folder_that_holds_another_frame_s_files_is_left_alone() {
    let (_parent, dir) = written(&frame());
    let error = Frame {
        boxes: None,
        ..frame()
    }
    .write(&dir)
    .unwrap_err()
    .to_string();
    assert!(error.contains("boxes.xml"), "{error}");
    assert_eq!(Frame::read(&dir).unwrap(), frame());
}

#[test]
fn an_invalid_frame_is_not_written() {
    let parent = tempfile::tempdir().unwrap();
    let dir = parent.path().join("frame");
    let mut bad = frame();
    bad.depth.readings.pop();
    assert!(bad.write(&dir).is_err());
    let mut outside = frame();
    outside.boxes.as_mut().unwrap()[0].x_min = f64::NAN;
    assert!(outside.write(&dir).is_err());
    assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 0);
}
