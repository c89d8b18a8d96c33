//! The real frames beside the repository, where they are.

use pomona_cloud::{BoxChoice, BoxImage, CloudFormat, DepthPoints, Frame, PointCloud, read_boxes};
use std::path::PathBuf;

fn shared(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared")
        .join(name);
    if !path.exists() {
        println!("skipped: {} is not here", path.display());
        return None;
    }
    Some(path)
}

#[test]
fn real_frames_read_with_their_boxes() {
    let Some(frames) = shared("frames") else {
        return;
    };
    for id in ["orchard-1218", "orchard-1235"] {
        let frame = Frame::read(frames.join(id)).unwrap();
        assert_eq!(
            (frame.id.as_str(), frame.depth.width, frame.depth.height),
            (id, 1920, 1080)
        );
        let boxes = frame.boxes.as_ref().unwrap();
        let text = std::fs::read_to_string(frames.join(id).join("boxes.xml")).unwrap();
        assert_eq!(boxes.len(), text.matches("<object>").count());
        assert!(boxes.len() > 20);
        // The recording's notes: valid on about 27 % of pixels, 0.95 to 1.8 m.
        let valid = frame.depth.reading_count() as f64 / frame.depth.readings.len() as f64;
        assert!((0.2..0.35).contains(&valid), "{valid}");
        let mut points = DepthPoints::new();
        for pixel_box in boxes {
            let window = pixel_box.window(1920, 1080).unwrap();
            points.fill(&frame.depth, &frame.camera, window).unwrap();
            for i in 0..points.len() {
                let (u, v) = frame.camera.project(&points.point(i)).unwrap();
                let pixel = points.pixel[i] as usize;
                assert!(
                    (u - (pixel % 1920) as f64).abs() < 1e-3
                        && (v - (pixel / 1920) as f64).abs() < 1e-3
                );
            }
        }
    }
}

#[test]
fn a_real_cloud_is_the_same_in_every_format() {
    let Some(frames) = shared("frames") else {
        return;
    };
    let frame = Frame::read(frames.join("orchard-1218")).unwrap();
    let cloud = frame.crop(&frame.boxes.as_ref().unwrap()[3]).unwrap();
    let dir = tempfile::tempdir().unwrap();
    for format in CloudFormat::ALL {
        let path = dir.path().join("cloud.xyz");
        cloud.write(&path, format).unwrap();
        assert_eq!(PointCloud::read(&path).unwrap(), cloud, "{format:?}");
    }
}

#[test]
fn real_jpegs_and_their_yolo_boxes_read() {
    let Some(tiles) = shared("apple-tiles/val") else {
        return;
    };
    let images = std::fs::read_dir(tiles.join("images")).unwrap().take(40);
    for path in images.map(|entry| entry.unwrap().path()) {
        let image = pomona_cloud::ColorImage::read(&path).unwrap();
        assert_eq!((image.width, image.height), (416, 416));
        let name = path.with_extension("txt");
        let labels = tiles.join("labels").join(name.file_name().unwrap());
        let boxes = read_boxes(labels, &BoxImage::new(416, 416), &BoxChoice::default())
            .unwrap()
            .value;
        assert!(boxes.iter().all(|b| b.width() > 0.0 && b.score == 1.0));
    }
}
