//! What the program writes holds to the schemas in `docs/`.

use crate::binary::pomona;
use crate::scene::{Bench, frame};
use boon::{Compiler, Draft, SchemaIndex, Schemas};
use pomona::record::PicksRecord;
use pomona::{CheckedFrame, Config, Mark, Picker, find_apples};
use pomona_cloud::ColorImage;
use pomona_detect::{DetectError, Detection, Detector, DetectorReport};
use serde_json::{Value, json};
use std::path::Path;

pub(crate) struct Schema {
    compiled: Schemas,
    index: SchemaIndex,
}

impl Schema {
    pub(crate) fn read(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../docs")
            .join(name);
        let schema: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
        let mut compiled = Schemas::new();
        let mut compiler = Compiler::new();
        compiler.set_default_draft(Draft::V2020_12);
        compiler.add_resource(name, schema).unwrap();
        // What is no schema by its draft is refused here.
        let index = compiler
            .compile(name, &mut compiled)
            .unwrap_or_else(|e| panic!("{name}: {e:#}"));
        Self { compiled, index }
    }

    #[track_caller]
    pub(crate) fn accepts(&self, value: &Value) {
        if let Err(errors) = self.compiled.validate(value, self.index) {
            panic!("{errors}");
        }
    }

    /// Checks that `value` is refused with one of its places changed.
    #[track_caller]
    pub(crate) fn refuses(&self, value: &Value, place: &str, new: Option<Value>) {
        let mut changed = value.clone();
        let (parent, name) = place.rsplit_once('/').unwrap();
        let parent = changed
            .pointer_mut(parent)
            .unwrap()
            .as_object_mut()
            .unwrap();
        match new {
            Some(new) => parent.insert(name.to_owned(), new),
            None => parent.remove(name),
        };
        let checked = self.compiled.validate(&changed, self.index);
        assert!(checked.is_err(), "{place}");
    }
}

#[test]
fn picks() {
    let bench = Bench::new();
    bench.write(
        "t.json",
        r#"{"schema": "pomona.transform/1", "to": "base", "from": "camera_color_optical_frame",
            "translation_m": [0, 0, 0.5], "quaternion_xyzw": [-0.5, 0.5, -0.5, 0.5]}"#,
    );
    let schema = Schema::read("picks.schema.json");
    let frame = bench.text("a");
    pomona(&["pick", &frame, "--out", &bench.text("out")]).succeeded();
    schema.accepts(&bench.read_json("out/picks.json"));
    let transform = ["--transform", &bench.text("t.json")];
    pomona(
        &[
            &["pick", &frame, "--out", &bench.text("robot")],
            &transform[..],
        ]
        .concat(),
    )
    .succeeded();
    let picks = bench.read_json("robot/picks.json");
    schema.accepts(&picks);

    bench.write("r.toml", "[clearance]\ncloud_margin_m = -0.05\n");
    let robot = ["--robot", &bench.text("r.toml")];
    let out = ["pick", &frame, "--out", &bench.text("planned")];
    pomona(&[&out, &transform[..], &robot[..]].concat()).succeeded();
    let planned = bench.read_json("planned/picks.json");
    schema.accepts(&planned);
    assert_eq!(planned["picks"][0]["approach"]["status"], "free");
    for place in ["gripper", "approach", "clearance", "order"] {
        schema.refuses(&planned, &format!("/picks/0/{place}/extra"), Some(json!(1)));
    }
    schema.refuses(&planned, "/picks/0/approach", None);
    schema.refuses(&planned, "/picks/0/approach/path", None);
    schema.refuses(
        &planned,
        "/picks/0/approach/status",
        Some(json!("collision")),
    );
    bench.write("r.toml", "[gripper]\njaw_width_m = 0.03\n");
    pomona(&[&out, &transform[..], &robot[..]].concat()).succeeded();
    let refused = bench.read_json("planned/picks.json");
    schema.accepts(&refused);
    assert_eq!(
        refused["picks"][0]["approach"]["status"],
        "gripper_too_small"
    );

    schema.refuses(&picks, "/schema", Some(json!("pomona.picks/2")));
    schema.refuses(&picks, "/extra", Some(json!(1)));
    schema.refuses(&picks, "/seed", None);
    for place in [
        "/picks/0/extra",
        "/picks/0/apple/extra",
        "/picks/0/robot/extra",
        "/frame/extra",
    ] {
        schema.refuses(&picks, place, Some(json!(1)));
    }
    schema.refuses(&picks, "/picks/0/direction", None);
    schema.refuses(&picks, "/picks/0/status", Some(json!("no_branch")));
    schema.refuses(&picks, "/picks/1/status", Some(json!("picked")));
    schema.refuses(&picks, "/picks/0/direction", Some(json!([0, 0])));
    schema.refuses(&picks, "/picks/0/direction", Some(json!([0, 0, 2])));
}

/// Finds the same boxes in every image.
struct FixedDetector {
    detections: Vec<Detection>,
}

impl Detector for FixedDetector {
    fn detect(&self, _: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        Ok(self.detections.clone())
    }

    fn report(&self) -> DetectorReport {
        DetectorReport::new("fixed")
    }
}

#[test]
fn picks_of_detected_boxes() {
    let schema = Schema::read("picks.schema.json");
    let frame = frame("a");
    let detections = frame.boxes.iter().flatten().map(|b| Detection {
        x_min: b.x_min,
        y_min: b.y_min,
        x_max: b.x_max,
        y_max: b.y_max,
        score: b.score,
        class: 0,
    });
    let detector = FixedDetector {
        detections: detections.collect(),
    };
    let mut config = Config::default();
    config.detection.depth_search = true;
    let frame = CheckedFrame::new(&frame).unwrap();
    let found = find_apples(&frame, &detector, &config).unwrap();
    let picker = Picker::new(config).unwrap();
    let answer = picker.pick_detected(&frame, &found, 0, None).unwrap();
    let picks = serde_json::to_value(PicksRecord::from(&answer)).unwrap();
    schema.accepts(&picks);
    assert_eq!(picks["picks"][0]["box"]["mark"], "plausible");
    for mark in Mark::ALL {
        let mut marked = picks.clone();
        marked["picks"][0]["box"]["mark"] = json!(mark.name());
        schema.accepts(&marked);
    }
    schema.refuses(&picks, "/picks/0/box/mark", Some(json!("round")));
    schema.refuses(&picks, "/picks/0/box/mark", None);
    schema.refuses(&picks, "/picks/0/box/merged", Some(json!(1)));
    schema.refuses(&picks, "/detection/extra", Some(json!(1)));
    schema.refuses(&picks, "/detection/name", None);
    schema.refuses(&picks, "/detection/timing_ms/total", None);
    let mut implausible = picks;
    for field in ["direction", "foot", "branch", "apple"] {
        let pick = implausible["picks"][0].as_object_mut().unwrap();
        pick.remove(field);
    }
    implausible["picks"][0]["status"] = json!("implausible");
    schema.accepts(&implausible);
}

#[test]
fn truth() {
    let bench = Bench::new();
    let schema = Schema::read("truth.schema.json");
    pomona(&[
        "scenes",
        "lab15",
        "--count",
        "1",
        "--out",
        &bench.text("out"),
    ])
    .succeeded();
    let truth = bench.read_json("out/lab-x-90-s0/truth.json");
    schema.accepts(&truth);
    // A camera that is not the one stated brings in all optional fields.
    let mut all = truth.clone();
    all["camera"] = bench.read_json("a/camera.json");
    schema.accepts(&all);
    schema.refuses(&truth, "/extra", Some(json!(1)));
    schema.refuses(&truth, "/apples/0/extra", Some(json!(1)));
    schema.refuses(&truth, "/apples/0/branch/extra", Some(json!(1)));
    schema.refuses(&truth, "/apples/0/center", None);
    schema.refuses(&truth, "/apples/0/radius", Some(json!(0)));
}

#[test]
fn fused_frames_and_fallbacks() {
    let bench = crate::fuse::bench();
    let (left, right, out) = (bench.text("left"), bench.text("right"), bench.text("out"));
    let run = ["pick", &left, &right, "--fuse", "--out", &out];
    let refuse_all = [
        "--set",
        "robust.least_confidence=1",
        "--set",
        "fallback.kind=\"surface_normal\"",
        "--method",
        "robust",
    ];
    let schema = Schema::read("fused.schema.json");
    pomona(&run).succeeded();
    let fused = bench.read_json("out/fused.json");
    schema.accepts(&fused);
    schema.refuses(&fused, "/apples/0/extra", Some(json!(1)));
    schema.refuses(&fused, "/apples/0/direction", None);
    schema.refuses(
        &fused,
        "/apples/0/sightings/0/place",
        Some(json!("somewhere")),
    );
    pomona(&[&run[..], &refuse_all[..]].concat()).succeeded();
    let refused = bench.read_json("out/fused.json");
    assert_eq!(refused["apples"][0]["status"], "no_direction");
    schema.accepts(&refused);
    let picks = bench.read_json("out/left/picks.json");
    let schema = Schema::read("picks.schema.json");
    schema.accepts(&picks);
    assert_eq!(
        picks["picks"][0]["fallback"]["direction_source"],
        "surface_normal"
    );
    schema.refuses(&picks, "/picks/0/status", Some(json!("picked")));
    schema.refuses(
        &picks,
        "/picks/0/fallback/direction_source",
        Some(json!("branch")),
    );
}
