use crate::config::{Config, Method};
use crate::detection::{BoxOrigin, DetectedApples};
use crate::error::PickError;
use crate::fallback;
use crate::frame::CheckedFrame;
use crate::outcome::{AppleAnswer, FrameAnswer, RobotFromCamera, RobotTarget, Status};
use crate::paper;
use crate::robust;
use crate::seed::apple_rng;
use crate::size_doubt;
use pomona_cloud::{DepthPoints, PixelBox};
use rayon::prelude::*;
use std::time::Instant;

/// Memory that serves one apple after another.
#[derive(Default)]
struct Buffers {
    points: DepthPoints,
    scratch: robust::Scratch,
}

/// Picks directions by one checked configuration.
#[derive(Clone, Debug)]
pub struct Picker {
    config: Config,
}

/// What is the same for all apples of a frame.
struct Run<'a> {
    config: &'a Config,
    frame: &'a CheckedFrame<'a>,
    seed: u64,
    robot_from_camera: Option<&'a RobotFromCamera>,
}

impl Picker {
    /// A picker with these settings.
    ///
    /// # Errors
    ///
    /// [`PickError::Config`] names the setting that makes no sense.
    pub fn new(config: Config) -> Result<Self, PickError> {
        config.validate()?;
        Ok(Self { config })
    }

    /// Its settings.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The direction of each boxed apple of `frame`, the apples in parallel.
    ///
    /// # Errors
    ///
    /// [`PickError::NoBoxes`] where the frame has none, [`PickError::WrongTransform`] where the transform starts in
    /// another frame than the camera's. An apple without an answer is no error.
    pub fn pick(
        &self,
        frame: &CheckedFrame<'_>,
        seed: u64,
        robot_from_camera: Option<&RobotFromCamera>,
    ) -> Result<FrameAnswer, PickError> {
        let Some(boxes) = &frame.frame().boxes else {
            return Err(PickError::NoBoxes {
                frame: frame.frame().id.clone(),
            });
        };
        let boxes = boxes.iter().map(|bounds| (bounds, None));
        self.pick_boxes(frame, boxes.collect(), seed, robot_from_camera)
    }

    /// The direction of each apple that [`find_apples`](crate::find_apples) found in `frame`, the apples in parallel;
    /// the frame's own boxes are not read. Boxes whose [`Mark`](crate::Mark) refuses them are not worked on,
    /// unless [`DetectionConfig::pick_marked`](crate::DetectionConfig::pick_marked).
    ///
    /// # Errors
    ///
    /// [`PickError::WrongTransform`], as [`Picker::pick`].
    pub fn pick_detected(
        &self,
        frame: &CheckedFrame<'_>,
        detected: &DetectedApples,
        seed: u64,
        robot_from_camera: Option<&RobotFromCamera>,
    ) -> Result<FrameAnswer, PickError> {
        let start = Instant::now();
        let boxes = detected.boxes.iter().map(|b| (&b.bounds, Some(b.origin)));
        let mut answer = self.pick_boxes(frame, boxes.collect(), seed, robot_from_camera)?;
        let mut summary = detected.summary.clone();
        summary.times.picking = start.elapsed();
        answer.detection = Some(summary);
        Ok(answer)
    }

    fn pick_boxes(
        &self,
        frame: &CheckedFrame<'_>,
        boxes: Vec<(&PixelBox, Option<BoxOrigin>)>,
        seed: u64,
        robot_from_camera: Option<&RobotFromCamera>,
    ) -> Result<FrameAnswer, PickError> {
        let (id, camera) = (&frame.frame().id, &frame.frame().camera);
        if let Some(transform) = robot_from_camera
            && transform.from != camera.frame_id
        {
            return Err(PickError::WrongTransform {
                frame: id.clone(),
                camera: camera.frame_id.clone(),
                from: transform.from.clone(),
            });
        }
        let run = Run {
            config: &self.config,
            frame,
            seed,
            robot_from_camera,
        };
        let doubt = size_doubt::doubt(frame, boxes.iter().map(|(b, _)| *b), &self.config.fruit);
        let apples = boxes
            .into_par_iter()
            .enumerate()
            .map_init(Buffers::default, |buffers, (id, (bounds, origin))| {
                run.apple(id, bounds.clone(), origin, buffers)
            })
            .collect();
        let method = self.config.method;
        let mut answer = FrameAnswer::new(method, seed, id, &camera.frame_id, apples);
        answer.warnings.clone_from(&frame.frame().warnings);
        answer.warnings.extend(camera.doubts());
        answer.warnings.extend(doubt);
        Ok(answer)
    }
}

impl Run<'_> {
    /// Answers one box.
    fn apple(
        &self,
        id: usize,
        bounds: PixelBox,
        origin: Option<BoxOrigin>,
        buffers: &mut Buffers,
    ) -> AppleAnswer {
        let start = Instant::now();
        let refused = origin.is_some_and(|origin| origin.mark.refuses());
        let mut answer = if refused && !self.config.detection.pick_marked {
            AppleAnswer::new(id, bounds, Status::Implausible)
        } else {
            let check = self.config.robust.check_boxes && !refused;
            let mut answer = self.by_method(id, bounds, check, buffers);
            self.add_robot(&mut answer);
            self.add_fallback(&mut answer, &mut buffers.points);
            answer
        };
        answer.origin = origin;
        answer.times.total = start.elapsed();
        answer
    }

    /// `check` is whether `robust` may find that the box holds no apple.
    fn by_method(
        &self,
        id: usize,
        bounds: PixelBox,
        check: bool,
        buffers: &mut Buffers,
    ) -> AppleAnswer {
        let mut rng = apple_rng(self.seed, &self.frame.frame().id, id);
        let (frame, config) = (self.frame, self.config);
        match config.method {
            Method::Paper => {
                let points = &mut buffers.points;
                paper::pick_apple(frame, config, id, bounds, &mut rng, points)
            }
            Method::Robust => {
                let scratch = &mut buffers.scratch;
                robust::pick_apple(frame, config, (id, bounds), check, &mut rng, scratch)
            }
        }
    }

    /// Brings a direction into the robot's frame.
    fn add_robot(&self, answer: &mut AppleAnswer) {
        if let (Some(transform), Some(apple), Some(pick)) =
            (self.robot_from_camera, &answer.apple, &answer.pick)
        {
            answer.robot = Some(RobotTarget::new(transform, &apple.center, &pick.direction));
        }
    }

    /// Adds the fallback direction of a refusal, where the settings ask for one.
    fn add_fallback(&self, answer: &mut AppleAnswer, points: &mut DepthPoints) {
        let Some(apple) = answer.apple.filter(|_| !answer.is_picked()) else {
            return;
        };
        let kind = self.config.fallback.kind;
        let surface = &answer.evidence.surface;
        let found = fallback::direction(kind, self.frame, &apple, surface, points);
        answer.fallback = found.map(|mut fallback| {
            fallback.robot = self
                .robot_from_camera
                .map(|t| RobotTarget::new(t, &apple.center, &fallback.direction));
            fallback
        });
    }
}
