//! What the program assumes about its input: said on standard error, in the record, and by `inspect`.

use crate::binary::{Run, pomona};
use crate::scene::Bench;
use serde_json::Value;

/// Picks frame `a` of `bench`, which must succeed; the run and the record.
#[track_caller]
fn pick(bench: &Bench) -> (Run, Value) {
    let (frame, out) = (bench.text("a"), bench.text("out"));
    let run = pomona(&[
        "pick",
        &frame,
        "--no-picture",
        "--clouds",
        "none",
        "--out",
        &out,
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    (run, bench.read_json("out/picks.json"))
}

#[test]
fn an_assumption_is_on_standard_error_in_the_record_and_in_inspect() {
    let bench = Bench::new();
    let (run, silent) = pick(&bench);
    assert_eq!((&*run.err, silent.get("warnings")), ("", None));

    let mut camera = bench.read_json("a/camera.json");
    camera.as_object_mut().unwrap().remove("frame_id");
    bench.write("a/camera.json", camera.to_string());
    let (run, record) = pick(&bench);
    let warning = &record["warnings"][0];
    assert_eq!(
        (&warning["code"], &warning["level"]),
        (&"frame_id_assumed".into(), &"note".into())
    );
    let message = warning["message"].as_str().unwrap();
    assert!(
        message.starts_with("camera.json: no `frame_id`"),
        "{message}"
    );
    assert_eq!(run.err, format!("note: a: {message} [frame_id_assumed]\n"));

    let inspected = pomona(&["inspect", &bench.text("a"), "--json"])
        .succeeded()
        .json();
    assert_eq!(inspected["warnings"], record["warnings"]);
    let inspected = pomona(&["inspect", &bench.text("a/camera.json")]).succeeded();
    assert!(
        inspected.out.contains("note: camera.json: no `frame_id`"),
        "{}",
        inspected.out
    );
}
