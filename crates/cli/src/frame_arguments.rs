//! What the command line says about frames beside their files.

use clap::{Args, ValueEnum};
use pomona_cloud::{
    BoxChoice, BoxSource, CameraOptions, CloudError, Frame, FrameOptions, ImageKind,
};
use std::path::Path;

/// Which images a camera file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Images {
    /// As the lens gave them: camera matrix K and distortion D.
    Raw,
    /// Rectified: projection matrix P.
    Rectified,
}

/// Flags that hold for every frame of a run.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Frames")]
pub(crate) struct FrameArguments {
    /// Metres per unit of the depth image (0.001), or units per metre (1000), in place of what the camera's file says.
    #[arg(long, value_name = "SCALE", value_parser = positive)]
    depth_scale: Option<f64>,
    /// Whether the images are raw or rectified, for a ROS `CameraInfo` that describes both (K with D, and P).
    #[arg(long, value_enum, value_name = "KIND")]
    images: Option<Images>,
}

impl FrameArguments {
    /// Reads the frame in `folder`, with its own boxes.
    pub(crate) fn read(self, folder: &Path) -> Result<Frame, CloudError> {
        self.read_with(folder, BoxSource::Own, BoxChoice::default())
    }

    /// The same without boxes.
    pub(crate) fn without_boxes(self, folder: &Path) -> Result<Frame, CloudError> {
        self.read_with(folder, BoxSource::Nowhere, BoxChoice::default())
    }

    /// The same with the boxes that `choice` takes from `boxes`.
    pub(crate) fn read_with(
        self,
        folder: &Path,
        boxes: BoxSource,
        choice: BoxChoice,
    ) -> Result<Frame, CloudError> {
        Frame::read_with(folder, &FrameOptions::new(self.camera(), boxes, choice))
    }

    /// What is said about the camera.
    pub(crate) fn camera(self) -> CameraOptions {
        let mut options = CameraOptions::default();
        options.depth_scale = self.depth_scale;
        options.images = self.images.map(|images| match images {
            Images::Raw => ImageKind::Raw,
            Images::Rectified => ImageKind::Rectified,
        });
        options
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("give a positive number, such as 0.001 or 1000".to_owned()),
    }
}
