//! Ways to come in for refused apples: only where asked for, labelled, and never an answer.

use crate::answers::answer;
use pomona::{AppleAnswer, Config, DirectionSource, FallbackKind, Method, Picker, Status};
use pomona_scenes::{Scene, Suite};

/// The lab apple alone; with a plate of readings left of it where `plate` says so.
fn alone(plate: bool) -> Scene {
    let mut scene = Suite::Lab15.cases().nth(2).unwrap().scene();
    let bounds = scene.frame.boxes.as_ref().unwrap()[0].clone();
    let width = scene.frame.depth.width;
    let middle = (0.5 * (bounds.y_min + bounds.y_max)) as usize * width
        + (0.5 * (bounds.x_min + bounds.x_max)) as usize;
    let depth = scene.frame.depth.readings[middle];
    for (i, reading) in scene.frame.depth.readings.iter_mut().enumerate() {
        let (u, v) = ((i % width) as f64, (i / width) as f64);
        let inside = u >= bounds.x_min && u < bounds.x_max && v >= bounds.y_min && v < bounds.y_max;
        let left = bounds.x_min - u;
        let of_plate = plate && left > 12.0 && left < 25.0 && v >= bounds.y_min && v < bounds.y_max;
        if of_plate {
            *reading = depth;
        } else if !inside {
            *reading = 0;
        }
    }
    scene
}

fn pick(scene: &Scene, method: Method, kind: FallbackKind) -> AppleAnswer {
    pick_if(scene, method, kind, 0.35)
}

fn pick_if(
    scene: &Scene,
    method: Method,
    kind: FallbackKind,
    least_confidence: f64,
) -> AppleAnswer {
    let config = Config::default().with(|c| {
        c.method = method;
        c.fallback.kind = kind;
        c.robust.least_confidence = least_confidence;
    });
    let picker = Picker::new(config).unwrap();
    answer(&picker, &scene.frame, 0).apples[0].clone()
}

#[test]
fn nothing_is_given_unless_asked_for_nor_beside_an_answer() {
    let bare = pick(&alone(false), Method::Robust, FallbackKind::None);
    assert!(bare.status != Status::Picked && bare.fallback.is_none());
    let scene = Suite::Lab15.cases().nth(2).unwrap().scene();
    let answered = pick(&scene, Method::Robust, FallbackKind::SurfaceNormal);
    assert!(answered.status == Status::Picked && answered.fallback.is_none());
}

#[test]
fn the_cap_is_come_at_from_the_side_that_shows_and_the_apple_stays_refused() {
    for method in Method::ALL {
        let scene = alone(false);
        let with = pick(&scene, method, FallbackKind::SurfaceNormal);
        assert_ne!(with.status, Status::Picked);
        assert!(with.pick.is_none() && with.robot.is_none());
        let fallback = with.fallback.unwrap();
        assert_eq!(fallback.source, DirectionSource::SurfaceNormal);
        let sight = with.apple.unwrap().center.point().coords;
        let off = sight.angle(&fallback.direction.vector()).to_degrees();
        assert!(
            off < 10.0,
            "{}: {off} degrees from the line of sight",
            method.name()
        );
    }
}

#[test]
fn the_tool_comes_from_the_side_away_from_the_obstacle() {
    // The plate is much like a branch: the least confidence is one that nothing reaches.
    let kind = FallbackKind::AwayFromObstacle;
    let with = pick_if(&alone(true), Method::Robust, kind, 1.0);
    let fallback = with.fallback.unwrap();
    assert_eq!(fallback.source, DirectionSource::AwayFromObstacle);
    assert!(
        fallback.direction.vector().x < -0.7,
        "towards the plate on the left: {:?}",
        fallback.direction
    );
    // Where nothing stands near, the label says what was given in its place.
    let free = pick(
        &alone(false),
        Method::Robust,
        FallbackKind::AwayFromObstacle,
    );
    assert_eq!(
        free.fallback.unwrap().source,
        DirectionSource::SurfaceNormal
    );
}
