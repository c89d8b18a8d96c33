use crate::apple_cloud::{AppleClouds, CloudChoice};
use crate::detector::DetectorArguments;
use crate::fuse;
use crate::output_folder::OutputFolder;
#[cfg(feature = "mcap")]
use crate::pick_files::RECORDING;
use crate::pick_files::{self, PICKS, PICTURE, cloud_name};
use crate::picture::RobotView;
use crate::settings::SettingsArguments;
use crate::summary::{plural, summary};
use crate::table::table;
use crate::terminal::{self, Terminal};
use crate::{picture, progress};
use anyhow::{anyhow, bail};
use clap::Args;
use pomona::{
    ApproachConfig, Outcome, Picker, Record, Robot, RobotFromCamera, RobotPlan, find_apples,
};
use pomona_cloud::{Frame, read_boxes};
use pomona_detect::Detector;
use pomona_messages::ros;
use std::cell::OnceCell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

const EXAMPLES: &str = "\
Examples:
  pomona pick frames/a --out out                      out/picks.json, picture.png, apple-N.ply
  pomona pick frames/a frames/b --out out             out/a/... and out/b/...
  pomona pick frames/a --boxes detections.json --out out
  pomona pick frames/a --detect --model mine.onnx --out out
  pomona pick frames/a --transform robot_from_camera.json --out out
  pomona pick frames/a --transform robot_from_camera.json --robot robot.toml --ros --out out
  pomona pick frames/a --radius-max-mm 60 --set paper.shell_outer=2.5 --out out
  pomona pick frames/left frames/right --fuse --out out    out/fused.json beside out/left and out/right
  pomona pick frames/* --out out --json | jq '.[].picks[].direction'

With --fuse, the frames show one tree. A frame's pose is robot_from_camera.json in its folder, else that of \
--transform: a camera at rest.

A frame is a folder with color.png (or .jpg), depth.png (16 bit, registered to colour), camera.json and, where \
they are known, boxes (boxes.xml VOC, boxes.json COCO or boxes.txt YOLO). Without boxes a detector finds the apples, \
and depth marks those that are none: see `detection` in `pomona config`.

In the table, `angle` is that of the direction in the picture (0 right, 90 up) and `away` that out of the image \
plane (positive away from the camera).

An apple without an answer is refused with its reason, and the run goes on. Exit code 0: every frame was \
processed. 2: bad input; frames that failed have written nothing.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a flag of the command line"
)]
pub(crate) struct PickArguments {
    /// Folders of frames.
    #[arg(required = true, value_name = "FRAME")]
    frames: Vec<PathBuf>,
    /// Where to write; several frames get a folder each in there. Our own files are replaced.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Boxes of the apples (VOC, COCO or YOLO) in place of the frame's own; for one frame.
    #[arg(long, value_name = "FILE")]
    boxes: Option<PathBuf>,
    /// Let the detector find the apples, also where a frame has boxes.
    #[arg(long, conflicts_with = "boxes")]
    detect: bool,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Transform from the camera's to the robot's frame; adds the answers in the robot's frame.
    #[arg(long, value_name = "FILE")]
    transform: Option<PathBuf>,
    /// Plan how a robot with these settings (see `pomona config --robot`) gets to each apple and in
    /// which order; adds gripper, approach, clearance and order to the record, and the path to the picture.
    #[arg(long, value_name = "FILE", requires = "transform")]
    robot: Option<PathBuf>,
    /// Write the plan as messages of ROS 2 and `MoveIt` too, ros-*.yaml for `ros2 topic pub`.
    #[arg(long, requires = "robot")]
    ros: bool,
    /// Write frame and plan as recording.mcap too, for Foxglove.
    #[cfg(feature = "mcap")]
    #[arg(long, requires = "robot")]
    mcap: bool,
    /// Combine frames of one tree in the robot's frame: one answer for each apple, how far the tree
    /// swayed, which apples moved; written to fused.json.
    #[arg(long)]
    fuse: bool,
    /// Write the points of all frames in the robot's frame to fused.ply too, thinned to
    /// `fusion.voxel_m`.
    #[arg(long, requires = "fuse")]
    fused_cloud: bool,
    /// Print the record to standard output in place of the table: one JSON object for one frame, an
    /// array for several; the fused one with --fuse.
    #[arg(long)]
    json: bool,
    /// Leave picture.png out.
    #[arg(long)]
    no_picture: bool,
    /// Which apples get a coloured cloud apple-N.ply: best (the picked apple with most surface
    /// points), all, none, or numbers such as 0,3.
    #[arg(long, value_name = "WHICH", default_value = "best")]
    clouds: CloudChoice,
    #[command(flatten)]
    detector: DetectorArguments,
    #[command(flatten)]
    settings: SettingsArguments,
}

pub(crate) fn run(arguments: &PickArguments, terminal: Terminal) -> anyhow::Result<()> {
    let config = arguments.settings.config()?;
    log::debug!("{config:?}");
    let run = Run {
        picker: Picker::new(config)?,
        transform: arguments
            .transform
            .as_ref()
            .map(RobotFromCamera::read)
            .transpose()?,
        robot: arguments
            .robot
            .as_ref()
            .map(|path| Robot::new(ApproachConfig::read(path)?))
            .transpose()?,
        detector: OnceCell::new(),
        arguments,
        terminal,
    };
    let fused_output = arguments
        .fuse
        .then(|| fuse::claim(&arguments.frames, &arguments.out))
        .transpose()?;
    let jobs = jobs(arguments)?;
    let poses = run.poses(&jobs)?;
    let bar = progress::bar(jobs.len());
    let mut records = Vec::new();
    for (job, pose) in jobs.iter().zip(&poses) {
        bar.set_message(job.frame.display().to_string());
        match run.frame(job, pose.as_ref()) {
            Ok(record) => {
                if !arguments.json {
                    let separator = if records.is_empty() { "" } else { "\n" };
                    let text = separator.to_owned() + &table(&record, terminal);
                    bar.suspend(|| terminal::print(&text))?;
                }
                records.push(record);
            }
            Err(error) if jobs.len() == 1 => return Err(error),
            Err(error) => bar.suspend(|| terminal.error(&error)),
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    let complete = records.len() == jobs.len();
    if let (Some(output), true) = (&fused_output, complete) {
        let frames = jobs.iter().zip(&records).zip(poses.iter().flatten());
        let frames: Vec<_> = frames
            .map(|((job, record), pose)| fuse::FusedInput {
                folder: &job.frame,
                record,
                pose,
            })
            .collect();
        let task = fuse::Task {
            frames: &frames,
            output,
            cloud: arguments.fused_cloud,
            json: arguments.json,
        };
        task.run(&run.picker.config().fusion, terminal)?;
    }
    if arguments.fuse && arguments.json {
        // The fused record has been printed, where there is one.
    } else if arguments.json {
        terminal::print(&(json(&records, jobs.len() == 1)? + "\n"))?;
    } else if !records.is_empty() {
        let place = arguments.out.display();
        terminal::print(&format!("\n{}; written to {place}\n", summary(&records)))?;
    }
    let failed = jobs.len() - records.len();
    if failed > 0 {
        bail!(
            "{} of {} failed, for the reasons above",
            failed,
            if arguments.fuse {
                plural(jobs.len(), "frame") + ", and nothing was fused,"
            } else {
                plural(jobs.len(), "frame")
            }
        );
    }
    Ok(())
}

fn json(records: &[Record], one: bool) -> serde_json::Result<String> {
    match records {
        [record] if one => serde_json::to_string_pretty(record),
        records => serde_json::to_string_pretty(records),
    }
}

/// One frame's folder and that of its answers.
struct Job {
    frame: PathBuf,
    output: OutputFolder,
}

fn jobs(arguments: &PickArguments) -> anyhow::Result<Vec<Job>> {
    let job = |frame: &Path, out: &Path| -> anyhow::Result<Job> {
        Ok(Job {
            frame: frame.to_owned(),
            output: pick_files::claim(out)?,
        })
    };
    if let [frame] = &*arguments.frames {
        return Ok(vec![job(frame, &arguments.out)?]);
    }
    if arguments.boxes.is_some() {
        bail!(
            "--boxes holds the boxes of one frame, but {} frames are given; put boxes into each frame's folder",
            arguments.frames.len()
        );
    }
    let mut seen: HashMap<PathBuf, &Path> = HashMap::new();
    let mut jobs = Vec::new();
    for frame in &arguments.frames {
        let id = folder_name(frame)?;
        if let Some(other) = seen.insert(id.clone(), frame) {
            bail!(
                "{} and {}: both would be written to {}; rename one of the folders, or give each a run of its own",
                other.display(),
                frame.display(),
                arguments.out.join(id).display()
            );
        }
        jobs.push(job(frame, &arguments.out.join(id))?);
    }
    Ok(jobs)
}

/// The name of a frame's folder, also where the path is `.` or ends in `..`.
fn folder_name(frame: &Path) -> anyhow::Result<PathBuf> {
    if let Some(name) = frame.file_name() {
        return Ok(name.into());
    }
    let full = frame
        .canonicalize()
        .map_err(|e| anyhow!("{}: {e}; check the path", frame.display()))?;
    let name = full
        .file_name()
        .ok_or_else(|| anyhow!("{}: not a frame's folder", frame.display()))?;
    Ok(name.into())
}

/// What is the same for all frames of a run.
struct Run<'a> {
    picker: Picker,
    transform: Option<RobotFromCamera>,
    robot: Option<Robot>,
    /// Opened when the first frame needs it.
    detector: OnceCell<Box<dyn Detector>>,
    arguments: &'a PickArguments,
    terminal: Terminal,
}

impl Run<'_> {
    /// The pose of each frame's camera, where one is given.
    fn poses(&self, jobs: &[Job]) -> anyhow::Result<Vec<Option<RobotFromCamera>>> {
        if !self.arguments.fuse {
            return Ok(vec![self.transform.clone(); jobs.len()]);
        }
        let folders: Vec<&Path> = jobs.iter().map(|job| job.frame.as_path()).collect();
        let poses = fuse::poses(&folders, self.transform.as_ref())?;
        Ok(poses.into_iter().map(Some).collect())
    }

    /// The detector that the command line asks for, the same for all frames.
    fn detector(&self, frame: &Frame) -> anyhow::Result<&dyn Detector> {
        if let Some(detector) = self.detector.get() {
            return Ok(&**detector);
        }
        let opened = self.arguments.detector.open().map_err(|e| {
            if self.arguments.detect {
                return anyhow!(e);
            }
            anyhow!(
                "frame '{}' has no boxes, and the detector cannot be used: {e}; or put boxes.xml, boxes.json or \
                 boxes.txt into its folder, or give --boxes FILE",
                frame.id
            )
        })?;
        Ok(&**self.detector.get_or_init(|| opened))
    }

    /// The answers for a frame's boxes, or for those that the detector finds.
    fn answer(&self, frame: &Frame, pose: Option<&RobotFromCamera>) -> anyhow::Result<Outcome> {
        let seed = self.arguments.seed;
        if frame.boxes.is_some() && !self.arguments.detect {
            return Ok(self.picker.pick(frame, seed, pose)?);
        }
        let detector = self.detector(frame)?;
        let found = find_apples(frame, detector, self.picker.config())?;
        log::info!("{}: {:?}", frame.id, found.record);
        Ok(self.picker.pick_found(frame, &found, seed, pose)?)
    }

    /// Answers one frame and writes its files, all or none.
    fn frame(&self, job: &Job, pose: Option<&RobotFromCamera>) -> anyhow::Result<Record> {
        let start = Instant::now();
        let mut frame = Frame::read(&job.frame)?;
        if let Some(path) = &self.arguments.boxes {
            frame.boxes = Some(read_boxes(path, frame.color.width, frame.color.height)?);
        }
        log::info!("{}: read in {:.0?}", frame.id, start.elapsed());
        let start = Instant::now();
        let mut outcome = self.answer(&frame, pose)?;
        log::info!("{}: picked in {:.0?}", frame.id, start.elapsed());
        let start = Instant::now();
        let plan = match (&self.robot, pose) {
            (Some(robot), Some(transform)) => Some(robot.plan(&frame, &mut outcome, transform)?),
            _ => None,
        };
        if plan.is_some() {
            log::info!("{}: planned in {:.1?}", frame.id, start.elapsed());
        }
        let start = Instant::now();
        self.write(job, &frame, &outcome, plan.as_ref().zip(pose))?;
        log::info!("{}: written in {:.0?}", frame.id, start.elapsed());
        Ok(outcome.record)
    }

    fn robot_view<'v>(&'v self, robot_from_camera: &'v RobotFromCamera) -> Option<RobotView<'v>> {
        Some(RobotView {
            robot_from_camera,
            gripper: &self.robot.as_ref()?.config().gripper,
        })
    }

    fn write(
        &self,
        job: &Job,
        frame: &Frame,
        outcome: &Outcome,
        plan: Option<(&RobotPlan, &RobotFromCamera)>,
    ) -> anyhow::Result<()> {
        let chosen = self.arguments.clouds.of(outcome)?;
        let picture = if self.arguments.no_picture {
            None
        } else {
            let view = plan.and_then(|(_, pose)| self.robot_view(pose));
            Some(picture::draw(frame, outcome, view.as_ref())?)
        };
        let clouds = if chosen.is_empty() {
            None
        } else {
            Some(AppleClouds::new(frame)?)
        };

        let output = job.output.stage()?;
        output.write_text(
            PICKS,
            &(serde_json::to_string_pretty(&outcome.record)? + "\n"),
        )?;
        if let (Some(robot), Some((plan, _)), true) = (&self.robot, plan, self.arguments.ros) {
            for file in ros::files(plan, robot.config()) {
                output.write_text(&file.name, &file.text)?;
            }
        }
        #[cfg(feature = "mcap")]
        if let (Some(robot), Some((plan, transform)), true) =
            (&self.robot, plan, self.arguments.mcap)
        {
            let bytes = pomona_messages::recording::record(frame, outcome, plan, robot, transform)?;
            std::fs::write(output.file(RECORDING), bytes)?;
        }
        if let Some(picture) = picture {
            picture.write(output.file(PICTURE))?;
        }
        for id in chosen {
            let cut = clouds
                .as_ref()
                .and_then(|c| c.cut(&outcome.record.picks[id], &outcome.evidence[id]));
            match cut {
                Some(cloud) => cloud.write(
                    output.file(&cloud_name(id)),
                    pomona_cloud::CloudFormat::PlyBinaryLittleEndian,
                )?,
                None => self.terminal.note(&format!(
                    "{}: apple {id} has no sphere, and so no cloud",
                    frame.id
                )),
            }
        }
        output.publish()
    }
}
