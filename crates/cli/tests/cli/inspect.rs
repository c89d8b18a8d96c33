use crate::binary::pomona;
use crate::scene::{Bench, scene};

#[test]
fn every_kind_of_file_is_known() {
    let bench = Bench::new();
    scene("s").write(bench.path("s")).unwrap();
    pomona(&["pick", &bench.text("a"), "--out", &bench.text("out")]).succeeded();
    pomona(&["convert", &bench.text("a"), &bench.text("a.pcd")]).succeeded();
    bench.write("c.xyz", "0 0 1\n0.5 0 1\n");
    let settings = pomona(&["config"]).succeeded();
    bench.write("pomona.toml", settings.out);
    bench.write(
        "t.json",
        r#"{"schema": "pomona.transform/1", "to": "base", "from": "camera",
            "translation_m": [0, 0, 0.5], "quaternion_xyzw": [0, 0, 0, 1]}"#,
    );
    for (name, kind, words) in [
        (
            "a",
            "RGB-D frame",
            &[
                "320 x 240",
                "540 x 540 px",
                "% of the pixels",
                "median",
                "boxes with depth    2",
            ][..],
        ),
        ("s", "RGB-D frame", &["truth", "1 apple"]),
        ("a/color.png", "colour image", &["320 x 240"]),
        (
            "a/depth.png",
            "depth image",
            &["320 x 240", "% of the pixels"],
        ),
        (
            "a/camera.json",
            "camera",
            &["540 x 540 px", "camera_color_optical_frame"],
        ),
        ("a/boxes.xml", "boxes", &["3", "px"]),
        (
            "s/truth.json",
            "truth of a synthetic frame",
            &["pomona.truth/1", "25.8 mm"],
        ),
        ("out", "picks of a frame", &["1 picked"]),
        (
            "out/picks.json",
            "picks of a frame",
            &["pomona.picks/1", "1 picked, 2 refused"],
        ),
        ("out/picture.png", "colour image", &["320 x 240"]),
        ("out/apple-0.ply", "point cloud", &["colours", "yes", "mm"]),
        (
            "a.pcd",
            "point cloud",
            &["76800", "320 x 240", "pixels without a reading"],
        ),
        ("c.xyz", "point cloud", &["2", "0.0 to 500.0 mm", "no"]),
        ("pomona.toml", "settings", &["all at their defaults"]),
        ("t.json", "transform", &["base", "0.0 0.0 500.0 mm"]),
    ] {
        let run = pomona(&["inspect", &bench.text(name)]).succeeded();
        let heading = format!("{}: {kind}\n", bench.text(name));
        let heading = if name == "out" {
            format!("picks.json: {kind}\n")
        } else {
            heading
        };
        assert!(run.out.contains(&heading), "{heading}{}", run.out);
        for word in words {
            assert!(run.out.contains(word), "no `{word}`: {}", run.out);
        }
        let json = pomona(&["inspect", "--json", &bench.text(name)])
            .succeeded()
            .json();
        assert_eq!(json["kind"], kind);
    }
}

#[test]
fn several_paths_make_one_array() {
    let bench = Bench::new();
    let (color, gone) = (bench.text("a/color.png"), bench.text("gone"));
    let json = pomona(&["inspect", &color, &bench.text("a"), "--json"])
        .succeeded()
        .json();
    assert_eq!(json[0]["size"], serde_json::json!([320, 240]));
    assert_eq!(json[1]["boxes"], 3);
    let run = pomona(&["inspect", &color, &gone]);
    assert_eq!(run.code, 2);
    assert!(run.out.contains("320 x 240"));
    assert!(
        run.err.contains("gone: cannot be read") && run.err.contains("1 of 2"),
        "{}",
        run.err
    );
}
