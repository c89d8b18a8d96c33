//! The files that `pomona pick` writes for a frame.

use crate::apple_cloud::{AppleClouds, CloudChoice};
use crate::output_folder::{OutputFolder, RecordFile, Staging};
use crate::picture::{self, RobotView};
use crate::terminal::Terminal;
use pomona::record::PicksRecord;
use pomona::{CheckedFrame, FrameAnswer, Robot, RobotFromCamera, RobotPlan};
use pomona_cloud::CloudFormat;
use pomona_messages::ros;
use std::path::Path;

/// The answers of one frame.
pub(crate) const PICKS: &str = "picks.json";
/// The picture of one frame.
const PICTURE: &str = "picture.png";
/// The recording of one frame; runs of builds without the feature remove it all the same.
const RECORDING: &str = "recording.mcap";

/// The name under which the cloud of an apple is written.
fn cloud_name(id: usize) -> String {
    format!("apple-{id}.ply")
}

/// What says that the files beside it are ours.
const RECORD: RecordFile<'static> = RecordFile {
    name: PICKS,
    schema: "pomona.picks/",
};

/// Claims the names of these files in `folder`.
pub(super) fn claim(folder: &Path) -> anyhow::Result<OutputFolder> {
    OutputFolder::claim(folder, &[RECORD], is_ours)
}

/// Removes the answers of an earlier run that stand in `folder` itself, where this one writes a folder for each frame.
pub(super) fn remove_earlier(folder: &Path) -> anyhow::Result<()> {
    OutputFolder::remove_earlier(folder, RECORD, is_ours)
}

/// Whether a run may have written a file of this name beside the answers.
fn is_ours(name: &str) -> bool {
    let is_cloud = |name: &str| {
        let id = name.strip_prefix("apple-")?.strip_suffix(".ply")?;
        id.parse::<usize>().ok()
    };
    let is_message = |name: &str| {
        let message = name
            .strip_prefix("ros-")
            .and_then(|n| n.strip_suffix(".yaml"));
        message.is_some_and(|n| !n.is_empty())
    };
    let is_fixed = [PICTURE, RECORDING].contains(&name);
    is_fixed || is_cloud(name).is_some() || is_message(name)
}

/// Which files are written beside the answers.
pub(super) struct FileChoice<'a> {
    pub(super) picture: bool,
    pub(super) clouds: &'a CloudChoice,
    pub(super) ros: bool,
    #[cfg(feature = "mcap")]
    pub(super) recording: bool,
}

/// A robot and what it plans for a frame.
pub(super) struct RobotOutput<'a> {
    pub(super) robot: &'a Robot,
    pub(super) plan: RobotPlan,
    pub(super) pose: &'a RobotFromCamera,
}

/// Writes the files of one frame, all or none.
pub(super) fn write(
    output: &OutputFolder,
    choice: &FileChoice<'_>,
    frame: &CheckedFrame<'_>,
    answer: &FrameAnswer,
    robot: Option<&RobotOutput<'_>>,
    terminal: Terminal,
) -> anyhow::Result<()> {
    // What can be refused comes first.
    let clouds = choice.clouds.of(answer)?;
    let files = output.stage()?;
    let record = serde_json::to_string_pretty(&PicksRecord::from(answer))?;
    files.write_text(PICKS, &(record + "\n"))?;
    if choice.picture {
        let view = robot.map(|robot| RobotView {
            robot_from_camera: robot.pose,
            gripper: &robot.robot.config().gripper,
        });
        picture::draw(frame.frame(), answer, view.as_ref())?.write(files.file(PICTURE))?;
    }
    if let Some(robot) = robot {
        write_plan(&files, choice, frame, robot)?;
    }
    if !clouds.is_empty() {
        write_clouds(&files, frame, answer, &clouds, terminal)?;
    }
    files.publish()
}

/// Writes the robot's plan as messages and as a recording.
#[cfg_attr(
    not(feature = "mcap"),
    expect(unused_variables, reason = "a recording holds the frame too")
)]
fn write_plan(
    files: &Staging<'_>,
    choice: &FileChoice<'_>,
    frame: &CheckedFrame<'_>,
    robot: &RobotOutput<'_>,
) -> anyhow::Result<()> {
    if choice.ros {
        for file in ros::files(&robot.plan, robot.robot.config()) {
            files.write_text(&file.name, &file.text)?;
        }
    }
    #[cfg(feature = "mcap")]
    if choice.recording {
        let (robot, plan, pose) = (robot.robot, &robot.plan, robot.pose);
        let bytes = pomona_messages::recording::record(frame, plan, robot, pose)?;
        std::fs::write(files.file(RECORDING), bytes)?;
    }
    Ok(())
}

/// Writes the coloured clouds of the apples with these ids.
fn write_clouds(
    files: &Staging<'_>,
    frame: &CheckedFrame<'_>,
    answer: &FrameAnswer,
    ids: &[usize],
    terminal: Terminal,
) -> anyhow::Result<()> {
    let clouds = AppleClouds::new(frame);
    for &id in ids {
        match clouds.cut(&answer.apples[id]) {
            Some(cloud) => cloud.write(
                files.file(&cloud_name(id)),
                CloudFormat::PlyBinaryLittleEndian,
            )?,
            None => terminal.note(&format!(
                "{}: apple {id} has no sphere, and so no cloud",
                answer.id
            )),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_a_run_may_write() {
        for name in [PICTURE, RECORDING, &cloud_name(3), "ros-path.yaml"] {
            assert!(is_ours(name), "{name}");
        }
        for name in ["apple-x.ply", "apple-.ply", "ros-.yaml", "notes.txt"] {
            assert!(!is_ours(name), "{name}");
        }
    }
}
