//! What every suite promises of its scenes.

use nalgebra::{Point3, Vector3};
use pomona_geometry::Line;
use pomona_scenes::{Density, Make, Repeat, Scene, Suite};

/// Truth and frame agree, and the truth with itself.
fn check(scene: &Scene) {
    let id = &scene.frame.id;
    let boxes = scene.frame.boxes.as_ref().unwrap();
    assert_eq!(boxes.len(), scene.truth.apples.len(), "{id}");
    assert!(!boxes.is_empty(), "{id}");
    scene.frame.validate().unwrap();
    let camera = scene.truth.camera.as_ref().unwrap_or(&scene.frame.camera);
    for apple in &scene.truth.apples {
        let center = Point3::from(apple.center);
        let share = apple.visible_share.unwrap();
        assert!(share > 0.0 && share <= 1.0, "{id}: {share}");
        // The centre's image lies in the box where most of the apple shows, give or take the shift.
        if share > 0.9 && apple.bounds.x_min > 0.0 && apple.bounds.y_max < camera.height as f64 {
            let (u, v) = camera.project(&center).unwrap();
            let b = &apple.bounds;
            assert!(
                b.x_min < u && u < b.x_max && b.y_min < v && v < b.y_max,
                "{id}"
            );
        }
        let (Some(branch), Some(direction)) = (&apple.branch, apple.direction) else {
            assert!(apple.branch.is_none() && apple.direction.is_none(), "{id}");
            continue;
        };
        let tangent = Line::new(branch.point.into(), branch.direction.into()).unwrap();
        let distance = (tangent.point - center).norm();
        let foot = center + Vector3::from(direction) * distance;
        assert!((foot - tangent.point).norm() < 1e-9, "{id}");
        assert!(
            (tangent.foot(&center) - tangent.point).norm() < 1e-7,
            "{id}: not the nearest point"
        );
        assert!(distance <= 1.8 * apple.radius, "{id}");
        // No chord of the shell is longer than its diameter; a slice of 2 mm at either end.
        let length = branch.visible_length.unwrap();
        assert!(
            length <= 6.2 * apple.radius + 0.004,
            "{id}: {length} about {}",
            apple.radius
        );
    }
}

#[test]
fn first_scenes_of_all_suites_hold_together() {
    for &suite in Suite::ALL {
        for case in suite.cases_to(1) {
            let scene = case.scene();
            assert_eq!(scene.frame.id, case.name);
            assert_eq!(scene.truth.seed, Some(case.seed));
            check(&scene);
            let targets = scene
                .truth
                .apples
                .iter()
                .filter(|a| a.target == Some(true))
                .count();
            let expected = usize::from(!matches!(suite, Suite::Dense | Suite::Row | Suite::Demo));
            assert_eq!(targets, expected, "{}", case.name);
        }
    }
}

#[test]
fn a_case_gives_the_same_scene_twice_and_the_next_case_another() {
    for suite in [
        Suite::Orchard,
        Suite::Rivals,
        Suite::Repeat(Density::Paper),
        Suite::Harsh(Make::D400),
        Suite::Dense,
    ] {
        let cases: Vec<_> = suite.cases_to(5).skip(3).collect();
        assert_eq!(cases[0].scene(), cases[0].scene());
        assert_ne!(cases[0].scene().frame.depth, cases[1].scene().frame.depth);
    }
}

#[test]
fn suites_go_on_beyond_their_length() {
    let case = Suite::Lab15.cases_to(17).last().unwrap();
    assert_eq!((case.name.as_str(), case.seed), ("lab-x-45-s1", 1));
    assert_eq!(
        Suite::named("repeat474").unwrap(),
        Suite::Repeat(Density::Paper)
    );
    assert_eq!(
        Suite::named("harsh-paper").unwrap(),
        Suite::Harsh(Make::Paper)
    );
}

#[test]
fn harsh_scenes_are_the_orchards_with_less_depth() {
    let plain = Suite::Orchard.scenes().next().unwrap();
    for make in Make::ALL {
        let harsh = Suite::Harsh(make).scenes().next().unwrap();
        assert_eq!(plain.truth.apples[0].center, harsh.truth.apples[0].center);
        assert!(harsh.frame.depth.reading_count() < plain.frame.depth.reading_count());
        let shift = harsh.truth.apples[0].bounds.x_min - plain.truth.apples[0].bounds.x_min;
        assert_eq!(shift.abs(), 2.0);
        assert!(harsh.truth.camera.is_some());
    }
}

#[test]
fn repeats_move_the_box_by_the_stated_deviation_and_keep_the_truth() {
    let repeat = Repeat::new(Density::Light);
    let scenes: Vec<Scene> = (0..16).map(|i| repeat.scene("repeat", i)).collect();
    let mut shifts = Vec::new();
    for scene in &scenes {
        let (truth, given) = (
            &scene.truth.apples[0].bounds,
            &scene.frame.boxes.as_ref().unwrap()[0],
        );
        shifts.extend([given.x_min - truth.x_min, given.y_max - truth.y_max]);
        let gap = scene.truth.apples[0].center[2] - repeat.distance;
        assert!(gap.abs() < 5.0 * repeat.body_sway);
    }
    let square = shifts.iter().map(|s| s * s).sum::<f64>() / shifts.len() as f64;
    // Four standard errors of a variance: 4·√(2/32).
    assert!(
        (square / repeat.box_shift_px.powi(2) - 1.0).abs() < 1.0,
        "{square}"
    );
    let directions: Vec<_> = scenes
        .iter()
        .map(|s| s.truth.apples[0].direction.unwrap())
        .collect();
    // The body shifts as a whole: the direction to pick stays.
    let still = |d: &[f64; 3]| (Vector3::from(*d) - Vector3::from(directions[0])).norm() < 1e-9;
    assert!(directions.iter().all(still));
}

#[test]
fn all_drawn_trees_have_apples_in_sight() {
    let scene = Suite::Row.scenes().next().unwrap();
    assert!((10..=40).contains(&scene.truth.apples.len()));
    let demo = Suite::Demo.scenes().next().unwrap();
    assert!((6..=8).contains(&demo.truth.apples.len()));
    assert!(demo.truth.apples.iter().all(|a| a.branch.is_some()));
}
