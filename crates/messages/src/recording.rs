//! A frame and its plan as an MCAP file, for Foxglove and whatever else reads its schemas.
//!
//! Messages are JSON, each channel with the JSON Schema of its message under Foxglove's well-known
//! name:
//!
//! | topic | schema | content |
//! |---|---|---|
//! | `/tf` | `foxglove.FrameTransform` | the camera in the robot's frame; each pick's tool over time |
//! | `/cloud` | `foxglove.PointCloud` | the frame's points with their colours, in the camera's frame |
//! | `/scene` | `foxglove.SceneUpdate` | apples, boxes about them, branches, paths, grippers |
//! | `/grasps` | `foxglove.PosesInFrame` | the wrist at the apples, in the picking order |
//!
//! Times begin at 0; the tools move along their paths, one pick after the other in the picking order.

mod content;
mod foxglove;

use crate::order::ranked;
use foxglove::{FrameTransform, PointCloud, PosesInFrame, SceneUpdate, Time};
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use pomona::{CheckedFrame, Robot, RobotFromCamera, RobotPlan};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::marker::PhantomData;
use thiserror::Error;

/// Why there is no recording.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The writer refused.
    #[error("the recording cannot be written: {0}")]
    Mcap(#[from] mcap::McapError),
    /// A message cannot be written as JSON.
    #[error("a message of the recording cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

/// Messages `T` of one topic.
struct Topic<'a, T> {
    writer: &'a mut Writer<Cursor<Vec<u8>>>,
    channel: u16,
    sequence: u32,
    message: PhantomData<T>,
}

impl<'a, T: Serialize + JsonSchema> Topic<'a, T> {
    fn new(writer: &'a mut Writer<Cursor<Vec<u8>>>, topic: &str) -> Result<Self, RecordingError> {
        let text = serde_json::to_vec(&foxglove::schema::<T>())?;
        let schema = writer.add_schema(&T::schema_name(), "jsonschema", &text)?;
        let channel = writer.add_channel(schema, topic, "json", &BTreeMap::new())?;
        Ok(Self {
            writer,
            channel,
            sequence: 0,
            message: PhantomData,
        })
    }

    fn write(&mut self, time: Time, message: &T) -> Result<(), RecordingError> {
        let header = MessageHeader {
            channel_id: self.channel,
            sequence: self.sequence,
            log_time: time.nanoseconds(),
            publish_time: time.nanoseconds(),
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
/// [`RecordingError`]: neither variant is known to occur, since everything is written to memory.
pub fn record(
    frame: &CheckedFrame<'_>,
    plan: &RobotPlan,
    robot: &Robot,
    robot_from_camera: &RobotFromCamera,
) -> Result<Vec<u8>, RecordingError> {
    let options = WriteOptions::new().compression(None).library("pomona");
    let mut writer = options.create(Cursor::new(Vec::new()))?;

    let mut cloud = Topic::<PointCloud>::new(&mut writer, "/cloud")?;
    cloud.write(Time::default(), &content::cloud(frame))?;

    let camera_id = &frame.frame().camera.frame_id;
    let camera = robot_from_camera.transform.isometry();
    let mut tf = Topic::<FrameTransform>::new(&mut writer, "/tf")?;
    let transform = content::frame_transform(Time::default(), &plan.frame_id, camera_id, &camera);
    tf.write(transform.timestamp, &transform)?;
    let mut begin_s = 0.0;
    for (id, approach) in ranked(plan) {
        let tool = content::tool_frame(id);
        for sample in approach.path.samples(robot.config().motion.samples) {
            let time = Time::from_seconds(begin_s + sample.time_s);
            let transform = content::frame_transform(time, &plan.frame_id, &tool, &sample.pose());
            tf.write(time, &transform)?;
        }
        begin_s += approach.path.duration_s();
    }

    let mut scene = Topic::<SceneUpdate>::new(&mut writer, "/scene")?;
    scene.write(Time::default(), &content::scene(plan, robot))?;
    let mut grasps = Topic::<PosesInFrame>::new(&mut writer, "/grasps")?;
    grasps.write(Time::default(), &content::grasps(plan, robot))?;
    writer.finish()?;
    Ok(writer.into_inner().into_inner())
}
