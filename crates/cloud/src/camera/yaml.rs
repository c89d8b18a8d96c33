//! Cameras in YAML: the file that `camera_calibration` writes, the `sensor_msgs/CameraInfo` message as `ros2 topic echo`
//! (or `rostopic echo`) prints it, OpenCV's `FileStorage`, and Kalibr's camchain.

use super::draft::{Draft, Pinhole};
use super::info::{CameraInfo, REMEDY};
use super::options::CameraOptions;
use super::{Camera, Distortion};
use pomona_files::{Malformed, WithWarnings};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

const KALIBR_REMEDY: &str = "give the block of one camera: intrinsics [fx, fy, cx, cy], distortion_model, distortion_coeffs, resolution [width, height]";

pub(super) fn parse(
    text: &str,
    options: &CameraOptions,
) -> Result<WithWarnings<Camera>, Malformed> {
    let text = plain_yaml(first_document(text));
    if text.lines().any(|line| line.starts_with("cam0:")) {
        return kalibr(&text)?.camera(options);
    }
    let info: CameraInfo = from_yaml(&text, REMEDY)?;
    info.draft(options)?.camera(options)
}

fn from_yaml<T: DeserializeOwned>(text: &str, remedy: &str) -> Result<T, Malformed> {
    serde_saphyr::from_str(text).map_err(|e| {
        let place = e
            .location()
            .map_or_else(|| "YAML".to_owned(), |at| format!("line {}", at.line()));
        Malformed::new(place, e.without_snippet().to_string(), remedy)
    })
}

/// The text up to the `---` that ends a message in an echo of many. The directive before the first, which OpenCV writes
/// in a form of its own, is left out.
fn first_document(text: &str) -> &str {
    let mut body = text.trim_start();
    if body.starts_with("%YAML") {
        body = body
            .split_once('\n')
            .map_or("", |(_, rest)| rest)
            .trim_start();
    }
    let body = body.strip_prefix("---").unwrap_or(body);
    body.find("\n---").map_or(body, |end| &body[..end])
}

/// The text without the tags that OpenCV gives to its matrices.
fn plain_yaml(text: &str) -> String {
    text.replace("!!opencv-matrix", "")
}

/// One camera of Kalibr's camchain.
#[derive(Deserialize)]
struct KalibrCamera {
    #[serde(default)]
    camera_model: String,
    intrinsics: [f64; 4],
    #[serde(default)]
    distortion_model: String,
    #[serde(default)]
    distortion_coeffs: Vec<f64>,
    resolution: [usize; 2],
}

fn kalibr(text: &str) -> Result<Draft, Malformed> {
    let fault = |place: &str, problem: String| Malformed::new(place, problem, KALIBR_REMEDY);
    let mut chain: BTreeMap<String, KalibrCamera> = from_yaml(text, KALIBR_REMEDY)?;
    let first = chain.remove("cam0").filter(|_| chain.is_empty());
    let Some(camera) = first else {
        let problem = "several cameras; the frame has one".to_owned();
        return Err(fault("camchain", problem));
    };
    if !["", "pinhole"].contains(&&*camera.camera_model) {
        let problem = format!("`{}` where `pinhole` is known", camera.camera_model);
        return Err(fault("cam0: camera_model", problem));
    }
    let [fx, fy, cx, cy] = camera.intrinsics;
    let pinhole = Pinhole {
        focal: [fx, fy],
        center: [cx, cy],
    };
    let mut draft = Draft::new(camera.resolution, pinhole);
    draft.distortion = Distortion::from_file(&camera.distortion_model, camera.distortion_coeffs);
    Ok(draft)
}

#[cfg(test)]
mod tests {
    use super::super::options::ImageKind;
    use super::*;
    use pomona_files::WarningCode;

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

    fn read(text: &str) -> Result<Camera, Malformed> {
        Ok(parse(text, &CameraOptions::default())?.value)
    }

    fn codes(text: &str, options: &CameraOptions) -> Vec<WarningCode> {
        let warnings = parse(text, options).unwrap().warnings;
        warnings.iter().map(|w| w.code).collect()
    }

    #[test]
    fn reads_a_calibration_file() {
        let camera = read(CALIBRATION).unwrap();
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
        let ros1 = CALIBRATION.replace("distortion_model", "camera_model");
        assert_eq!(read(&ros1).unwrap(), camera);
    }

    #[test]
    fn reads_an_echoed_message_up_to_the_next() {
        let camera = read(ECHO).unwrap();
        assert_eq!(camera.frame_id, "rgb_camera_link");
        assert_eq!(
            camera.distortion.as_ref().unwrap().model,
            "rational_polynomial"
        );
        camera.validate().unwrap();
        let ros1 = ECHO.replace("\nk:", "\nK:").replace("\nd:", "\nD:");
        assert_eq!(read(&ros1).unwrap(), camera);
    }

    #[test]
    fn no_coefficients_are_no_distortion() {
        let none = CALIBRATION.replace("[0.1, -0.2, 0.001, 0.002, 0]", "[0, 0, 0, 0, 0]");
        assert_eq!(read(&none).unwrap().distortion, None);
    }

    #[test]
    fn the_wrong_schema_is_refused() {
        let missing = CALIBRATION.replace("camera_matrix", "matrix");
        assert!(
            read(&missing)
                .unwrap_err()
                .problem
                .contains("missing field")
        );
        let short = CALIBRATION.replace("240.25, 0.0, 0.0, 1.0", "240.25");
        assert!(read(&short).unwrap_err().problem.contains("6 numbers"));
        for text in ["", "[", "a: b: c", "- 1", "{", "&a [*a]", "\u{0}"] {
            assert!(read(text).is_err(), "{text:?}");
        }
    }

    #[test]
    fn opencv_file_storage_is_read() {
        let text = "%YAML:1.0\n---\ncalibration_time: \"Tue\"\nimage_width: 640\nimage_height: 480\n\
            camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 5.005e+02, 0., 320., 0., 501.,\n\
            \x20      240.25, 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n\
            \x20  data: [ 1.0e-01, -0.2, 1e-3, 0.002, 0. ]\navg_reprojection_error: 2.1e-01\n";
        let camera = read(text).unwrap();
        assert_eq!(
            (camera.fx, camera.fy, camera.cx, camera.cy),
            (500.5, 501.0, 320.0, 240.25)
        );
        assert_eq!(camera.distortion.as_ref().unwrap().model, "plumb_bob");
        let warned = codes(text, &CameraOptions::default());
        assert!(warned.contains(&WarningCode::DistortionModelAssumed));
        assert!(warned.contains(&WarningCode::FrameIdAssumed));
        let fisheye = text.replace("calibration_time: \"Tue\"", "fisheye_model: 1");
        let fisheye = fisheye.replace(", 0.002, 0. ]", ", 0.002 ]");
        let lens = read(&fisheye).unwrap().distortion.unwrap();
        assert_eq!((&*lens.model, lens.coefficients.len()), ("fisheye", 4));
    }

    #[test]
    fn rows_without_a_size_take_that_of_the_images() {
        let text = "camera_matrix: [[500.0, 0.0, 319.5], [0.0, 500.0, 239.5], [0.0, 0.0, 1.0]]\n\
            dist_coeff: [[0.1, -0.2, 0.001, 0.002, 0.05]]\n";
        assert!(read(text).unwrap_err().problem.contains("`width`"));
        let options = CameraOptions {
            image_size: Some([640, 480]),
            ..CameraOptions::default()
        };
        let read = parse(text, &options).unwrap();
        assert_eq!((read.value.width, read.value.height), (640, 480));
        assert_eq!(read.warnings[0].code, WarningCode::ImageSizeAssumed);
    }

    #[test]
    fn kalibr_names_its_models_its_own_way() {
        let text = "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.1, -0.2, 0.001, 0.002]\n  distortion_model: radtan\n\
            \x20 intrinsics: [500.5, 501.0, 320.0, 240.25]\n  resolution: [640, 480]\n  rostopic: /cam0/image_raw\n";
        let camera = read(text).unwrap();
        camera.validate().unwrap();
        assert_eq!((camera.fx, camera.cy, camera.height), (500.5, 240.25, 480));
        let two = format!("{text}{}", text.replace("cam0:", "cam1:"));
        assert!(read(&two).unwrap_err().problem.contains("several cameras"));
    }

    /// A message of a camera whose sensor has twice the images' pixels in each direction.
    fn message(size: [usize; 2], k: &str, p: &str, region: &str) -> String {
        format!(
            "header: {{frame_id: optical}}\nwidth: {}\nheight: {}\ndistortion_model: plumb_bob\nd: [0.0, 0.0, 0.0, 0.0, 0.0]\n\
             k: [{k}, 0.0, 0.0, 1.0]\np: [{p}, 0.0, 0.0, 1.0, 0.0]\n{region}\n",
            size[0], size[1]
        )
    }

    const SENSOR_K: &str = "1000.0, 0.0, 639.5, 0.0, 1000.0, 479.5";
    const NO_P: &str = "0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0";
    const BINNED: &str = "binning_x: 2\nbinning_y: 2";

    fn of_images(text: &str, size: [usize; 2]) -> Result<WithWarnings<Camera>, Malformed> {
        let options = CameraOptions {
            image_size: Some(size),
            ..CameraOptions::default()
        };
        parse(text, &options)
    }

    #[test]
    fn binning_joins_pixels_of_the_sensor() {
        let no_p = NO_P.replace(", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0", "");
        let text = message([1280, 960], SENSOR_K, NO_P, BINNED)
            .replace(&format!("p: [{NO_P}, 0.0, 0.0, 1.0, 0.0]"), "p: []");
        assert_eq!(no_p, "0.0");
        let read = of_images(&text, [640, 480]).unwrap();
        let camera = read.value;
        assert_eq!((camera.width, camera.fx, camera.cx), (640, 500.0, 319.5));
        assert_eq!((camera.height, camera.fy, camera.cy), (480, 500.0, 239.5));
        assert_eq!(read.warnings[0].code, WarningCode::SensorRegionApplied);
        assert!(read.warnings[0].message.contains("binning"));

        let fault = of_images(&text, [1280, 960]).unwrap_err();
        assert!(fault.place.contains("binning"), "{fault:?}");
        assert!(fault.problem.contains("640 x 480") && fault.remedy.contains('0'));
    }

    #[test]
    fn a_region_of_interest_moves_the_principal_point() {
        let roi = "roi: {x_offset: 320, y_offset: 240, width: 640, height: 480, do_rectify: false}";
        let text = message([1280, 960], SENSOR_K, SENSOR_K_AS_P, roi);
        let read = of_images(&text, [640, 480]).unwrap();
        let camera = read.value;
        assert_eq!((camera.width, camera.fx, camera.cx), (640, 1000.0, 319.5));
        assert_eq!((camera.height, camera.cy), (480, 239.5));
        assert_eq!(read.warnings.len(), 2, "the region and the depth unit");
        let outside = text.replace("x_offset: 320", "x_offset: 900");
        let fault = of_images(&outside, [640, 480]).unwrap_err();
        assert_eq!(fault.place, "roi");
    }

    const SENSOR_K_AS_P: &str = "1000.0, 0.0, 639.5, 0.0, 0.0, 1000.0, 479.5, 0.0";

    #[test]
    fn p_is_the_witness_where_sizes_disagree() {
        // The driver states the size of the images, and has binned P and not K.
        let p = "500.0, 0.0, 319.5, 0.0, 0.0, 500.0, 239.5, 0.0";
        let text = message([640, 480], SENSOR_K, p, BINNED);
        let read = of_images(&text, [640, 480]).unwrap();
        assert_eq!(
            (read.value.width, read.value.fx, read.value.cx),
            (640, 500.0, 319.5)
        );
        let doubtful = message([640, 480], SENSOR_K, SENSOR_K_AS_P, BINNED);
        assert!(of_images(&doubtful, [640, 480]).is_err());
    }

    #[test]
    fn images_are_raw_or_rectified() {
        let p = "480.0, 0.0, 310.0, 0.0, 0.0, 480.0, 230.0, 0.0";
        let text = format!(
            "{CALIBRATION}projection_matrix:\n  rows: 3\n  cols: 4\n  data: [{p}, 0.0, 0.0, 1.0, 0.0]\n"
        );
        let of = |images| CameraOptions {
            images,
            ..CameraOptions::default()
        };
        let raw = parse(&text, &of(Some(ImageKind::Raw))).unwrap();
        assert_eq!(
            (raw.value.fx, raw.value.distortion.is_some()),
            (500.5, true)
        );
        let rectified = parse(&text, &of(Some(ImageKind::Rectified))).unwrap();
        assert_eq!(
            (rectified.value.fx, rectified.value.distortion),
            (480.0, None)
        );
        let unsaid = parse(&text, &of(None)).unwrap();
        assert_eq!(unsaid.value, raw.value);
        assert!(codes(&text, &of(None)).contains(&WarningCode::RawImagesAssumed));
        for said in [ImageKind::Raw, ImageKind::Rectified] {
            assert_eq!(
                codes(&text, &of(Some(said))),
                [WarningCode::DepthScaleAssumed]
            );
        }
        let without_p = parse(CALIBRATION, &of(Some(ImageKind::Rectified)));
        assert_eq!(without_p.unwrap_err().place, "projection matrix");
    }

    #[test]
    fn a_camera_that_is_not_calibrated_has_its_projection_matrix_or_none() {
        let zero = "0.0, 0.0, 0.0, 0.0, 0.0, 0.0";
        let text = message([1280, 960], zero, SENSOR_K_AS_P, "")
            .replace("0.0, 0.0, 1.0]\np", "0.0, 0.0, 0.0]\np");
        let read = parse(&text, &CameraOptions::default()).unwrap();
        assert_eq!((read.value.fx, read.value.cx), (1000.0, 639.5));
        assert_eq!(read.warnings[0].code, WarningCode::ProjectionMatrixTaken);
        let neither = text
            .replace(SENSOR_K_AS_P, NO_P)
            .replace("1.0, 0.0]", "0.0, 0.0]");
        let fault = parse(&neither, &CameraOptions::default()).unwrap_err();
        assert!(fault.problem.contains("all zero"), "{fault:?}");
    }
}
