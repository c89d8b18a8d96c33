//! A scene on disk, and the bytes of a scene.

use pomona_cloud::Frame;
use pomona_scenes::{Lab, Orientation, Scene, SceneError, Sensor, Shot, Suite, TRUTH_FILE, Truth};

fn small_scene(seed: u64) -> Scene {
    let camera = Shot::paper_camera().with_intrinsics([160, 120], [135.0; 2], [79.5, 59.5]);
    let world = Lab::default().world(Orientation::PAPER[3]);
    Shot::new("small", camera, Sensor::paper(), seed).take(&world)
}

#[test]
fn a_written_scene_is_read_back_whole() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("small");
    let scene = small_scene(0);
    scene.write(&folder).unwrap();
    let frame = Frame::read(&folder).unwrap();
    assert_eq!(frame.color, scene.frame.color);
    assert_eq!(frame.depth, scene.frame.depth);
    assert_eq!(frame.camera, scene.frame.camera);
    assert_eq!(Truth::read(&folder).unwrap(), scene.truth);
    // Nothing else was left behind.
    assert_eq!(std::fs::read_dir(root.path()).unwrap().count(), 1);
}

#[test]
fn a_scene_replaces_a_scene_and_nothing_else() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("small");
    small_scene(0).write(&folder).unwrap();
    small_scene(1).write(&folder).unwrap();
    assert_eq!(Truth::read(&folder).unwrap().seed, Some(1));

    std::fs::write(folder.join("notes.txt"), "mine").unwrap();
    let refused = small_scene(2).write(&folder);
    assert!(matches!(refused, Err(SceneError::Occupied { path }) if path.ends_with("notes.txt")));
    assert!(folder.join("notes.txt").is_file());
    std::fs::remove_file(folder.join("notes.txt")).unwrap();

    std::fs::remove_file(folder.join(TRUTH_FILE)).unwrap();
    let refused = small_scene(2).write(&folder);
    assert!(matches!(refused, Err(SceneError::Occupied { .. })));
    assert!(folder.join("depth.png").is_file());

    let file = root.path().join("file");
    std::fs::write(&file, "not a folder").unwrap();
    assert!(matches!(
        small_scene(3).write(&file),
        Err(SceneError::File(_))
    ));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "not a folder");
}

#[test]
fn the_bytes_depend_on_the_seed_and_not_on_the_threads() {
    let with = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| small_scene(seed))
    };
    assert_eq!(with(1, 4), with(2, 4));
    assert_eq!(with(1, 4), with(3, 4));
    assert_ne!(with(1, 4).frame.depth, with(1, 5).frame.depth);
}

#[test]
fn suites_are_found_by_name() {
    for suite in Suite::ALL {
        assert_eq!(Suite::named(suite.name()).unwrap(), *suite);
        assert_eq!(suite.cases().len(), suite.len());
        let mut names: Vec<_> = suite.cases().map(|c| c.name).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), suite.len());
    }
    let error = Suite::named("lab16").unwrap_err().to_string();
    assert!(
        error.contains("lab16") && error.contains("lab15"),
        "{error}"
    );
}
