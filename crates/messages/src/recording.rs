//! A frame and its plan as an MCAP file, for Foxglove and whatever else reads its schemas.
//!
//! Messages are JSON, each channel with the JSON Schema of its message under Foxglove's well-known
//! name:
//!
//! | topic | schema | what |
//! |---|---|---|
//! | `/tf` | `foxglove.FrameTransform` | the camera in the robot's frame; each pick's tool over time |
//! | `/cloud` | `foxglove.PointCloud` | the frame's points with their colours, in the camera's frame |
//! | `/scene` | `foxglove.SceneUpdate` | apples, boxes about them, branches, paths, grippers |
//! | `/grasps` | `foxglove.PosesInFrame` | the wrist at the apples, in the order of picking |
//!
//! Times begin at 0, the tools move as their paths do, one pick after the other in their order.

mod messages;
mod schemas;

use crate::ros;
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use pomona::{CheckedFrame, Robot, RobotFromCamera, RobotPlan};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::Cursor;
use thiserror::Error;

/// Why there is no recording.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The writer refused.
    #[error("the recording cannot be written: {0}")]
    Mcap(#[from] mcap::McapError),
    /// A message is no JSON.
    #[error("a message of the recording cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

/// Messages of one topic.
struct Topic<'a> {
    writer: &'a mut Writer<Cursor<Vec<u8>>>,
    channel: u16,
    sequence: u32,
}

impl<'a> Topic<'a> {
    fn new(
        writer: &'a mut Writer<Cursor<Vec<u8>>>,
        topic: &str,
        schema: (&str, &Value),
    ) -> Result<Self, RecordingError> {
        let text = serde_json::to_vec(schema.1)?;
        let schema = writer.add_schema(schema.0, "jsonschema", &text)?;
        let channel = writer.add_channel(schema, topic, "json", &BTreeMap::new())?;
        Ok(Self {
            writer,
            channel,
            sequence: 0,
        })
    }

    fn write(&mut self, time_ns: u64, message: &Value) -> Result<(), RecordingError> {
        let header = MessageHeader {
            channel_id: self.channel,
            sequence: self.sequence,
            log_time: time_ns,
            publish_time: time_ns,
        };
        self.sequence += 1;
        let text = serde_json::to_vec(message)?;
        Ok(self.writer.write_to_known_channel(&header, &text)?)
    }
}

/// The bytes of an MCAP file, uncompressed and with an index.
///
/// # Errors
///
/// [`RecordingError`]; none occurs on a healthy machine.
pub fn record(
    frame: &CheckedFrame<'_>,
    plan: &RobotPlan,
    robot: &Robot,
    robot_from_camera: &RobotFromCamera,
) -> Result<Vec<u8>, RecordingError> {
    let options = WriteOptions::new().compression(None).library("pomona");
    let mut writer = options.create(Cursor::new(Vec::new()))?;

    let mut cloud = Topic::new(&mut writer, "/cloud", schemas::point_cloud())?;
    cloud.write(0, &messages::cloud(frame))?;

    let camera_id = &frame.frame().camera.frame_id;
    let camera = robot_from_camera.transform.isometry();
    let mut tf = Topic::new(&mut writer, "/tf", schemas::frame_transform())?;
    tf.write(
        0,
        &messages::frame_transform(0.0, &plan.frame_id, camera_id, &camera),
    )?;
    let mut begin = 0.0;
    for (id, approach) in ros::ranked(plan) {
        for sample in approach.path.samples(robot.config().motion.samples) {
            let time = begin + sample.time_s;
            let child = format!("tool_{id}");
            let message = messages::frame_transform(time, &plan.frame_id, &child, &sample.pose());
            tf.write(messages::nanoseconds(time), &message)?;
        }
        begin += approach.path.duration_s();
    }

    let mut scene = Topic::new(&mut writer, "/scene", schemas::scene_update())?;
    scene.write(0, &messages::scene(plan, robot))?;
    let mut grasps = Topic::new(&mut writer, "/grasps", schemas::poses_in_frame())?;
    grasps.write(0, &messages::grasps(plan, robot))?;
    writer.finish()?;
    Ok(writer.into_inner().into_inner())
}
