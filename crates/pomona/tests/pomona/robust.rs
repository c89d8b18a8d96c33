//! The method `robust` on generated frames: how good it is beside `paper`, that it repeats itself, and that it says
//! no where it cannot know.

use crate::answers::{answer, picker};
use nalgebra::Vector3;
use pomona::record::PicksRecord;
use pomona::{AppleAnswer, CheckedFrame, FrameAnswer, Method, Status};
use pomona_cloud::Frame;
use pomona_scenes::{Density, Make, Scene, Suite};
use rayon::ThreadPoolBuilder;

fn target(answer: &FrameAnswer, scene: &Scene) -> AppleAnswer {
    let targets = scene.truth.apples.iter().map(|a| a.target != Some(false));
    let of_target = answer.apples.iter().zip(targets).find(|(_, t)| *t);
    of_target.unwrap().0.clone()
}

/// Degrees off, and millimetres of the centre; a refusal has no degrees.
fn errors(scene: &Scene, answer: &AppleAnswer) -> (Option<f64>, Option<f64>) {
    let name = &answer.bounds.name;
    let apples = &scene.truth.apples;
    let truth = apples.iter().find(|a| &a.bounds.name == name).unwrap();
    let angle = answer.pick.zip(truth.direction).map(|(pick, right)| {
        let given = pick.direction.vector();
        given.angle(&Vector3::from(right)).to_degrees()
    });
    let center = answer.apple.map(|apple| {
        let off = apple.center.point().coords - Vector3::from(truth.center);
        off.norm() * 1e3
    });
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
            let answer = answer(picker, &scene.frame, 0);
            errors_of.push(errors(&scene, &target(&answer, &scene)));
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
            let answer = answer(&picker, &scene.frame, 0);
            errors(&scene, &target(&answer, &scene)).0
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
        let answer = pool.install(|| answer(&picker, &scene.frame, 3));
        serde_json::to_string(&PicksRecord::from(&answer).without_timing()).unwrap()
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn an_answer_says_how_sure_it_is_and_what_it_weighed() {
    let scene = Suite::Lab15.cases().next().unwrap().scene();
    let answer = answer(&picker(Method::Robust), &scene.frame, 0);
    let answer = &answer.apples[0];
    assert_eq!(answer.status, Status::Picked);
    let pick = answer.pick.unwrap();
    assert!(answer.confidence.unwrap() > 0.8 && pick.sd_rad.unwrap() < 0.05);
    assert_eq!(pick.foot, answer.candidates[0].foot);
    let apple = answer.apple.unwrap();
    assert!(apple.radius_sd_m.unwrap() < 1e-3 && apple.visible_share.unwrap() > 0.5);
    let branch = scene.truth.apples[0].branch.as_ref().unwrap();
    assert!((answer.candidates[0].radius_m - branch.radius).abs() < 1e-3);
    assert!(answer.evidence.branch.len() > 100 && answer.evidence.surface.len() > 1000);
}

/// Number of the pixels of `surface` that lie in the frame's first box.
fn in_first_box(frame: &Frame, surface: &[u32]) -> usize {
    let bounds = &frame.boxes.as_ref().unwrap()[0];
    let width = frame.depth.width;
    let inside = |pixel: &&u32| {
        let (u, v) = (**pixel as usize % width, **pixel as usize / width);
        let window = bounds.window(width, frame.depth.height).unwrap();
        window.contains(u, v)
    };
    surface.iter().filter(inside).count()
}

#[test]
fn inliers_are_the_readings_of_the_box_on_the_surface() {
    let frame = Suite::Lab15.cases().next().unwrap().scene().frame;
    let answer = answer(&picker(Method::Robust), &frame, 0);
    let (apple, evidence) = (answer.apples[0].apple.unwrap(), &answer.apples[0].evidence);
    let seen = in_first_box(&frame, &evidence.surface);
    // All but the few readings that lie inside the body, mixed with what stands before it.
    assert!(
        apple.inliers <= seen && apple.inliers * 20 > seen * 19,
        "{} of {seen}",
        apple.inliers
    );
    // By hand: a reading lies on the surface where its distance from the fitted sphere is within noise and flattening.
    let checked = CheckedFrame::new(&frame).unwrap();
    let points = checked.points();
    let near = (0..points.len()).filter(|&i| {
        let distance = (points.point(i) - apple.center.point()).norm() - apple.radius_m;
        distance.abs() < 0.006 && in_first_box(&frame, &points.pixel[i..=i]) == 1
    });
    let near = near.count();
    assert!(
        near * 10 > apple.inliers * 9 && near * 10 < apple.inliers * 12,
        "{near}"
    );
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
    let answer = answer(&picker(Method::Robust), &scene.frame, 0);
    let answer = &answer.apples[0];
    assert_ne!(answer.status, Status::Picked);
    assert!(answer.pick.is_none() && answer.apple.is_some());
    let view = answer.view_from.unwrap().vector();
    assert!((view.norm() - 1.0).abs() < 1e-9 && view.z < 0.0);
}

#[test]
fn empty_and_tiny_boxes_are_refused_by_name() {
    let scene = Suite::Lab15.cases().next().unwrap().scene();
    let mut empty = scene.frame.clone();
    empty.depth.readings.fill(0);
    let status = |frame| answer(&picker(Method::Robust), frame, 0).apples[0].status;
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
