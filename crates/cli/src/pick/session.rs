use super::arguments::PickArguments;
use super::files::{self, RobotOutput};
use super::jobs::Job;
use crate::camera_pose::CameraPoses;
use crate::terminal::Terminal;
use crate::wood::{self, SegmenterChoice};
use anyhow::{anyhow, bail};
use pomona::{
    ApproachConfig, CheckedFrame, Config, DetectedApples, FrameAnswer, Picker, Robot,
    RobotFromCamera, Warning, WarningCode, find_apples,
};
use pomona_cloud::{BoxSource, Frame, GrayImage, PixelBox};
use pomona_detect::Detector;
use pomona_segment::CloseUps;
use std::cell::OnceCell;
use std::path::Path;
use std::time::Instant;

/// What is the same for all frames of a run.
pub(super) struct Session<'a> {
    picker: Picker,
    poses: CameraPoses,
    robot: Option<Robot>,
    /// Opened when the first frame needs it.
    detector: OnceCell<Box<dyn Detector>>,
    /// The same.
    segmenter: OnceCell<CloseUps>,
    arguments: &'a PickArguments,
}

impl<'a> Session<'a> {
    pub(super) fn new(arguments: &'a PickArguments, config: Config) -> anyhow::Result<Self> {
        Ok(Self {
            picker: Picker::new(config)?,
            poses: CameraPoses::read(arguments.transform.as_deref())?,
            robot: arguments
                .robot
                .as_ref()
                .map(|path| Robot::new(ApproachConfig::read(path)?))
                .transpose()?,
            detector: OnceCell::new(),
            segmenter: OnceCell::new(),
            arguments,
        })
    }

    pub(super) fn config(&self) -> &Config {
        self.picker.config()
    }

    /// Where the cameras are.
    pub(super) fn poses(&self) -> &CameraPoses {
        &self.poses
    }

    /// Reads a frame, answers it, plans the robot's way to its apples, and writes its files, all or none. The answer, and
    /// the pose of the frame's camera where there is one.
    pub(super) fn run(
        &self,
        job: &Job,
        terminal: Terminal,
    ) -> anyhow::Result<(FrameAnswer, Option<RobotFromCamera>)> {
        let start = Instant::now();
        let pose = self.poses.of(&job.frame)?;
        let mut frame = self.read(&job.frame)?;
        frame.warnings.extend(self.poses.unused(&job.frame));
        let pose = match pose {
            Some(pose) => {
                let camera = pose.of_camera(&frame.camera.frame_id)?;
                Some(camera.append_to(&mut frame.warnings))
            }
            None if self.robot.is_some() => bail!(
                "{}: no pose of its camera: --robot needs --transform FILE, or robot_from_camera.json in the frame's folder",
                job.frame.display()
            ),
            None => None,
        };
        let pose = pose.as_ref();
        let frame = CheckedFrame::new(&frame)?;
        let id = &frame.frame().id;
        log::info!("{id}: read in {:.0?}", start.elapsed());

        let detected = self.detected(&frame)?;
        let start = Instant::now();
        let wood = self.wood(&frame, detected.as_ref(), terminal)?;
        let frame = match &wood {
            Some(wood) => frame.with_wood(wood)?,
            None => frame,
        };
        log::info!("{id}: wood told in {:.0?}", start.elapsed());

        let start = Instant::now();
        let seed = self.arguments.seed;
        let mut answer = match &detected {
            Some(detected) => self.picker.pick_detected(&frame, detected, seed, pose)?,
            None => self.picker.pick(&frame, seed, pose)?,
        };
        log::info!("{id}: picked in {:.0?}", start.elapsed());
        if let Some(detected) = &detected {
            let detector = &detected.summary.detector;
            let file = Path::new(&detector.name).file_name().unwrap_or_default();
            let name = file.to_string_lossy();
            let warning =
                |note| Warning::new(WarningCode::DetectorAssumed, format!("{name}: {note}"));
            answer.warnings.extend(detector.notes.iter().map(warning));
        }

        let robot = self.robot.as_ref().zip(pose).map(|(robot, pose)| {
            let start = Instant::now();
            let plan = robot.plan(&frame, &mut answer, pose);
            log::info!("{id}: planned in {:.1?}", start.elapsed());
            RobotOutput { robot, plan, pose }
        });

        let start = Instant::now();
        let files = self.arguments.files();
        files::write(
            &job.output,
            &files,
            &frame,
            &answer,
            robot.as_ref(),
            terminal,
        )?;
        log::info!("{id}: written in {:.0?}", start.elapsed());
        Ok((answer, pose.cloned()))
    }

    fn read(&self, folder: &Path) -> anyhow::Result<Frame> {
        let arguments = self.arguments;
        let boxes = match &arguments.boxes {
            Some(path) => BoxSource::File(path.clone()),
            None if arguments.detect => BoxSource::Nowhere,
            None => BoxSource::Own,
        };
        let choice = arguments.detector.box_choice();
        Ok(arguments.frame.read_with(folder, boxes, choice)?)
    }

    /// What the detector finds, where the frame has no boxes or the command line asks for it.
    fn detected(&self, frame: &CheckedFrame<'_>) -> anyhow::Result<Option<DetectedApples>> {
        if frame.frame().boxes.is_some() {
            return Ok(None);
        }
        let detector = self.detector(&frame.frame().id)?;
        let detected = find_apples(frame, detector, self.config())?;
        log::info!("{}: {:?}", frame.frame().id, detected.summary);
        Ok(Some(detected))
    }

    /// The probability of wood of each pixel about the apples: from the mask or by the segmenter that the command line
    /// names.
    fn wood(
        &self,
        frame: &CheckedFrame<'_>,
        detected: Option<&DetectedApples>,
        terminal: Terminal,
    ) -> anyhow::Result<Option<GrayImage>> {
        if let Some(path) = &self.arguments.wood {
            return Ok(Some(GrayImage::read(path)?));
        }
        let SegmenterChoice::Model(model) = &self.arguments.segmenter else {
            return Ok(None);
        };
        if self.segmenter.get().is_none() {
            let opened = wood::open(model, self.arguments.detector.runtime(), terminal)?;
            // It was empty.
            let _ = self.segmenter.set(opened);
        }
        let Some(segmenter) = self.segmenter.get() else {
            return Ok(None);
        };
        let frame = frame.frame();
        let mut boxes: Vec<&PixelBox> = frame.boxes.iter().flatten().collect();
        if let Some(detected) = detected {
            boxes = detected.boxes.iter().map(|b| &b.bounds).collect();
        }
        wood::about(segmenter, &frame.color, &boxes).map(Some)
    }

    /// The detector that the command line asks for, the same for all frames.
    fn detector(&self, frame_id: &str) -> anyhow::Result<&dyn Detector> {
        if let Some(detector) = self.detector.get() {
            return Ok(&**detector);
        }
        let opened = self.arguments.detector.open().map_err(|e| {
            if self.arguments.detect {
                return anyhow!(e);
            }
            anyhow!(
                "frame '{frame_id}' has no boxes, and the detector cannot be used: {e}; or put boxes.xml, boxes.json or \
                 boxes.txt into its folder, or give --boxes FILE"
            )
        })?;
        Ok(&**self.detector.get_or_init(|| opened))
    }
}
