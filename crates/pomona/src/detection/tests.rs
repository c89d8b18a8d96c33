use super::*;
use crate::outcome::{FrameAnswer, Status};
use crate::picker::Picker;
use crate::record::PicksRecord;
use nalgebra::{Point3, Vector3};
use pomona_cloud::{Camera, DepthImage, Frame};
use pomona_detect::{DetectError, DetectorReport, RuntimeReport};

/// Answers with what it is told.
struct Fixed(Vec<Detection>);

impl Detector for Fixed {
    fn detect(&self, _: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        Ok(self.0.clone())
    }

    fn report(&self) -> DetectorReport {
        let mut report = DetectorReport::new("fixed");
        report.family = Some("truth".to_owned());
        report.runtime = Some(RuntimeReport::new("none", "1"));
        report.notes = vec!["none".to_owned()];
        report
    }
}

const FOCAL: f64 = 540.0;

/// Depth in metres where a ray (x/z, y/z, 1) meets something.
type Surface<'a> = &'a dyn Fn(&Vector3<f64>) -> Option<f64>;

/// What a camera of 320 x 240 pixels sees, depth in tenths of a millimetre.
fn frame(surfaces: &[Surface<'_>]) -> Frame {
    let mut camera = Camera::new([320, 240], [FOCAL; 2], [159.5, 119.5]);
    camera.depth_scale = 0.0001;
    let mut depth = DepthImage::empty(320, 240);
    for (i, reading) in depth.readings.iter_mut().enumerate() {
        let (u, v) = ((i % 320) as f64, (i / 320) as f64);
        let ray = Vector3::new((u - camera.cx) / FOCAL, (v - camera.cy) / FOCAL, 1.0);
        let nearest = surfaces.iter().filter_map(|s| s(&ray)).reduce(f64::min);
        *reading = nearest.map_or(0, |z| (z / camera.depth_scale) as u16);
    }
    let color = ColorImage::filled(320, 240, [150, 40, 40]);
    Frame::new("test", camera, color, depth)
}

/// The nearer root of a t² − 2 b t + c = 0.
fn nearer(a: f64, b: f64, c: f64) -> Option<f64> {
    let discriminant = b * b - a * c;
    (discriminant >= 0.0).then(|| (b - discriminant.sqrt()) / a)
}

fn ball(x: f64, y: f64, z: f64, radius: f64) -> impl Fn(&Vector3<f64>) -> Option<f64> {
    let center = Vector3::new(x, y, z);
    move |ray| {
        nearer(
            ray.norm_squared(),
            ray.dot(&center),
            center.norm_squared() - radius * radius,
        )
    }
}

/// An upright post.
fn post(z: f64, radius: f64) -> impl Fn(&Vector3<f64>) -> Option<f64> {
    move |ray| nearer(ray.x * ray.x + 1.0, z, z * z - radius * radius)
}

/// The box about a ball of this outline.
fn about(x: f64, y: f64, z: f64, radius: f64) -> Detection {
    let (u, v) = (159.5 + FOCAL * x / z, 119.5 + FOCAL * y / z);
    let half = FOCAL * radius / z + 1.0;
    Detection {
        x_min: u - half,
        y_min: v - half,
        x_max: u + half,
        y_max: v + half,
        score: 0.8,
        class: 0,
    }
}

fn find(frame: &Frame, detections: Vec<Detection>, config: &Config) -> DetectedApples {
    let frame = CheckedFrame::new(frame).unwrap();
    find_apples(&frame, &Fixed(detections), config).unwrap()
}

#[track_caller]
fn mark(surfaces: &[Surface<'_>], detection: Detection) -> Mark {
    let found = find(&frame(surfaces), vec![detection], &Config::default());
    found.boxes[0].origin.mark
}

#[test]
fn an_apple_is_plausible_and_its_sphere_is_right() {
    let frame = frame(&[&ball(0.02, -0.01, 0.8, 0.038)]);
    let found = find(
        &frame,
        vec![about(0.02, -0.01, 0.8, 0.038)],
        &Config::default(),
    );
    assert_eq!(found.boxes[0].origin.mark, Mark::Plausible);
    assert_eq!(found.plausible().count(), 1);
    let sphere = found.boxes[0].sphere.unwrap();
    assert!((sphere.center - Point3::new(0.02, -0.01, 0.8)).norm() < 0.002);
    assert!((sphere.radius - 0.038).abs() < 0.002, "{sphere:?}");
    let runtime = found.summary.detector.runtime.as_ref().unwrap();
    assert_eq!(runtime.name, "none");
    assert_eq!((found.summary.detections, found.summary.marked), (1, 0));
}

#[test]
fn each_mark_has_its_case() {
    let wall = |ray: &Vector3<f64>| Some(0.8 / (1.0 + 0.3 * ray.x));
    let apple_sized = about(0.0, 0.0, 0.8, 0.038);
    assert_eq!(mark(&[&wall], apple_sized), Mark::Flat);
    assert_eq!(mark(&[&post(0.8, 0.03)], apple_sized), Mark::NotRound);
    assert_eq!(mark(&[], apple_sized), Mark::NoDepth);
    let berry = (0.0, 0.0, 0.8, 0.008);
    assert_eq!(
        mark(
            &[&ball(berry.0, berry.1, berry.2, berry.3)],
            about(berry.0, berry.1, berry.2, berry.3)
        ),
        Mark::TooSmall
    );
    assert_eq!(
        mark(&[&ball(0.0, 0.0, 0.9, 0.13)], about(0.0, 0.0, 0.9, 0.13)),
        Mark::TooLarge
    );
    assert_eq!(
        mark(&[&ball(0.0, 0.0, 3.0, 0.04)], about(0.0, 0.0, 3.0, 0.04)),
        Mark::TooFar
    );
}

#[test]
fn names_are_those_of_the_record() {
    for mark in Mark::ALL {
        assert_eq!(serde_json::to_value(mark).unwrap(), mark.name());
    }
    for by in [FoundBy::Color, FoundBy::Depth] {
        assert_eq!(serde_json::to_value(by).unwrap(), by.name());
    }
}

#[test]
fn parts_of_one_apple_become_its_box_and_neighbours_stay_apart() {
    let (a, b) = ((-0.05, 0.0, 0.8, 0.038), (0.03, 0.01, 0.82, 0.036));
    let frame = frame(&[&ball(a.0, a.1, a.2, a.3), &ball(b.0, b.1, b.2, b.3)]);
    let (first, second) = (about(a.0, a.1, a.2, a.3), about(b.0, b.1, b.2, b.3));
    let cut = 0.55 * (first.x_max - first.x_min);
    let left = Detection {
        x_max: first.x_min + cut,
        ..first
    };
    let right = Detection {
        x_min: first.x_max - cut,
        score: 0.5,
        ..first
    };
    let found = find(&frame, vec![left, second, right], &Config::default());
    assert_eq!(found.boxes.len(), 2, "{found:?}");
    let joint = &found.boxes[0];
    assert_eq!(
        (joint.bounds.name.as_str(), joint.bounds.score),
        ("0+2", 0.8)
    );
    assert_eq!(joint.origin.merged, 2);
    assert_eq!(
        (joint.bounds.x_min, joint.bounds.x_max),
        (first.x_min, first.x_max)
    );
    assert_eq!(found.summary.merged, 1);

    // A box about both is no better box of either.
    let both = Detection {
        x_min: first.x_min,
        x_max: second.x_max,
        y_min: first.y_min.min(second.y_min),
        y_max: first.y_max.max(second.y_max),
        score: 0.3,
        class: 0,
    };
    let found = find(&frame, vec![first, second, both], &Config::default());
    assert_eq!(found.boxes.len(), 3);
    assert!(found.boxes[2].origin.mark.refuses(), "{found:?}");

    let mut config = Config::default();
    config.detection.merge_distance = 0.0;
    assert_eq!(find(&frame, vec![left, right], &config).boxes.len(), 2);
}

#[test]
fn a_search_in_depth_finds_what_the_colour_misses() {
    let (a, b) = ((-0.08, 0.0, 0.8, 0.038), (0.08, 0.02, 0.9, 0.036));
    let frame = frame(&[
        &ball(a.0, a.1, a.2, a.3),
        &ball(b.0, b.1, b.2, b.3),
        &|_| Some(1.5),
    ]);
    let seen = vec![about(a.0, a.1, a.2, a.3)];
    let mut config = Config::default();
    assert_eq!(find(&frame, seen.clone(), &config).boxes.len(), 1);
    config.detection.depth_search = true;
    let found = find(&frame, seen, &config);
    assert_eq!(
        (found.boxes.len(), found.summary.by_depth),
        (2, 1),
        "{found:?}"
    );
    let more = &found.boxes[1];
    assert_eq!(
        (more.origin.found_by, more.bounds.name.as_str()),
        (FoundBy::Depth, "d0")
    );
    let center = more.sphere.unwrap().center;
    assert!((center - Point3::new(b.0, b.1, b.2)).norm() < 0.003);
    assert!(found.summary.times.depth_search.is_some());
}

#[test]
fn refused_boxes_stay_in_the_record_and_are_not_picked() {
    let frame = frame(&[&|_| Some(0.8)]);
    let mut config = Config::default();
    let found = find(&frame, vec![about(0.0, 0.0, 0.8, 0.038)], &config);
    let pick = |config: &Config| -> FrameAnswer {
        let picker = Picker::new(config.clone()).unwrap();
        let frame = CheckedFrame::new(&frame).unwrap();
        picker.pick_detected(&frame, &found, 0, None).unwrap()
    };
    let answer = pick(&config);
    assert_eq!(answer.apples[0].status, Status::Implausible);
    assert_eq!(answer.apples[0].origin.unwrap().mark, Mark::Flat);
    assert!(answer.apples[0].apple.is_none());
    let record = PicksRecord::from(&answer);
    let detection = record.detection.clone().unwrap();
    assert_eq!((detection.name.as_str(), detection.marked), ("fixed", 1));
    let text = serde_json::to_string(&record).unwrap();
    assert_eq!(serde_json::from_str::<PicksRecord>(&text).unwrap(), record);

    config.detection.pick_marked = true;
    assert_ne!(pick(&config).apples[0].status, Status::Implausible);
    config.detection.depth_check = false;
    let unchecked = find(&frame, vec![about(0.0, 0.0, 0.8, 0.038)], &config);
    assert_eq!(unchecked.boxes[0].origin.mark, Mark::Unchecked);
}

#[test]
fn whatever_a_detector_says_is_no_panic() {
    let frame = frame(&[&ball(0.0, 0.0, 0.8, 0.038)]);
    let numbers = [
        f64::NAN,
        f64::INFINITY,
        -1e300,
        -5.0,
        0.0,
        160.0,
        319.5,
        1e9,
    ];
    let mut detections = Vec::new();
    for x_min in numbers {
        for x_max in numbers {
            detections.push(Detection {
                x_min,
                y_min: 100.0,
                x_max,
                y_max: 140.0,
                score: x_min,
                class: 0,
            });
        }
    }
    let mut config = Config::default();
    config.detection.depth_search = true;
    let found = find(&frame, detections, &config);
    let picker = Picker::new(config).unwrap();
    let frame = CheckedFrame::new(&frame).unwrap();
    picker.pick_detected(&frame, &found, 0, None).unwrap();
}

#[test]
fn a_detector_that_fails_is_an_error_that_names_the_frame() {
    struct Broken;
    impl Detector for Broken {
        fn detect(&self, _: &ColorImage) -> Result<Vec<Detection>, DetectError> {
            Err(DetectError::Other {
                detector: "camera".to_owned(),
                source: "no signal".into(),
            })
        }
        fn report(&self) -> DetectorReport {
            DetectorReport::default()
        }
    }
    let frame = frame(&[]);
    let frame = CheckedFrame::new(&frame).unwrap();
    let error = find_apples(&frame, &Broken, &Config::default()).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("'test'") && message.contains("no signal"),
        "{message}"
    );
}
