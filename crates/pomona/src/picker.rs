use crate::optics::window_of;
use crate::outcome::{Evidence, Outcome, RobotFromCamera};
use crate::seed::apple_rng;
use crate::{
    AppleRecord, BoxRecord, BranchRecord, Config, FallbackRecord, Found, FrameRecord, Method, Pick,
    PickError, PlanRecord, Record, RobotRecord, SCHEMA, Status, TimingRecord, fallback, paper,
    robust,
};
use nalgebra::{Point3, Vector3};
use pomona_cloud::{DepthPoints, Frame, PixelWindow};
use pomona_geometry::Sphere;
use pomona_transforms::{CameraFrame, Direction, Position, ToolOrientation};
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
    /// Where the frame has no boxes, its parts contradict each other, or the transform
    /// starts in another frame than the camera's. An apple without an answer is no error.
    pub fn pick(
        &self,
        frame: &Frame,
        seed: u64,
        robot_from_camera: Option<&RobotFromCamera>,
    ) -> Result<Outcome, PickError> {
        let Some(boxes) = &frame.boxes else {
            return Err(PickError::NoBoxes {
                frame: frame.id.clone(),
            });
        };
        let boxes: Vec<BoxRecord> = boxes.iter().map(BoxRecord::from).collect();
        self.pick_boxes(frame, boxes, seed, robot_from_camera)
    }

    /// The direction of each apple that [`find_apples`](crate::find_apples) found in `frame`, the apples in parallel; the
    /// frame's own boxes are not read. Boxes whose [`Mark`](crate::Mark) refuses them are not worked on,
    /// unless [`DetectionConfig::pick_marked`](crate::DetectionConfig::pick_marked).
    ///
    /// # Errors
    ///
    /// As [`Picker::pick`].
    pub fn pick_found(
        &self,
        frame: &Frame,
        found: &Found,
        seed: u64,
        robot_from_camera: Option<&RobotFromCamera>,
    ) -> Result<Outcome, PickError> {
        let start = Instant::now();
        let boxes = found.boxes.iter().map(|b| BoxRecord {
            found: Some(b.found),
            ..BoxRecord::from(&b.bounds)
        });
        let mut outcome = self.pick_boxes(frame, boxes.collect(), seed, robot_from_camera)?;
        let mut detection = found.record.clone();
        detection.add_picking(milliseconds(start));
        outcome.record.detection = Some(detection);
        Ok(outcome)
    }

    fn pick_boxes(
        &self,
        frame: &Frame,
        boxes: Vec<BoxRecord>,
        seed: u64,
        robot_from_camera: Option<&RobotFromCamera>,
    ) -> Result<Outcome, PickError> {
        frame.validate().map_err(|source| PickError::Frame {
            frame: frame.id.clone(),
            source: Box::new(source),
        })?;
        if let Some(transform) = robot_from_camera
            && transform.from != frame.camera.frame_id
        {
            return Err(PickError::WrongTransform {
                frame: frame.id.clone(),
                camera: frame.camera.frame_id.clone(),
                from: transform.from.clone(),
            });
        }
        let picked: Result<Vec<(Pick, Evidence)>, PickError> = boxes
            .into_par_iter()
            .enumerate()
            .map_init(Buffers::default, |buffers, (id, pixel_box)| {
                self.pick_apple(frame, id, pixel_box, seed, robot_from_camera, buffers)
            })
            .collect();
        let (picks, evidence) = picked?.into_iter().unzip();
        let record = Record {
            schema: SCHEMA.to_owned(),
            method: self.config.method.name().to_owned(),
            seed,
            frame: FrameRecord {
                id: frame.id.clone(),
                frame_id: frame.camera.frame_id.clone(),
            },
            detection: None,
            picks,
        };
        Ok(Outcome { record, evidence })
    }

    fn pick_apple(
        &self,
        frame: &Frame,
        id: usize,
        pixel_box: BoxRecord,
        seed: u64,
        robot_from_camera: Option<&RobotFromCamera>,
        buffers: &mut Buffers,
    ) -> Result<(Pick, Evidence), PickError> {
        let start = Instant::now();
        let mut pick = Pick {
            id,
            pixel_box,
            status: Status::Picked,
            apple: None,
            branch: None,
            foot: None,
            direction: None,
            direction_sd: None,
            confidence: None,
            candidates: Vec::new(),
            view_from: None,
            fallback: None,
            robot: None,
            plan: PlanRecord::default(),
            timing_ms: TimingRecord::default(),
        };
        let mut evidence = Evidence::default();
        let refused = pick.pixel_box.found.is_some_and(|f| f.mark.refuses());
        if refused && !self.config.detection.pick_marked {
            pick.status = Status::Implausible;
            pick.timing_ms.total = milliseconds(start);
            return Ok((pick, evidence));
        }
        let status = match self.config.method {
            Method::Paper => {
                self.follow_paper(frame, seed, &mut buffers.points, &mut pick, &mut evidence)?
            }
            Method::Robust => {
                let mut rng = apple_rng(seed, &frame.id, pick.id);
                let scratch = &mut buffers.scratch;
                let config = &self.config;
                robust::pick_apple(frame, config, &mut rng, scratch, &mut pick, &mut evidence)
            }
        };
        pick.status = status;
        if let (Some(transform), Some(apple), Some(direction)) =
            (robot_from_camera, &pick.apple, pick.direction)
        {
            pick.robot = robot_record(transform, apple.center, direction);
        }
        if status != Status::Picked {
            let kind = self.config.fallback.kind;
            let found = fallback::direction(kind, frame, &pick, &evidence, &mut buffers.points);
            pick.fallback = found.map(|(direction, direction_source)| FallbackRecord {
                direction: direction.into(),
                direction_source,
                robot: robot_from_camera
                    .zip(pick.apple.as_ref())
                    .and_then(|(t, apple)| robot_record(t, apple.center, direction.into())),
            });
        }
        pick.timing_ms.total = milliseconds(start);
        Ok((pick, evidence))
    }

    /// Fills in what the method finds, stage by stage, and says how it ended.
    fn follow_paper(
        &self,
        frame: &Frame,
        seed: u64,
        points: &mut DepthPoints,
        pick: &mut Pick,
        evidence: &mut Evidence,
    ) -> Result<Status, PickError> {
        let config = &self.config.paper;
        let (width, height) = (frame.depth.width, frame.depth.height);
        let mut rng = apple_rng(seed, &frame.id, pick.id);

        let start = Instant::now();
        let b = &pick.pixel_box;
        let window = PixelWindow::clamped(b.x_min, b.y_min, b.x_max, b.y_max, width, height);
        fill(points, frame, window)?;
        pick.timing_ms.crop = milliseconds(start);

        let start = Instant::now();
        let sphere = paper::fit_sphere(points, config, self.config.fruit.radii(), &mut rng);
        pick.timing_ms.sphere = milliseconds(start);
        let sphere = match sphere {
            Ok(report) => report,
            Err(status) => return Ok(status),
        };
        evidence.surface = sphere.inliers.iter().map(|&i| points.pixel[i]).collect();
        let apple = sphere.model;
        pick.apple = Some(AppleRecord {
            center: apple.center.into(),
            radius: apple.radius,
            inliers: sphere.inliers.len(),
            rms: sphere.residuals.rms,
            center_covariance: None,
            radius_sd: None,
            visible_share: None,
            agreement: None,
        });

        let start = Instant::now();
        let reach = Sphere {
            radius: apple.radius * config.shell_outer,
            ..apple
        };
        fill(
            points,
            frame,
            window_of(&reach, &frame.camera, width, height),
        )?;
        paper::keep_shell(points, &apple, config);
        let branch = paper::fit_branch(points, &apple, config, &mut rng);
        pick.timing_ms.branch = milliseconds(start);
        let branch = match branch {
            Ok(report) => report,
            Err(status) => return Ok(status),
        };
        evidence.branch = branch.inliers.iter().map(|&i| points.pixel[i]).collect();
        let line = branch.model;
        pick.branch = Some(BranchRecord {
            point: line.point.into(),
            direction: line.direction.into_inner().into(),
            inliers: branch.inliers.len(),
            rms: branch.residuals.rms,
        });

        // Section 2.2.5: C is the foot of the perpendicular from O, and OC the direction. The distance
        // window keeps C off O unless its lower bound is 0.
        let foot = line.foot(&apple.center);
        let Some(direction) = (foot - apple.center).try_normalize(1e-9) else {
            return Ok(Status::NoBranch);
        };
        pick.foot = Some(foot.into());
        pick.direction = Some(direction.into());
        Ok(Status::Picked)
    }
}

fn fill(points: &mut DepthPoints, frame: &Frame, window: PixelWindow) -> Result<(), PickError> {
    points
        .fill(&frame.depth, &frame.camera, window)
        .map_err(|source| PickError::Frame {
            frame: frame.id.clone(),
            source: Box::new(source),
        })
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

fn robot_record(
    robot_from_camera: &RobotFromCamera,
    center: [f64; 3],
    direction: [f64; 3],
) -> Option<RobotRecord> {
    let center = Position::<CameraFrame>::new(Point3::from(center));
    let direction = Direction::<CameraFrame>::new(Vector3::from(direction))?;
    let center = robot_from_camera.transform.position(&center);
    let direction = robot_from_camera.transform.direction(&direction);
    let tool = ToolOrientation::along(&direction);
    Some(RobotRecord {
        frame_id: robot_from_camera.to.clone(),
        center: center.point().into(),
        direction: direction.vector().into(),
        quaternion_xyzw: tool.quaternion_xyzw(),
        euler_zyx: [tool.euler.rx, tool.euler.ry, tool.euler.rz],
        singular: tool.singular,
    })
}
