//! What a camera file of any form says, and the camera that is made of it.

use super::options::{CameraOptions, ImageKind};
use super::{Camera, Distortion, Lens, assumed};
use pomona_files::{Malformed, Warning, WarningCode, WithWarnings};

/// Focal lengths and principal point along x and y, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pinhole {
    pub(super) focal: [f64; 2],
    pub(super) center: [f64; 2],
}

/// What a file says.
#[derive(Debug)]
pub(super) struct Draft {
    /// Width and height of the images.
    pub(super) size: [usize; 2],
    pub(super) pinhole: Pinhole,
    /// The lens of the images that the numbers are for.
    pub(super) distortion: Option<Distortion>,
    pub(super) frame_id: Option<String>,
    /// As the file has it: metres per unit, or units per metre.
    pub(super) depth_scale: Option<f64>,
    /// Whether the numbers are for the images that the options ask for.
    pub(super) images_known: bool,
    pub(super) warnings: Vec<Warning>,
}

impl Draft {
    pub(super) fn new(size: [usize; 2], pinhole: Pinhole) -> Self {
        Self {
            size,
            pinhole,
            distortion: None,
            frame_id: None,
            depth_scale: None,
            images_known: false,
            warnings: Vec::new(),
        }
    }

    /// The camera; what neither file nor options say is assumed.
    pub(super) fn camera(
        mut self,
        options: &CameraOptions,
    ) -> Result<WithWarnings<Camera>, Malformed> {
        if options.images == Some(ImageKind::Rectified)
            && !self.images_known
            && self.distortion.is_some()
        {
            return Err(Malformed::new(
                "distortion",
                "the images are said to be rectified, and the file gives the lens of raw ones and no projection matrix P",
                "give the numbers of the rectified images, without distortion",
            ));
        }
        let Pinhole { focal, center } = self.pinhole;
        let mut camera = Camera::new(self.size, focal, center);
        camera.distortion = self.distortion;
        match self.frame_id.filter(|id| !id.is_empty()) {
            Some(frame_id) => camera.frame_id = frame_id,
            None => self.warnings.push(assumed::frame_id(&camera)),
        }
        match options.depth_scale.or(self.depth_scale) {
            Some(value) => camera.depth_scale = metres_per_unit(value),
            // Of Open3D and of REP-118, and what `new` takes.
            None => self.warnings.push(assumed::depth_scale(&camera)),
        }
        if matches!(camera.lens(), Ok(Lens::InverseRadial { .. })) {
            let message = "`inverse_brown_conrady` is read as its documentation says, from pixels to rays, but some \
                           drivers give this name to coefficients of `brown_conrady`: if a straight edge near the image's \
                           border is bent in a cloud, give that model";
            let warning = Warning::new(WarningCode::InverseLens, message);
            self.warnings.push(warning);
        }
        Ok(WithWarnings::new(camera, self.warnings))
    }
}

/// Metres of a unit of the depth image, from a number that is so small, or counts units in a metre: no camera has units
/// of more than a metre.
fn metres_per_unit(value: f64) -> f64 {
    if value > 1.0 { 1.0 / value } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_depth_scale_means_the_same_either_way() {
        assert_eq!(metres_per_unit(0.00025), 0.00025);
        assert_eq!(metres_per_unit(4000.0), 0.00025);
        // What makes no sense stays and is refused by its value.
        assert_eq!(metres_per_unit(-1.0), -1.0);
        assert!(metres_per_unit(f64::NAN).is_nan());
    }

    #[test]
    fn options_come_before_the_file() {
        let pinhole = Pinhole {
            focal: [500.0; 2],
            center: [319.5, 239.5],
        };
        let mut draft = Draft::new([640, 480], pinhole);
        draft.depth_scale = Some(0.001);
        let options = CameraOptions {
            depth_scale: Some(5000.0),
            ..CameraOptions::default()
        };
        let camera = draft.camera(&options).unwrap();
        assert_eq!(camera.value.depth_scale, 0.0002);
        assert_eq!(camera.warnings.len(), 1, "the frame alone");
    }
}
