//! ROS camera information in YAML: the file that `camera_calibration` writes, and the
//! `sensor_msgs/CameraInfo` message as `ros2 topic echo` (or `rostopic echo`) prints it.

use super::{Camera, Distortion, assumed};
use pomona_files::{Malformed, WithWarnings};
use serde::Deserialize;

const REMEDY: &str = "give a camera_calibration file (image_width, image_height, camera_matrix, distortion_model, distortion_coefficients) or an echoed CameraInfo message (width, height, k, d, distortion_model)";

/// The union of both forms; what they hold beyond it is left alone.
#[derive(Deserialize)]
struct CameraInfo {
    #[serde(alias = "image_width")]
    width: usize,
    #[serde(alias = "image_height")]
    height: usize,
    #[serde(alias = "K", alias = "camera_matrix")]
    k: Numbers,
    #[serde(default, alias = "D", alias = "distortion_coefficients")]
    d: Numbers,
    #[serde(default)]
    distortion_model: String,
    #[serde(default)]
    header: Header,
    #[serde(default)]
    camera_name: Option<String>,
}

#[derive(Default, Deserialize)]
struct Header {
    #[serde(default)]
    frame_id: String,
}

/// Numbers, bare or in a `{rows, cols, data}` matrix.
#[derive(Deserialize)]
#[serde(untagged)]
enum Numbers {
    Bare(Vec<f64>),
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
        }
    }
}

pub(super) fn parse(text: &str) -> Result<WithWarnings<Camera>, Malformed> {
    let info: CameraInfo = serde_saphyr::from_str(first_document(text)).map_err(|e| {
        let place = e
            .location()
            .map_or_else(|| "YAML".to_owned(), |at| format!("line {}", at.line()));
        Malformed::new(place, e.without_snippet().to_string(), REMEDY)
    })?;
    let k = info.k.into_vec();
    let [fx, skew, cx, _, fy, cy, _, _, one] = k[..] else {
        let problem = format!("{} numbers where a 3x3 matrix has 9", k.len());
        return Err(Malformed::new("camera matrix", problem, REMEDY));
    };
    if skew != 0.0 || one != 1.0 {
        return Err(Malformed::new("camera matrix", "skewed or scaled", REMEDY));
    }
    let coefficients = info.d.into_vec();
    // Drivers of rectified images leave the coefficients out or write zeros.
    let distortion = coefficients
        .iter()
        .any(|&c| c != 0.0)
        .then_some(Distortion {
            model: info.distortion_model,
            coefficients,
        });
    // REP-118: 16-bit depth is in millimetres, which is what `new` takes.
    let mut camera = Camera::new([info.width, info.height], [fx, fy], [cx, cy]);
    camera.distortion = distortion;
    let mut warnings = Vec::new();
    let header = Some(info.header.frame_id);
    let named = header.filter(|id| !id.is_empty()).or(info.camera_name);
    match named {
        Some(frame_id) => camera.frame_id = frame_id,
        None => warnings.push(assumed::frame_id(&camera)),
    }
    warnings.push(assumed::depth_scale(&camera));
    Ok(WithWarnings::new(camera, warnings))
}

/// The text up to the `---` that ends a message in an echo of many.
fn first_document(text: &str) -> &str {
    let body = text.trim_start_matches('\u{feff}').trim_start();
    let body = body.strip_prefix("---").unwrap_or(body);
    body.find("\n---").map_or(body, |end| &body[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    const CALIBRATION: &str = "image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [500.5, 0.0, 320.0, 0.0, 501.0, 240.25, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.1, -0.2, 0.001, 0.002, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
";

    const ECHO: &str = "header:
  stamp:
    sec: 1632738484
    nanosec: 5
  frame_id: rgb_camera_link
height: 480
width: 640
distortion_model: rational_polynomial
d:
- 0.5
- -2.7
- 0.0007
- -0.0001
- 1.5
- 0.38
- -2.5
- 1.46
k: [500.5, 0.0, 320.0, 0.0, 501.0, 240.25, 0.0, 0.0, 1.0]
r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
binning_x: 0
roi:
  x_offset: 0
  do_rectify: false
---
header:
  frame_id: next
";

    #[test]
    fn reads_a_calibration_file() {
        let camera = parse(CALIBRATION).unwrap().value;
        assert_eq!(
            (camera.width, camera.height, camera.fx, camera.cy),
            (640, 480, 500.5, 240.25)
        );
        assert_eq!(
            (camera.frame_id.as_str(), camera.depth_scale),
            ("narrow_stereo", 0.001)
        );
        let distortion = camera.distortion.clone().unwrap();
        assert_eq!(distortion.coefficients, [0.1, -0.2, 0.001, 0.002, 0.0]);
        camera.validate().unwrap();
    }

    #[test]
    fn reads_an_echoed_message_up_to_the_next() {
        let camera = parse(ECHO).unwrap().value;
        assert_eq!(camera.frame_id, "rgb_camera_link");
        assert_eq!(
            camera.distortion.as_ref().unwrap().model,
            "rational_polynomial"
        );
        camera.validate().unwrap();
        let ros1 = ECHO.replace("\nk:", "\nK:").replace("\nd:", "\nD:");
        assert_eq!(parse(&ros1).unwrap().value, camera);
    }

    #[test]
    fn no_coefficients_are_no_distortion() {
        let none = CALIBRATION.replace("[0.1, -0.2, 0.001, 0.002, 0]", "[0, 0, 0, 0, 0]");
        assert_eq!(parse(&none).unwrap().value.distortion, None);
    }

    #[test]
    fn the_wrong_schema_is_refused() {
        let missing = CALIBRATION.replace("camera_matrix", "matrix");
        assert!(
            parse(&missing)
                .unwrap_err()
                .problem
                .contains("missing field")
        );
        let short = CALIBRATION.replace("240.25, 0.0, 0.0, 1.0", "240.25");
        assert!(parse(&short).unwrap_err().problem.contains("6 numbers"));
        for text in ["", "[", "a: b: c", "- 1", "{", "&a [*a]", "\u{0}"] {
            assert!(parse(text).is_err(), "{text:?}");
        }
    }
}
