//! A frame without noise shows what the truth says, to within a pixel's footprint.

use nalgebra::Point3;
use pomona_cloud::Camera;
use pomona_geometry::{Segment, Sphere};
use pomona_scenes::{Lab, Orientation, Scene, Sensor, Shot};

fn half_size() -> Camera {
    Shot::paper_camera().with_intrinsics([640, 480], [540.0; 2], [319.5, 239.5])
}

fn lab(orientation: Orientation) -> Scene {
    let world = Lab::default().world(orientation);
    let mut shot = Shot::new("lab", half_size(), Sensor::perfect(), 0);
    shot.box_margin_px = 0.0;
    shot.take(&world)
}

/// All readings in front of the wall, as points.
fn body_points(scene: &Scene) -> Vec<Point3<f64>> {
    let camera = &scene.frame.camera;
    let (w, scale) = (camera.width, camera.depth_scale);
    let readings = scene.frame.depth.readings.iter().enumerate();
    readings
        .map(|(i, &r)| camera.deproject((i % w) as f64, (i / w) as f64, f64::from(r) * scale))
        .filter(|p| p.z < 1.2)
        .collect()
}

#[test]
fn every_reading_lies_on_the_apple_the_branch_or_the_joint() {
    for orientation in Orientation::PAPER {
        let scene = lab(orientation);
        let apple = &scene.truth.apples[0];
        let branch = apple.branch.as_ref().unwrap();
        let center = Point3::from(apple.center);
        let sphere = Sphere::new(center, apple.radius).unwrap();
        let foot = Point3::from(branch.point);
        let along = nalgebra::Vector3::from(branch.direction) * 0.15;
        let axis = Segment::new(foot - along, foot + along).unwrap();
        let joint = Segment::new(center, foot).unwrap();
        let points = body_points(&scene);
        assert!(points.len() > 1000);
        for p in points {
            // The unit of 0.1 mm rounds by half of it.
            let tolerance = 0.6e-4;
            let on_sphere = sphere.signed_distance(&p).abs() < tolerance;
            let on_branch = (axis.distance(&p) - branch.radius).abs() < tolerance;
            let on_joint = (joint.distance(&p) - 0.0015).abs() < tolerance;
            assert!(
                on_sphere || on_branch || on_joint,
                "{}: {p}",
                orientation.name()
            );
        }
    }
}

#[test]
fn the_box_is_the_silhouette_to_a_pixel() {
    for orientation in [
        Orientation::PAPER[2],
        Orientation::PAPER[7],
        Orientation::PAPER[10],
    ] {
        let scene = lab(orientation);
        let apple = &scene.truth.apples[0];
        // A sphere on the optical axis shows a disc of radius f·r/√(z² − r²).
        let disc = 540.0 * apple.radius / (0.64 - apple.radius.powi(2)).sqrt();
        let b = &apple.bounds;
        for (edge, expected) in [
            (b.x_min, 319.5 - disc),
            (b.x_max - 1.0, 319.5 + disc),
            (b.y_max - 1.0, 239.5 + disc),
        ] {
            assert!((edge - expected).abs() <= 1.0, "{edge} against {expected}");
        }
    }
}

#[test]
fn what_shows_is_counted() {
    let in_front = &lab(Orientation::PAPER[4]).truth.apples[0];
    let behind = &lab(Orientation::PAPER[0]).truth.apples[0];
    let above = &lab(Orientation::PAPER[2]).truth.apples[0];
    assert!(in_front.visible_share.unwrap() < 0.95);
    assert_eq!(above.visible_share, Some(1.0));
    // The shell of 3 r holds 2·√((3 r)² − d²) of a line that passes at distance d.
    let chord = 2.0 * (9.0 * 0.025_78f64.powi(2) - 0.033_28f64.powi(2)).sqrt();
    let length = |a: &pomona_scenes::AppleTruth| a.branch.as_ref().unwrap().visible_length.unwrap();
    // Two slices of 2 mm at either end, and the surface is nearer than the axis.
    assert!(
        (length(above) - chord).abs() < 0.008,
        "{} against {chord}",
        length(above)
    );
    // Behind the apple its shadow on the branch, about its diameter, is missing.
    let hidden = chord - 2.0 * 0.025_78;
    assert!(
        (length(behind) - hidden).abs() < 0.012,
        "{} against {hidden}",
        length(behind)
    );
}

#[test]
fn colour_and_depth_show_the_same_silhouette() {
    let mut world = pomona_scenes::World::new(pomona_scenes::Light::default());
    let sky = Shot::new("sky", half_size(), Sensor::perfect(), 0)
        .take(&world)
        .frame
        .color;
    world.add_apple(pomona_scenes::Apple::sphere(
        Point3::new(0.02, 0.01, 0.7),
        0.04,
    ));
    let frame = Shot::new("apple", half_size(), Sensor::perfect(), 0)
        .take(&world)
        .frame;
    let mut inside = 0;
    for y in 1..frame.color.height - 1 {
        for x in 1..frame.color.width - 1 {
            let around = [
                (0, 0),
                (1, 0),
                (2, 0),
                (0, 1),
                (1, 1),
                (2, 1),
                (0, 2),
                (1, 2),
                (2, 2),
            ];
            let readings = around
                .iter()
                .filter(|(dx, dy)| frame.depth.get(x + dx - 1, y + dy - 1) > Some(0))
                .count();
            let is_sky = frame.color.get(x, y) == sky.get(x, y);
            // Pixels on the edge itself mix both colours.
            match readings {
                0 => assert!(is_sky, "({x}, {y})"),
                9 => {
                    assert!(!is_sky, "({x}, {y})");
                    inside += 1;
                }
                _ => {}
            }
        }
    }
    assert!(inside > 2000);
}
