//! The numbers of a ROS `CameraInfo`, of the file that `camera_calibration` writes, and of OpenCV's `FileStorage`: the
//! same under different names, in YAML or JSON.

use super::Distortion;
use super::draft::{Draft, Pinhole};
use super::options::{CameraOptions, ImageKind};
use super::region::{Region, Roi};
use pomona_files::{Malformed, Warning, WarningCode};
use serde::Deserialize;

pub(super) const REMEDY: &str = "give a camera_calibration file (image_width, image_height, camera_matrix, distortion_model, distortion_coefficients), an echoed CameraInfo message (width, height, k, d, distortion_model), or an OpenCV FileStorage with camera_matrix";

/// The union of the forms; what they hold beyond it is left alone.
#[derive(Deserialize)]
pub(super) struct CameraInfo {
    #[serde(alias = "image_width", alias = "image_Width")]
    width: Option<usize>,
    #[serde(alias = "image_height", alias = "image_Height")]
    height: Option<usize>,
    #[serde(
        alias = "K",
        alias = "camera_matrix",
        alias = "Camera_Matrix",
        alias = "cameraMatrix"
    )]
    k: Option<Numbers>,
    #[serde(
        default,
        alias = "D",
        alias = "distortion_coefficients",
        alias = "Distortion_Coefficients",
        alias = "distCoeffs",
        alias = "dist_coeffs",
        alias = "dist_coeff"
    )]
    d: Numbers,
    #[serde(default, alias = "P", alias = "projection_matrix")]
    p: Numbers,
    #[serde(alias = "camera_model")]
    distortion_model: Option<String>,
    #[serde(default)]
    fisheye_model: f64,
    #[serde(default)]
    header: Header,
    #[serde(alias = "camera_name")]
    frame_id: Option<String>,
    #[serde(default)]
    binning_x: usize,
    #[serde(default)]
    binning_y: usize,
    #[serde(default)]
    roi: Roi,
    depth_scale: Option<f64>,
}

#[derive(Default, Deserialize)]
struct Header {
    #[serde(default)]
    frame_id: String,
}

/// Numbers: bare, row by row, or in a `{rows, cols, data}` matrix.
#[derive(Deserialize)]
#[serde(untagged)]
enum Numbers {
    Bare(Vec<f64>),
    Rows(Vec<Vec<f64>>),
    Matrix { data: Vec<f64> },
}

impl Default for Numbers {
    fn default() -> Self {
        Self::Bare(Vec::new())
    }
}

impl Numbers {
    fn into_vec(self) -> Vec<f64> {
        match self {
            Self::Bare(data) | Self::Matrix { data } => data,
            Self::Rows(rows) => rows.concat(),
        }
    }
}

/// The camera in a matrix of three rows; `None` for one of zeros, which says that there is no calibration.
fn pinhole(name: &str, numbers: &[f64]) -> Result<Option<Pinhole>, Malformed> {
    let columns = numbers.len() / 3;
    if !numbers.len().is_multiple_of(3) || !(3..=4).contains(&columns) {
        let problem = format!("{} numbers where a 3x3 matrix has 9", numbers.len());
        return Err(Malformed::new(name, problem, REMEDY));
    }
    let at = |row: usize, column: usize| numbers[row * columns + column];
    if numbers.iter().all(|&n| n == 0.0) {
        return Ok(None);
    }
    if at(0, 1) != 0.0 || at(2, 2) != 1.0 {
        return Err(Malformed::new(name, "skewed or scaled", REMEDY));
    }
    Ok(Some(Pinhole {
        focal: [at(0, 0), at(1, 1)],
        center: [at(0, 2), at(1, 2)],
    }))
}

impl CameraInfo {
    pub(super) fn draft(self, options: &CameraOptions) -> Result<Draft, Malformed> {
        let mut warnings = Vec::new();
        let stated = match (self.width, self.height) {
            (Some(width), Some(height)) => [width, height],
            _ => size_of_images(options, &mut warnings)?,
        };
        let Some(k) = self.k else {
            let problem = "missing field `k` (or `camera_matrix`)";
            return Err(Malformed::new("camera matrix", problem, REMEDY));
        };
        let camera_matrix = pinhole("camera matrix", &k.into_vec())?;
        let p = self.p.into_vec();
        let projection = if p.is_empty() {
            None
        } else {
            pinhole("projection matrix", &p)?
        };
        let coefficients = self.d.into_vec();
        let model = match self.distortion_model.unwrap_or_default() {
            named if named.is_empty() && self.fisheye_model != 0.0 => "fisheye".to_owned(),
            named => named,
        };
        let is_named = !model.is_empty();
        let distortion = Distortion::from_file(&model, coefficients);
        if let (Some(taken), false) = (&distortion, is_named) {
            let message = format!(
                "no model of distortion; {} coefficients are taken to be those of `{}`",
                taken.coefficients.len(),
                taken.model
            );
            warnings.push(Warning::new(WarningCode::DistortionModelAssumed, message));
        }

        // A camera that is not calibrated has zeros in K; rectified images need none.
        let Some(of_sensor) = camera_matrix.or(projection) else {
            return Err(Malformed::new(
                "camera matrix",
                "all zero, which drivers write for a camera that is not calibrated",
                "calibrate the camera, or copy the intrinsics that its maker gives",
            ));
        };
        let region = Region::new(stated, [self.binning_x, self.binning_y], self.roi);
        let seen = region.seen(of_sensor, projection, options.image_size)?;
        if let Some(applied) = seen.applied {
            let Pinhole { focal, center } = seen.camera_matrix;
            let message = format!(
                "{applied} is applied to the sensor's numbers: focal lengths {:.1} x {:.1} px, principal point \
                 ({:.1}, {:.1})",
                focal[0], focal[1], center[0], center[1]
            );
            warnings.push(Warning::new(WarningCode::SensorRegionApplied, message));
        }
        let choice = Choice {
            raw: camera_matrix.map(|_| seen.camera_matrix),
            rectified: seen.projection,
            distortion,
        };
        let (pinhole, distortion) = choice.taken(options.images, &mut warnings)?;
        let mut draft = Draft::new(seen.size, pinhole);
        draft.distortion = distortion;
        draft.images_known = true;
        draft.frame_id = Some(self.header.frame_id)
            .filter(|id| !id.is_empty())
            .or(self.frame_id);
        draft.depth_scale = self.depth_scale;
        draft.warnings = warnings;
        Ok(draft)
    }
}

/// The size of the images, for a file that gives none.
fn size_of_images(
    options: &CameraOptions,
    warnings: &mut Vec<Warning>,
) -> Result<[usize; 2], Malformed> {
    let Some(size) = options.image_size else {
        let problem = "missing field `width` or `height` (or `image_width`, `image_height`)";
        return Err(Malformed::new("image size", problem, REMEDY));
    };
    let message = format!(
        "no image size; the numbers are taken to be for images of {} x {}, as the frame has them",
        size[0], size[1]
    );
    warnings.push(Warning::new(WarningCode::ImageSizeAssumed, message));
    Ok(size)
}

/// Two descriptions of one camera: of its raw images, and of rectified ones.
struct Choice {
    raw: Option<Pinhole>,
    rectified: Option<Pinhole>,
    distortion: Option<Distortion>,
}

impl Choice {
    /// The one that is asked for; raw where nothing is said, with a warning where it matters.
    fn taken(
        self,
        images: Option<ImageKind>,
        warnings: &mut Vec<Warning>,
    ) -> Result<(Pinhole, Option<Distortion>), Malformed> {
        match (images, self.raw, self.rectified) {
            (Some(ImageKind::Rectified), _, Some(rectified)) => Ok((rectified, None)),
            (Some(ImageKind::Rectified), Some(raw), None) if self.distortion.is_none() => {
                Ok((raw, None))
            }
            (Some(ImageKind::Rectified), _, None) => Err(Malformed::new(
                "projection matrix",
                "the images are said to be rectified, and the file has no projection matrix P",
                "give P, or the numbers of the rectified images without distortion",
            )),
            (Some(ImageKind::Raw), None, _) => Err(Malformed::new(
                "camera matrix",
                "the images are said to be raw, and the camera matrix K is zero",
                "calibrate the camera, or say that the images are rectified",
            )),
            (None, None, Some(rectified)) => {
                let message = "the camera matrix K is zero, and the projection matrix P is taken: the images are taken to \
                               be rectified";
                warnings.push(Warning::new(WarningCode::ProjectionMatrixTaken, message));
                Ok((rectified, None))
            }
            (None, Some(raw), Some(rectified)) if !raw.is_about(&rectified) => {
                warnings.push(raw_or_rectified(
                    &raw,
                    &rectified,
                    self.distortion.is_some(),
                ));
                Ok((raw, self.distortion))
            }
            (_, Some(raw), _) => Ok((raw, self.distortion)),
            // There is one of both.
            (None, None, None) => Err(Malformed::new("camera matrix", "missing", REMEDY)),
        }
    }
}

fn raw_or_rectified(raw: &Pinhole, rectified: &Pinhole, bends: bool) -> Warning {
    let lens = if bends { " and the lens" } else { "" };
    let message = format!(
        "the images are taken to be raw: K{lens} (fx {:.1}, cx {:.1}) and not P (fx {:.1}, cx {:.1}); say `--images \
         rectified` if they are rectified (image_rect), `--images raw` if not",
        raw.focal[0], raw.center[0], rectified.focal[0], rectified.center[0]
    );
    Warning::new(WarningCode::RawImagesAssumed, message)
}
