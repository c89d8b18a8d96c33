use crate::binary::pomona;
use crate::scene::Bench;
use crate::schema::Schema;
use serde_json::json;
use std::path::{Path, PathBuf};

#[test]
fn printed_settings_change_nothing() {
    let bench = Bench::new();
    let printed = pomona(&["config"]).succeeded().out;
    bench.write("pomona.toml", &printed);
    let config = bench.text("pomona.toml");
    assert_eq!(
        pomona(&["config", "--config", &config]).succeeded().out,
        printed
    );
    for part in [
        "method = \"robust\"",
        "[paper]",
        "[robust]",
        "radius_max_m = 0.05",
        "Unit: metres",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
}

#[test]
fn printed_settings_of_a_robot_change_nothing() {
    let printed = pomona(&["config", "--robot"]).succeeded().out;
    let read: pomona::ApproachConfig = pomona_settings::parse(&printed, "robot.toml").unwrap();
    assert_eq!(read, pomona::ApproachConfig::default());
    assert!(printed.contains("\n# start_m = [0.3, 0.0, 0.5]\n"));
}

#[test]
fn flags_win_over_the_file() {
    let bench = Bench::new();
    bench.write(
        "pomona.toml",
        "[fruit]\nradius_max_m = 0.06\n[paper]\nline_iterations = 7\n",
    );
    let config = bench.text("pomona.toml");
    let flags = [
        "config",
        "--config",
        &config,
        "--radius-max-mm",
        "70",
        "--set",
        "paper.shell_outer=2",
    ];
    let out = pomona(&flags).succeeded().out;
    for part in [
        "radius_max_m = 0.07",
        "line_iterations = 7",
        "shell_outer = 2.0",
        "default 3000",
    ] {
        assert!(out.contains(part), "{part}: {out}");
    }
}

#[test]
fn settings_reach_the_method() {
    let bench = Bench::new();
    let run = |radius: &str| {
        let out = bench.text("out");
        let arguments = [
            "pick",
            &bench.text("a"),
            "--json",
            "--out",
            &out,
            "--radius-min-mm",
            radius,
        ];
        pomona(&arguments).succeeded().json()["picks"][0]["status"].clone()
    };
    assert_eq!(run("20"), "picked");
    assert_ne!(run("45"), "picked");
}

/// `evaluate` takes settings as `pick` does: what no confidence reaches is refused there too.
#[test]
fn settings_reach_the_evaluation() {
    let bench = Bench::new();
    bench.write("never.toml", "[robust]\nleast_confidence = 1.0\n");
    let (out, file) = (bench.text("evaluated"), bench.text("never.toml"));
    let base = ["evaluate", "lab15", "--count", "1", "--json", "--out", &out];
    let picked = |flags: &[&str]| {
        let result = pomona(&[&base[..], flags].concat()).succeeded().json();
        result["results"][0]["answered"]["count"].clone()
    };
    assert_eq!(picked(&[]), 1);
    assert_eq!(picked(&["--set", "robust.least_confidence=1"]), 0);
    assert_eq!(picked(&["--config", &file]), 0);
    // A flag wins over the file, and a method over that of the settings.
    let flag = ["--config", &file, "--set", "robust.least_confidence=0"];
    assert_eq!(picked(&flag), 1);
    assert_eq!(picked(&["--config", &file, "--method", "paper"]), 1);
    // The apple's radius is 25.78 mm.
    assert_eq!(picked(&["--radius-min-mm", "45"]), 0);
}

#[test]
fn wrong_settings_of_an_evaluation_are_refused() {
    let bench = Bench::new();
    let out = bench.text("evaluated");
    let base = ["evaluate", "lab15", "--count", "1", "--out", &out];
    for (flag, value, word) in [
        (
            "--set",
            "robust.least_confidenc=1",
            "did you mean `robust.least_confidence`",
        ),
        (
            "--set",
            "robust.least_confidence=2",
            "robust.least_confidence",
        ),
        ("--set", "robust.least_confidence", "NAME=VALUE"),
        ("--radius-max-mm", "1", "fruit.radius_max_m"),
        ("--config", "gone.toml", "gone.toml"),
    ] {
        pomona(&[&base[..], &[flag, value]].concat()).refused(&[word]);
        assert!(!Path::new(&out).exists(), "{flag} {value}");
    }
}

fn docs(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs")
        .join(name)
}

/// `pomona config --format json-schema > docs/settings.schema.json` brings a file up to date.
#[test]
fn the_schemas_in_the_docs_are_those_of_the_declarations() {
    let robot = &["--robot"][..];
    for (name, flags) in [
        ("settings.schema.json", &[][..]),
        ("robot.schema.json", robot),
    ] {
        let printed = pomona(&[&["config", "--format", "json-schema"], flags].concat());
        let printed = printed.succeeded().out;
        let written = std::fs::read_to_string(docs(name)).unwrap();
        assert!(printed == written, "docs/{name} is out of date");
    }
}

#[test]
fn the_schema_accepts_what_is_read_and_refuses_the_rest() {
    let schema = Schema::read("settings.schema.json");
    let defaults = serde_json::to_value(pomona::Config::default().with(|c| {
        c.robust.noise_m = Some([0.001, 0.0, 0.0]);
        c.robust.radius_mean_m = Some(0.04);
        c.robust.radius_sd_m = Some(0.01);
        c.robust.box_radius_sd_m = Some(0.001);
        c.robust.rim_share = Some(0.1);
        c.robust.contour_sd_px = Some(0.7);
        c.robust.shape_sd_m = Some(0.0003);
    }))
    .unwrap();
    schema.accepts(&defaults);
    schema.accepts(&json!({}));
    for (place, new) in [
        ("/method", json!("magic")),
        ("/papr", json!({})),
        ("/paper/sphere_band", json!(1.0)),
        ("/paper/sphere_iterations", json!(0)),
        ("/paper/sphere_iterations", json!(1.5)),
        ("/robust/noise_m", json!([0.001, 0.0])),
        ("/robust/radius_max_m", json!(0.05)),
        ("/detection/depth_check", json!(1)),
    ] {
        schema.refuses(&defaults, place, Some(new));
    }
}

#[test]
fn tables_explain_every_setting() {
    for (flags, part) in [
        (&[][..], "| `radius_max_m` | `0.05` | metres |"),
        (&["--robot"], "| `jaw_width_m` | `0.1` | metres |"),
    ] {
        let out = pomona(&[&["config", "--format", "markdown"], flags].concat());
        let out = out.succeeded().out;
        assert!(out.contains(part), "{out}");
    }
}
