//! The model that is part of the program.

use pomona_cloud::ColorImage;
use pomona_detect::{ClassChoice, Detection, DetectorOptions, RuntimeChoice};

/// A disk that is shaded like a ball with a highlight, before dull leaves.
fn scene(apples: &[[f64; 3]]) -> ColorImage {
    let mut image = ColorImage::filled(416, 416, [0; 3]);
    for (k, pixel) in image.pixels.iter_mut().enumerate() {
        let (u, v) = ((k % 416) as f64, (k / 416) as f64);
        let leaf = 20.0 * ((u / 9.0).sin() * (v / 13.0).cos() + (u / 31.0 + v / 23.0).sin());
        *pixel = [50.0 + leaf, 90.0 + leaf, 40.0 + leaf].map(|x: f64| x as u8);
        for [x, y, radius] in apples {
            let (dx, dy) = ((u - x) / radius, (v - y) / radius);
            let inside = 1.0 - dx * dx - dy * dy;
            if inside > 0.0 {
                let light = 0.35 + 0.65 * (inside.sqrt() - 0.4 * dx - 0.5 * dy).clamp(0.0, 1.0);
                *pixel = [205.0 * light, 35.0 * light, 40.0 * light].map(|x: f64| x as u8);
            }
        }
    }
    image
}

#[test]
fn it_opens_and_sees_red_balls_before_leaves() {
    let options = DetectorOptions::default().with(|o| o.runtime = RuntimeChoice::Embedded);
    let detector = options.open().unwrap();
    assert_eq!(detector.report().family.as_deref(), Some("yolov8"));
    assert!(detector.report().notes.is_empty());
    let apples = [
        [100.0, 120.0, 28.0],
        [290.0, 250.0, 40.0],
        [170.0, 330.0, 22.0],
    ];
    let found = detector.detect(&scene(&apples)).unwrap();
    println!("{found:?}");
    for [x, y, radius] in apples {
        let apple = Detection {
            x_min: x - radius,
            y_min: y - radius,
            x_max: x + radius,
            y_max: y + radius,
            score: 1.0,
            class: 0,
        };
        assert!(
            found.iter().any(|d| d.iou(&apple) > 0.5),
            "{apple:?} {found:?}"
        );
    }
    assert!(found.len() <= apples.len() + 2, "{found:?}");
}

#[test]
fn it_has_one_class() {
    let options = DetectorOptions::default().with(|o| {
        o.runtime = RuntimeChoice::Embedded;
        o.class = Some(ClassChoice::Name("pear".to_owned()));
    });
    let message = options.open().map(|_| ()).unwrap_err().to_string();
    assert!(
        message.contains("class `pear`") && message.contains("`apple`"),
        "{message}"
    );
}
