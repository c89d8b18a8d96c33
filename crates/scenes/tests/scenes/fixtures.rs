//! The frames in the repository's `fixtures` are those that the suites give.
//!
//! On the platform that wrote them they are the same to the last bit. Elsewhere sines and exponentials may round the last
//! bit in another way: there numbers are held to 1e-9, and few pixels may be rounded to the other side.

use pomona_cloud::Frame;
use pomona_scenes::{Scene, Suite, Truth};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Whether this is the platform that wrote the fixtures.
const IS_REFERENCE: bool = cfg!(all(
    target_os = "linux",
    target_env = "gnu",
    target_arch = "x86_64"
));

/// Largest difference of two numbers of a truth, in metres or without a unit.
const TOLERANCE: f64 = if IS_REFERENCE { 0.0 } else { 1e-9 };

/// Share of the pixels that another rounding may change.
const ROUNDED_SHARE: f64 = if IS_REFERENCE { 0.0 } else { 1e-3 };

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures/frames")
        .join(name)
}

/// Holds two values to each other, and says at which place they differ.
fn assert_close(found: &Value, expected: &Value, place: &str) {
    match (found, expected) {
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            assert!((a - b).abs() <= TOLERANCE, "{place}: {a} and {b}");
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                assert_close(a, b, &format!("{place}/{i}"));
            }
        }
        (Value::Object(a), Value::Object(b)) if a.len() == b.len() => {
            for (key, a) in a {
                assert_close(a, &b[key], &format!("{place}/{key}"));
            }
        }
        (a, b) => assert_eq!(a, b, "{place}"),
    }
}

fn assert_same_pixels<T: PartialEq>(found: &[T], expected: &[T], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let different = found.iter().zip(expected).filter(|(a, b)| a != b).count();
    let allowed = (ROUNDED_SHARE * found.len() as f64) as usize;
    assert!(different <= allowed, "{what}: {different} pixels differ");
}

/// Holds a folder to a scene; boxes only where the folder has them.
fn assert_is(name: &str, scene: &Scene) {
    let folder = fixture(name);
    let json = |truth: &Truth| serde_json::to_value(truth).unwrap();
    let truth = Truth::read(&folder).unwrap();
    assert_close(&json(&truth), &json(&scene.truth), name);
    let frame = Frame::read(&folder).unwrap();
    assert_eq!(frame.camera, scene.frame.camera);
    if frame.boxes.is_some() {
        assert_eq!(frame.boxes, scene.frame.boxes);
    }
    assert_same_pixels(&frame.depth.readings, &scene.frame.depth.readings, "depth");
    assert_same_pixels(&frame.color.pixels, &scene.frame.color.pixels, "colour");
}

#[test]
fn the_demo_is_what_the_suite_gives() {
    let scene = Suite::Demo.scenes().next().unwrap();
    assert_is("orchard-demo", &scene);
}

/// Of `pomona scenes row --seed 32 --count 1`, with the boxes taken out.
#[test]
fn the_row_is_what_the_suite_gives() {
    let case = Suite::Row.cases_to(33).nth(32).unwrap();
    assert_is("row-demo", &case.scene());
}
