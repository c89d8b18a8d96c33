//! The recording, read back by this implementation of MCAP and by another.

use crate::lab::{config, lab, planned, transform};
use pomona::{CheckedFrame, Robot};
use pomona_messages::recording;
use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Command;

/// The recording of a lab frame, and the number of its depth readings.
fn bytes() -> (Vec<u8>, usize) {
    let (scene, config) = (lab(), config());
    let (_, plan) = planned(&scene, &config);
    let robot = Robot::new(config).unwrap();
    let readings = scene
        .frame
        .depth
        .readings
        .iter()
        .filter(|r| **r > 0)
        .count();
    let frame = CheckedFrame::new(&scene.frame).unwrap();
    let bytes = recording::record(&frame, &plan, &robot, &transform()).unwrap();
    (bytes, readings)
}

/// Does a value have what its schema requires, of the types that it names?
fn holds(schema: &Value, value: &Value, place: &str) {
    match schema["type"].as_str().unwrap() {
        "object" => {
            for name in schema["required"].as_array().into_iter().flatten() {
                let name = name.as_str().unwrap();
                let field = value
                    .get(name)
                    .unwrap_or_else(|| panic!("{place}: no {name}"));
                holds(
                    &schema["properties"][name],
                    field,
                    &format!("{place}/{name}"),
                );
            }
            let known = schema["properties"]
                .as_object()
                .map_or(0, serde_json::Map::len);
            assert!(
                known == 0 || value.as_object().unwrap().len() == known,
                "{place}"
            );
        }
        "array" => {
            for value in value.as_array().unwrap() {
                holds(&schema["items"], value, place);
            }
        }
        "number" => assert!(value.is_number(), "{place}"),
        "integer" => assert!(value.is_u64(), "{place}"),
        "string" => assert!(value.is_string(), "{place}"),
        "boolean" => assert!(value.is_boolean(), "{place}"),
        other => panic!("{place}: {other}"),
    }
}

#[test]
fn messages_hold_to_the_schemas_beside_them() {
    let (bytes, readings) = bytes();
    let mut counts = BTreeMap::new();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let schema = message.channel.schema.as_ref().unwrap();
        assert_eq!(
            (
                schema.encoding.as_str(),
                message.channel.message_encoding.as_str()
            ),
            ("jsonschema", "json")
        );
        let definition: Value = serde_json::from_slice(&schema.data).unwrap();
        assert_eq!(definition["title"], schema.name.as_str());
        let value: Value = serde_json::from_slice(&message.data).unwrap();
        holds(&definition, &value, &message.channel.topic);
        if message.channel.topic == "/cloud" {
            let length = value["data"].as_str().unwrap().len();
            assert_eq!(length, (readings * 16).div_ceil(3) * 4);
        }
        *counts.entry(message.channel.topic.clone()).or_insert(0) += 1;
    }
    let wanted = [("/cloud", 1), ("/grasps", 1), ("/scene", 1), ("/tf", 42)];
    let wanted: BTreeMap<_, _> = wanted.map(|(t, n)| (t.to_owned(), n)).into();
    assert_eq!(counts, wanted);
}

const READER: &str = r#"
import base64, json, struct, sys
from mcap.reader import make_reader
topics = {}
with open(sys.argv[1], "rb") as stream:
    reader = make_reader(stream, validate_crcs=True)
    for schema, channel, message in reader.iter_messages():
        assert schema.encoding == "jsonschema" and channel.message_encoding == "json"
        json.loads(schema.data)
        content = json.loads(message.data)
        topics.setdefault(channel.topic, [schema.name, 0])[1] += 1
        if channel.topic == "/cloud":
            data = base64.b64decode(content["data"], validate=True)
            assert len(data) % content["point_stride"] == 0
            z = struct.unpack_from("<f", data, 8)[0]
            assert 0.1 < z < 10, z
    assert reader.get_summary().statistics.message_count == sum(n for _, n in topics.values())
print(json.dumps(topics, sort_keys=True))
"#;

#[test]
fn the_reader_of_pypi_reads_it_too() {
    let interpreter = std::env::var_os("PYTHON").unwrap_or_else(|| "python3".into());
    let python = |arguments: &[&str]| Command::new(&interpreter).args(arguments).output();
    if !python(&["-c", "import mcap.reader"]).is_ok_and(|o| o.status.success()) {
        println!(
            "skipped: {} has no package mcap (pip install mcap, or name another by PYTHON)",
            interpreter.display()
        );
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recording.mcap");
    std::fs::write(&path, bytes().0).unwrap();
    let output = python(&["-c", READER, path.to_str().unwrap()]).unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let topics: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(topics["/cloud"][0], "foxglove.PointCloud");
    assert_eq!(topics["/scene"][0], "foxglove.SceneUpdate");
    assert_eq!(topics["/grasps"][0], "foxglove.PosesInFrame");
    assert_eq!(
        topics["/tf"],
        serde_json::json!(["foxglove.FrameTransform", 42])
    );
}
