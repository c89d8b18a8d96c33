//! What the suite `dense` promises: depth, foliage and wood as about the apples of real frames.

use pomona_scenes::{Scene, SceneClass, Suite};
use std::sync::LazyLock;

/// Seeds beyond the suite's own.
static SCENES: LazyLock<Vec<Scene>> = LazyLock::new(|| {
    Suite::Dense
        .cases_to(1006)
        .skip(1000)
        .map(|c| c.scene())
        .collect()
});

/// Pixels within three radii of the boxed apples: how many there are, have a reading, are wood, are fruit, are both wood
/// and read.
fn about_apples() -> [f64; 5] {
    let mut counts = [0.0; 5];
    for scene in SCENES.iter() {
        let (width, depth) = (scene.frame.depth.width, &scene.frame.depth.readings);
        let classes = &scene.classes.as_ref().unwrap().values;
        for apple in &scene.truth.apples {
            let b = &apple.bounds;
            let (x, y) = (0.5 * (b.x_min + b.x_max), 0.5 * (b.y_min + b.y_max));
            let reach = 0.75 * (b.width() + b.height());
            for pixel in 0..depth.len() {
                let (u, v) = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
                if (u - x).hypot(v - y) > reach {
                    continue;
                }
                let is = |class: SceneClass| classes[pixel] == class as u8;
                let (read, wood) = (depth[pixel] > 0, is(SceneClass::Wood));
                let hits = [true, read, wood, is(SceneClass::Fruit), wood && read];
                for (count, hit) in counts.iter_mut().zip(hits) {
                    *count += f64::from(u8::from(hit));
                }
            }
        }
    }
    counts
}

#[test]
fn readings_foliage_and_wood_are_about_as_in_real_frames() {
    // On the real frames 62 % of these pixels have a reading, 59 % of the wood, 4 % are drawn wood and 25 % fruit; the
    // bounds leave room for six scenes. `orchard` has readings on all surfaces.
    let [all, read, wood, fruit, wood_read] = about_apples();
    let within = |share: f64, low: f64, high: f64, what: &str| {
        assert!((low..=high).contains(&share), "{what}: {share}");
    };
    within(read / all, 0.40, 0.75, "readings");
    within(wood / all, 0.02, 0.10, "wood");
    within(fruit / all, 0.12, 0.35, "fruit");
    within(wood_read / wood, 0.35, 0.80, "readings on wood");
}

#[test]
fn apples_are_boxed_that_a_person_would_box() {
    for scene in SCENES.iter() {
        let drawn = scene.frame.boxes.as_ref().unwrap();
        assert!(!drawn.is_empty(), "{}", scene.frame.id);
        for (apple, drawn) in scene.truth.apples.iter().zip(drawn) {
            assert!(apple.visible_share.unwrap() >= 0.6, "{}", scene.frame.id);
            // Two standard deviations of 1.3 pixels.
            let error = (drawn.x_min - apple.bounds.x_min).abs();
            assert!(error <= 2.6 + 1e-9, "{}: {error}", scene.frame.id);
        }
    }
}

#[test]
fn the_wood_that_is_said_to_show_shows() {
    for scene in SCENES.iter() {
        let classes = scene.classes.as_ref().unwrap();
        let stretches = scene.wood.as_ref().unwrap();
        assert!(!stretches.is_empty(), "{}", scene.frame.id);
        let (mut on, mut all) = (0, 0);
        for [x, y, _] in stretches.iter().flat_map(|s| &s.points) {
            let inside = *x >= 0.0 && *y >= 0.0;
            let (u, v) = (*x as usize, *y as usize);
            if !inside || u >= classes.width || v >= classes.height {
                continue;
            }
            all += 1;
            on += usize::from(classes.values[v * classes.width + u] == SceneClass::Wood as u8);
        }
        // Ends of stretches lie where something begins to cover the limb.
        assert!(10 * on >= 7 * all, "{}: {on} of {all}", scene.frame.id);
    }
}

#[test]
fn one_thread_gives_the_bytes_of_many() {
    let case = Suite::Dense.cases_to(1001).last().unwrap();
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    assert_eq!(one.install(|| case.scene()), SCENES[0]);
}
