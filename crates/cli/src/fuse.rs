use crate::camera_pose::CameraPoses;
use crate::frame_arguments::FrameArguments;
use crate::output_folder::{OutputFolder, RecordFile};
use crate::summary::plural;
use crate::terminal::{self, FAINT, GOOD, HEADING, REFUSED, Terminal, one_line};
use anyhow::bail;
use pomona::{FrameAnswer, RobotFromCamera};
use pomona_cloud::CloudFormat;
use pomona_fusion::{
    DirectionUse, FusedApple, FusedCloud, FusedRecord, FusedStatus, FusedTree, FusionConfig,
    PosedAnswer,
};
use std::path::{Path, PathBuf};

/// The fused answers.
const FUSED: &str = "fused.json";
/// The fused cloud.
const CLOUD: &str = "fused.ply";

/// One frame, answered.
pub(crate) struct FusedInput<'a> {
    pub(crate) folder: &'a Path,
    pub(crate) answer: &'a FrameAnswer,
    pub(crate) pose: &'a RobotFromCamera,
}

/// What is to be fused, and where it goes.
pub(crate) struct Task<'a> {
    pub(crate) frames: &'a [FusedInput<'a>],
    pub(crate) output: &'a OutputFolder,
    /// How the frames are read.
    pub(crate) read: FrameArguments,
    pub(crate) cloud: bool,
    pub(crate) json: bool,
}

/// Refuses what cannot be fused before any work is done, and claims the names of the fused files.
pub(crate) fn claim(frames: &[PathBuf], out: &Path) -> anyhow::Result<OutputFolder> {
    if frames.len() < 2 {
        bail!("--fuse takes at least two frames of one tree, and one is given");
    }
    let mut seen: Vec<(PathBuf, &PathBuf)> = Vec::new();
    for frame in frames {
        // What cannot be read is reported where it is read.
        let full = frame.canonicalize().unwrap_or_else(|_| frame.clone());
        if let Some((_, first)) = seen.iter().find(|(known, _)| *known == full) {
            bail!(
                "{} and {}: the same frame is given twice; --fuse takes each once",
                first.display(),
                frame.display()
            );
        }
        seen.push((full, frame));
    }
    OutputFolder::claim(out, &[RECORD], |name| name == CLOUD)
}

/// What says that a fused cloud beside it is ours.
const RECORD: RecordFile<'static> = RecordFile {
    name: FUSED,
    schema: "pomona.fused/",
};

/// Removes the fused answers of an earlier run, which are not of the frames that this one answered.
pub(crate) fn remove_earlier(out: &Path) -> anyhow::Result<()> {
    OutputFolder::remove_earlier(out, RECORD, |name| name == CLOUD)
}

/// Refuses frames without a pose of their camera, and poses that do not lead to one frame of the robot.
pub(crate) fn check_poses(poses: &CameraPoses, folders: &[&Path]) -> anyhow::Result<()> {
    let mut first: Option<(&Path, String)> = None;
    for folder in folders {
        let Some(pose) = poses.of(folder)? else {
            bail!(
                "{}: no pose of its camera: --fuse needs robot_from_camera.json in the folder of each frame, or --transform \
                 FILE for a camera at rest, or --transform FILE and base_from_flange.json in each folder for one on the \
                 gripper",
                folder.display()
            );
        };
        match &first {
            Some((other, to)) if to != pose.to() => bail!(
                "the pose of {} leads to '{to}', that of {} to '{}': give all poses in one frame of the robot",
                other.display(),
                folder.display(),
                pose.to()
            ),
            Some(_) => {}
            None => first = Some((folder, pose.to().to_owned())),
        }
    }
    Ok(())
}

impl Task<'_> {
    /// Fuses, writes and prints.
    pub(crate) fn run(&self, config: &FusionConfig, terminal: Terminal) -> anyhow::Result<()> {
        let posed: Vec<PosedAnswer<'_>> = self
            .frames
            .iter()
            .map(|frame| PosedAnswer::new(frame.answer, frame.pose))
            .collect();
        let tree = pomona_fusion::fuse(&posed, config)?;
        let text = serde_json::to_string_pretty(&FusedRecord::from(&tree))? + "\n";
        self.write(&tree, &text, config)?;
        if self.json {
            terminal::print(&text)
        } else {
            terminal::print(&("\n".to_owned() + &table(&tree, terminal)))
        }
    }

    fn write(&self, tree: &FusedTree, text: &str, config: &FusionConfig) -> anyhow::Result<()> {
        let files = self.output.stage()?;
        if self.cloud {
            let mut fused = FusedCloud::new(config.voxel_m);
            for (input, fused_frame) in self.frames.iter().zip(&tree.frames) {
                let frame = self.read.without_boxes(input.folder)?;
                fused.add(&frame, input.pose, &fused_frame.correction)?;
            }
            fused
                .cloud()
                .write(files.file(CLOUD), CloudFormat::PlyBinaryLittleEndian)?;
        }
        files.write_text(FUSED, text)?;
        files.publish()
    }
}

/// What a person reads of the fused answers.
fn table(tree: &FusedTree, terminal: Terminal) -> String {
    let title = format!(
        "fused in {}: {} from {}",
        one_line(&tree.frame_id),
        plural(tree.apples.len(), "apple"),
        plural(tree.frames.len(), "frame")
    );
    let mut text = terminal.paint(HEADING, &title) + "\n";
    let header = format!(
        "{:>3}  {:<13}  {:>8} {:>8} {:>8} {:>6}  {:>5}  {:>6}  {:>6}  {:>8}  reason",
        "id", "status", "x mm", "y mm", "z mm", "sd mm", "r mm", "sd deg", "sure %", "moved mm"
    );
    text += &(terminal.paint(FAINT, &header) + "\n");
    for apple in &tree.apples {
        text += &(row(apple, terminal) + "\n");
    }
    for (k, frame) in tree.frames.iter().enumerate().skip(1) {
        let name = one_line(&frame.id);
        let line = match &frame.shift {
            Some(shift) => format!(
                "{name}: {} shared, {:.1} ± {:.1} mm off the first frame{}\n",
                plural(frame.shared, "apple"),
                shift.by.norm() * 1e3,
                shift.sd_m * 1e3,
                if shift.significant {
                    ": the tree swayed, or a pose is off"
                } else {
                    ""
                }
            ),
            None => format!("{name}: frame {k} shares no apple with another\n"),
        };
        text.push_str(&line);
    }
    text
}

fn row(apple: &FusedApple, terminal: Terminal) -> String {
    let sd_m = (apple.center.covariance_m2.trace() / 3.0).max(0.0).sqrt();
    let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
    let style = if apple.status == FusedStatus::Picked {
        GOOD
    } else {
        REFUSED
    };
    let status = terminal.paint(style, &format!("{:<13}", apple.status.name()));
    let [x, y, z]: [f64; 3] = (apple.center.position.point() * 1e3).into();
    let outlier = apple
        .observations
        .iter()
        .any(|o| o.direction_use == DirectionUse::Outlier);
    format!(
        "{:>3}  {status}  {x:>8.1} {y:>8.1} {z:>8.1} {:>6.1}  {:>5.1}  {:>6}  {:>6}  {:>8}  {}{}",
        apple.id,
        sd_m * 1e3,
        apple.radius_m * 1e3,
        or_dash(
            apple
                .direction
                .map(|d| format!("{:.1}", d.sd_rad.to_degrees()))
        ),
        or_dash(apple.confidence.map(|c| format!("{:.0}", c * 100.0))),
        or_dash(
            apple
                .movement
                .as_ref()
                .map(|m| format!("{:.1}", m.by.norm() * 1e3))
        ),
        apple.reason,
        if outlier { " (others dropped)" } else { "" }
    )
}
