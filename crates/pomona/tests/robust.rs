//! The method `robust` on generated frames: how good it is beside `paper`, that it repeats itself, and that it says
//! no where it cannot know.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on should fail where it stands"
)]

use nalgebra::Vector3;
use pomona::{Config, Method, Pick, Picker, Record, Status};
use pomona_scenes::{Density, Make, Scene, Suite};
use rayon::ThreadPoolBuilder;

fn picker(method: Method) -> Picker {
    Picker::new(Config {
        method,
        ..Config::default()
    })
    .unwrap()
}

fn target(record: &Record, scene: &Scene) -> Pick {
    let targets = scene.truth.apples.iter().map(|a| a.target != Some(false));
    let of_target = record.picks.iter().zip(targets).find(|(_, t)| *t);
    of_target.unwrap().0.clone()
}

/// Degrees off, and millimetres of the centre; a refusal has no degrees.
fn errors(scene: &Scene, pick: &Pick) -> (Option<f64>, Option<f64>) {
    let name = &pick.pixel_box.name;
    let apples = &scene.truth.apples;
    let truth = apples.iter().find(|a| &a.bounds.name == name).unwrap();
    let angle = pick
        .direction
        .zip(truth.direction)
        .map(|(a, b)| Vector3::from(a).angle(&Vector3::from(b)).to_degrees());
    let center = pick
        .apple
        .as_ref()
        .map(|apple| (Vector3::from(apple.center) - Vector3::from(truth.center)).norm() * 1e3);
    (angle, center)
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn it_beats_the_paper_by_far_in_the_orchard() {
    let (robust, paper) = (picker(Method::Robust), picker(Method::Paper));
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for case in Suite::Orchard.cases_to(1016).skip(1000) {
        let scene = case.scene();
        for (picker, errors_of) in [(&robust, &mut ours), (&paper, &mut theirs)] {
            let record = picker.pick(&scene.frame, 0, None).unwrap().record;
            errors_of.push(errors(&scene, &target(&record, &scene)));
        }
    }
    let answered = ours.iter().filter(|e| e.0.is_some()).count();
    assert!(answered >= 15, "{answered} of 16 answered");
    let angle = |e: &[(Option<f64>, Option<f64>)]| mean(e.iter().filter_map(|e| e.0));
    let center = |e: &[(Option<f64>, Option<f64>)]| mean(e.iter().filter_map(|e| e.1));
    let (a, b) = (angle(&ours), angle(&theirs));
    assert!(a < 3.0 && a < 0.2 * b, "{a} degrees against {b}");
    let (a, b) = (center(&ours), center(&theirs));
    assert!(a < 1.5 && a < 0.2 * b, "{a} mm against {b}");
}

#[test]
fn the_lab_within_a_degree_and_leaves_and_sensors_do_not_matter_much() {
    let picker = picker(Method::Robust);
    let suites = [
        (Suite::Lab15, 1.0),
        (Suite::Repeat(Density::Paper), 4.0),
        (Suite::Harsh(Make::AzureKinect), 6.0),
    ];
    for (suite, most) in suites {
        let angles = suite.cases_to(15).filter_map(|case| {
            let scene = case.scene();
            let record = picker.pick(&scene.frame, 0, None).unwrap().record;
            errors(&scene, &target(&record, &scene)).0
        });
        let angle = mean(angles);
        assert!(angle < most, "{}: {angle} degrees", suite.name());
    }
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let scene = Suite::Row.cases().next().unwrap().scene();
    let picker = picker(Method::Robust);
    let run = |threads: usize| {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let record = pool
            .install(|| picker.pick(&scene.frame, 3, None))
            .unwrap()
            .record;
        serde_json::to_string(&record.without_timing()).unwrap()
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn an_answer_says_how_sure_it_is_and_what_it_weighed() {
    let scene = Suite::Lab15.cases().next().unwrap().scene();
    let outcome = picker(Method::Robust).pick(&scene.frame, 0, None).unwrap();
    let pick = &outcome.record.picks[0];
    assert_eq!(pick.status, Status::Picked);
    assert!(pick.confidence.unwrap() > 0.8 && pick.direction_sd.unwrap() < 0.05);
    assert_eq!(pick.foot.unwrap(), pick.candidates[0].foot);
    let apple = pick.apple.as_ref().unwrap();
    assert!(apple.radius_sd.unwrap() < 1e-3 && apple.visible_share.unwrap() > 0.5);
    let branch = scene.truth.apples[0].branch.as_ref().unwrap();
    assert!((pick.candidates[0].radius - branch.radius).abs() < 1e-3);
    assert!(outcome.evidence[0].branch.len() > 100 && outcome.evidence[0].surface.len() > 1000);
}

#[test]
fn without_a_branch_there_is_no_direction_but_a_place_to_look_from() {
    let mut scene = Suite::Lab15.cases().nth(2).unwrap().scene();
    // All but the box of the apple is emptied.
    let bounds = scene.frame.boxes.as_ref().unwrap()[0].clone();
    let width = scene.frame.depth.width;
    for (i, reading) in scene.frame.depth.readings.iter_mut().enumerate() {
        let (u, v) = ((i % width) as f64, (i / width) as f64);
        let inside = u >= bounds.x_min && u < bounds.x_max && v >= bounds.y_min && v < bounds.y_max;
        if !inside {
            *reading = 0;
        }
    }
    let outcome = picker(Method::Robust).pick(&scene.frame, 0, None).unwrap();
    let pick = &outcome.record.picks[0];
    assert_ne!(pick.status, Status::Picked);
    assert!(pick.direction.is_none() && pick.apple.is_some());
    let view = Vector3::from(pick.view_from.unwrap());
    assert!((view.norm() - 1.0).abs() < 1e-9 && view.z < 0.0);
}

#[test]
fn empty_and_tiny_boxes_are_refused_by_name() {
    let scene = Suite::Lab15.cases().next().unwrap().scene();
    let mut empty = scene.frame.clone();
    empty.depth.readings.fill(0);
    let status = |frame| {
        picker(Method::Robust)
            .pick(frame, 0, None)
            .unwrap()
            .record
            .picks[0]
            .status
    };
    assert_eq!(status(&empty), Status::NoDepth);
    let mut tiny = scene.frame.clone();
    for bounds in tiny.boxes.iter_mut().flatten() {
        bounds.x_max = bounds.x_min + 2.0;
        bounds.y_max = bounds.y_min + 2.0;
    }
    assert!(matches!(
        status(&tiny),
        Status::TooFewPoints | Status::NoDepth
    ));
}
