//! Where the camera of each frame is: fixed beside the robot, or on its gripper.

use anyhow::{anyhow, bail};
use pomona::{RobotFromCamera, Warning, WarningCode};
use pomona_cloud::WithWarnings;
use pomona_transforms::{
    AnyTransform, CameraFrame, FlangeFrame, NamedTransform, RobotFrame, UncertainTransform,
};
use std::path::{Path, PathBuf};

/// The pose of a frame's camera, in the frame's folder.
const OWN_POSE: [&str; 4] = [
    "robot_from_camera.json",
    "robot_from_camera.yaml",
    "robot_from_camera.yml",
    "robot_from_camera.txt",
];
/// The flange's pose at the shot, in the frame's folder.
const FLANGE_POSE: [&str; 4] = [
    "base_from_flange.json",
    "base_from_flange.yaml",
    "base_from_flange.yml",
    "base_from_flange.txt",
];
/// The robot's base where no file names it, as `pomona calibrate` has it.
const BASE: &str = "base_link";
/// The same of its flange.
const FLANGE: &str = "flange";

/// The transform that the command line gives for all frames.
pub(crate) struct CameraPoses {
    of_all: Option<(PathBuf, AnyTransform)>,
}

/// The pose of one frame's camera; what the camera's frame is called is known when the frame is read.
#[derive(Clone, Debug)]
pub(crate) struct FramePose {
    source: Source,
    warnings: Vec<Warning>,
}

/// A transform and its file.
type Found = (PathBuf, AnyTransform);

#[derive(Clone, Debug)]
enum Source {
    /// The camera is fixed, or its pose at the shot is known.
    Camera(Box<Found>),
    /// It is on the flange, whose pose at the shot is known.
    OnFlange {
        flange: Box<Found>,
        camera: Box<Found>,
    },
}

impl CameraPoses {
    pub(crate) fn read(path: Option<&Path>) -> anyhow::Result<Self> {
        let of_all = path
            .map(|path| anyhow::Ok((path.to_owned(), AnyTransform::read(path)?)))
            .transpose()?;
        Ok(Self { of_all })
    }

    /// The pose of the camera of the frame in `folder`: that in the folder, else the flange's pose there with the
    /// transform for all, else the transform for all. `None` where there is none of them.
    pub(crate) fn of(&self, folder: &Path) -> anyhow::Result<Option<FramePose>> {
        let flange = present(folder, &FLANGE_POSE);
        if let Some(path) = present(folder, &OWN_POSE) {
            let own = leading_to_base(&path, AnyTransform::read(&path)?, folder)?;
            let mut pose = FramePose::new(Source::Camera(Box::new((path.clone(), own))));
            if self.of_all.is_some() || flange.is_some() {
                let message = format!(
                    "{} is taken as the camera's pose, and no other",
                    file_name(&path)
                );
                let warning = Warning::new(WarningCode::OwnPoseTaken, message);
                pose.warnings.push(warning);
            }
            return Ok(Some(pose));
        }
        let Some((path, camera)) = self.of_all.clone() else {
            return Ok(None);
        };
        let Some(flange_path) = flange else {
            let camera = leading_to_base(&path, camera, folder)?;
            return Ok(Some(FramePose::new(Source::Camera(Box::new((
                path, camera,
            ))))));
        };
        let flange = leading_to_base(&flange_path, AnyTransform::read(&flange_path)?, folder)?;
        check_joint(&flange_path, &flange, &path, &camera)?;
        Ok(Some(FramePose::new(Source::OnFlange {
            flange: Box::new((flange_path, flange)),
            camera: Box::new((path, camera)),
        })))
    }

    /// What is said where a frame's folder has the flange's pose and nothing tells where the camera is on it.
    pub(crate) fn unused(&self, folder: &Path) -> Option<Warning> {
        let flange = present(folder, &FLANGE_POSE).filter(|_| self.of_all.is_none())?;
        let message = format!(
            "{} is not used: give --transform flange_from_camera.json for answers in the robot's frame",
            file_name(&flange)
        );
        let own = present(folder, &OWN_POSE);
        let warning = Warning::new(WarningCode::FlangePoseUnused, message);
        own.is_none().then_some(warning)
    }
}

/// Refuses what leads to the flange where the robot's base is asked for.
fn leading_to_base(
    path: &Path,
    transform: AnyTransform,
    folder: &Path,
) -> anyhow::Result<AnyTransform> {
    if transform.leads_to_flange() {
        bail!(
            "{}: it leads to `{}`, on the robot's flange, and not to its base: a camera on the gripper needs the flange's \
             pose at the shot; put it into {} as base_from_flange.json",
            path.display(),
            transform.to.as_deref().unwrap_or(FLANGE),
            folder.display()
        );
    }
    Ok(transform)
}

/// Refuses a flange's pose and a camera's transform that do not meet in one frame.
fn check_joint(
    flange_path: &Path,
    flange: &AnyTransform,
    camera_path: &Path,
    camera: &AnyTransform,
) -> anyhow::Result<()> {
    let (Some(flange_frame), Some(camera_to)) = (&flange.from, &camera.to) else {
        return Ok(());
    };
    if flange_frame == camera_to {
        return Ok(());
    }
    let remedy = if flange.to.as_ref() == Some(camera_to) {
        "if the camera is fixed, remove the flange's pose from the frame's folder; if it is on the gripper, give \
         flange_from_camera"
    } else {
        "correct one of the names"
    };
    Err(anyhow!(
        "{}: it leads to `{camera_to}`, but the flange's pose in {} starts in `{flange_frame}`: {remedy}",
        camera_path.display(),
        flange_path.display()
    ))
}

impl FramePose {
    fn new(source: Source) -> Self {
        Self {
            source,
            warnings: Vec::new(),
        }
    }

    /// The robot's frame that it leads to.
    pub(crate) fn to(&self) -> &str {
        let (Source::Camera(base) | Source::OnFlange { flange: base, .. }) = &self.source;
        base.1.to.as_deref().unwrap_or(BASE)
    }

    /// The pose of the camera whose frame has this id.
    pub(crate) fn of_camera(&self, camera: &str) -> anyhow::Result<WithWarnings<RobotFromCamera>> {
        let mut warnings = self.warnings.clone();
        let pose = match &self.source {
            Source::Camera(found) => {
                let (path, transform) = &**found;
                transform
                    .named::<RobotFrame, CameraFrame>(BASE, camera)?
                    .in_file(path)
                    .append_to(&mut warnings)
            }
            Source::OnFlange {
                flange,
                camera: on_flange,
            } => {
                let ((flange_path, flange), (camera_path, on_flange)) = (&**flange, &**on_flange);
                let joint = flange.from.as_ref().or(on_flange.to.as_ref());
                let joint = joint.map_or(FLANGE, String::as_str);
                let flange = flange
                    .named::<RobotFrame, FlangeFrame>(BASE, joint)?
                    .in_file(flange_path)
                    .append_to(&mut warnings);
                let on_flange = on_flange
                    .named::<FlangeFrame, CameraFrame>(joint, camera)?
                    .in_file(camera_path)
                    .append_to(&mut warnings);
                joined(&flange, &on_flange)
            }
        };
        Ok(WithWarnings::new(pose, warnings))
    }
}

/// The camera's pose at the shot, with the covariance of both.
fn joined(
    flange: &NamedTransform<RobotFrame, FlangeFrame>,
    camera: &NamedTransform<FlangeFrame, CameraFrame>,
) -> RobotFromCamera {
    let UncertainTransform {
        transform,
        covariance,
    } = flange.uncertain() * camera.uncertain();
    let is_known = flange.covariance.is_some() || camera.covariance.is_some();
    let mut pose = RobotFromCamera::new(transform, &*flange.to, &*camera.from);
    pose.covariance = is_known.then_some(covariance);
    pose
}

fn present(folder: &Path, names: &[&str]) -> Option<PathBuf> {
    names
        .iter()
        .map(|name| folder.join(name))
        .find(|path| path.exists())
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}
