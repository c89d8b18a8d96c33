//! Cameras in JSON: the project's own `camera.json`, Open3D's `PinholeCameraIntrinsic`, the intrinsics of `RealSense`, and
//! a ROS `CameraInfo`.

use super::draft::{Draft, Pinhole};
use super::info::{self, CameraInfo};
use super::options::CameraOptions;
use super::{Camera, Distortion};
use pomona_files::{Malformed, WithWarnings};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

const REMEDY: &str = "give width, height, fx, fy, cx, cy, depth_scale, frame_id and, where the lens bends, distortion: {model, coefficients}";
const OPEN3D_REMEDY: &str =
    "give width, height and intrinsic_matrix: [fx, 0, 0, 0, fy, 0, cx, cy, 1]";
const REALSENSE_REMEDY: &str =
    "give width, height, fx, fy, ppx, ppy, model, coeffs and, beside them, depth_scale";

pub(super) fn parse(
    text: &str,
    options: &CameraOptions,
) -> Result<WithWarnings<Camera>, Malformed> {
    let value: Value = from_json(text, REMEDY)?;
    let has = |keys: &[&str]| keys.iter().any(|key| value.get(key).is_some());
    let draft = if has(&["intrinsic_matrix"]) {
        from_json::<Open3d>(text, OPEN3D_REMEDY)?.draft()?
    } else if has(&["k", "K", "camera_matrix", "cameraMatrix", "p", "P"]) {
        from_json::<CameraInfo>(text, info::REMEDY)?.draft(options)?
    } else if has(&["ppx", "ppy"]) {
        from_json::<RealSense>(text, REALSENSE_REMEDY)?.draft()
    } else {
        from_json::<Own>(text, REMEDY)?.draft(options)?
    };
    draft.camera(options)
}

fn from_json<T: DeserializeOwned>(text: &str, remedy: &str) -> Result<T, Malformed> {
    serde_json::from_str(text).map_err(|e| {
        Malformed::new(
            format!("line {} column {}", e.line(), e.column()),
            e.to_string(),
            remedy,
        )
    })
}

pub(super) fn format(camera: &Camera) -> String {
    // A struct of numbers and strings always serialises.
    serde_json::to_string_pretty(camera).unwrap_or_default() + "\n"
}

/// The project's own form, with what it may leave out.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Own {
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    depth_scale: Option<f64>,
    frame_id: Option<String>,
    distortion: Option<Distortion>,
}

impl Own {
    fn draft(self, options: &CameraOptions) -> Result<Draft, Malformed> {
        if self.depth_scale.is_none() && options.depth_scale.is_none() {
            let problem = "missing field `depth_scale`";
            return Err(Malformed::new("`depth_scale`", problem, REMEDY));
        }
        let pinhole = Pinhole {
            focal: [self.fx, self.fy],
            center: [self.cx, self.cy],
        };
        let mut draft = Draft::new([self.width, self.height], pinhole);
        draft.depth_scale = self.depth_scale;
        draft.frame_id = self.frame_id;
        draft.distortion = self.distortion;
        Ok(draft)
    }
}

/// `rs2_intrinsics`, as scripts write it; others of their fields are left alone.
#[derive(Deserialize)]
struct RealSense {
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    ppx: f64,
    ppy: f64,
    #[serde(default, alias = "distortion_model")]
    model: String,
    #[serde(default, alias = "coefficients")]
    coeffs: Vec<f64>,
    depth_scale: Option<f64>,
    frame_id: Option<String>,
}

impl RealSense {
    fn draft(self) -> Draft {
        let pinhole = Pinhole {
            focal: [self.fx, self.fy],
            center: [self.ppx, self.ppy],
        };
        let mut draft = Draft::new([self.width, self.height], pinhole);
        draft.distortion = Distortion::from_file(&self.model, self.coeffs);
        draft.depth_scale = self.depth_scale;
        draft.frame_id = self.frame_id;
        draft
    }
}

/// Open3D writes the matrix column by column; its recordings add further fields, among them `depth_scale`, in units per
/// metre.
#[derive(Deserialize)]
struct Open3d {
    width: usize,
    height: usize,
    intrinsic_matrix: [f64; 9],
    depth_scale: Option<f64>,
}

impl Open3d {
    fn draft(self) -> Result<Draft, Malformed> {
        let fault = |problem: &str| Malformed::new("`intrinsic_matrix`", problem, OPEN3D_REMEDY);
        let [fx, skew, low, below, fy, low2, cx, cy, one] = self.intrinsic_matrix;
        // Row by row, the principal point would stand here.
        if low != 0.0 || low2 != 0.0 {
            return Err(fault("not the matrix column by column"));
        }
        if skew != 0.0 || below != 0.0 || one != 1.0 {
            return Err(fault("a skewed or scaled matrix"));
        }
        let pinhole = Pinhole {
            focal: [fx, fy],
            center: [cx, cy],
        };
        let mut draft = Draft::new([self.width, self.height], pinhole);
        draft.depth_scale = self.depth_scale;
        Ok(draft)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_files::WarningCode;

    const CAMERA: &str = r#"{"width":640,"height":480,"fx":500.5,"fy":501,"cx":320,"cy":240.25,
        "depth_scale":0.001,"frame_id":"optical"}"#;

    fn read(text: &str) -> Result<WithWarnings<Camera>, Malformed> {
        parse(text, &CameraOptions::default())
    }

    fn alone(camera: &Camera) -> WithWarnings<Camera> {
        WithWarnings::new(camera.clone(), Vec::new())
    }

    #[test]
    fn reads_what_it_writes() {
        let mut camera = read(CAMERA).unwrap().value;
        assert_eq!(read(&format(&camera)).unwrap(), alone(&camera));
        camera.distortion = Some(Distortion {
            model: "plumb_bob".to_owned(),
            coefficients: vec![0.1, -0.2, 0.001, 0.002, 0.05],
        });
        assert_eq!(read(&format(&camera)).unwrap(), alone(&camera));
    }

    #[test]
    fn a_frame_that_is_not_named_is_assumed_and_said() {
        let unnamed = CAMERA.replace(r#","frame_id":"optical""#, "");
        assert!(!unnamed.contains("optical"));
        let read = read(&unnamed).unwrap();
        assert_eq!(read.value.frame_id, "camera_color_optical_frame");
        assert_eq!(read.warnings[0].code, WarningCode::FrameIdAssumed);
        assert!(read.warnings[0].message.contains("frame_id"));
        assert_eq!(read.warnings.len(), 1);
    }

    #[test]
    fn the_wrong_schema_names_the_field() {
        let unknown = CAMERA.replace("\"fx\"", "\"focal\"");
        assert!(read(&unknown).unwrap_err().problem.contains("`focal`"));
        let missing = CAMERA.replace("\"fx\":500.5,", "");
        assert!(read(&missing).unwrap_err().problem.contains("`fx`"));
        let scale = CAMERA.replace("\"depth_scale\":0.001,", "");
        assert!(read(&scale).unwrap_err().problem.contains("`depth_scale`"));
        let text = CAMERA.replace("500.5", "\"wide\"");
        assert!(read(&text).unwrap_err().place.starts_with("line 1"));
        assert!(read("[]").is_err());
        assert!(read("").is_err());
    }

    #[test]
    fn open3d_counts_units_in_a_metre_and_stands_column_by_column() {
        let text = r#"{"width":640,"height":480,"fps":30.0,"depth_scale":5000.0,
            "intrinsic_matrix":[525,0,0,0,526,0,319.5,239.5,1]}"#;
        let WithWarnings {
            value: camera,
            warnings,
            ..
        } = read(text).unwrap();
        assert_eq!(warnings.len(), 1, "the frame alone: {warnings:?}");
        assert_eq!(
            (camera.fx, camera.fy, camera.cx, camera.cy),
            (525.0, 526.0, 319.5, 239.5)
        );
        assert_eq!(camera.depth_scale, 0.0002);
        let silent = read(&text.replace(r#""depth_scale":5000.0,"#, "")).unwrap();
        assert_eq!(silent.value.depth_scale, 0.001);
        assert_eq!(silent.warnings[1].code, WarningCode::DepthScaleAssumed);
        let by_rows = text.replace(
            "525,0,0,0,526,0,319.5,239.5,1",
            "525,0,319.5,0,526,239.5,0,0,1",
        );
        assert!(
            read(&by_rows)
                .unwrap_err()
                .problem
                .contains("column by column")
        );
        assert!(read(r#"{"intrinsic_matrix":[1,2]}"#).is_err());
    }

    #[test]
    fn a_depth_scale_means_the_same_in_every_form() {
        let open3d = r#"{"width":640,"height":480,"depth_scale":SCALE,
            "intrinsic_matrix":[525,0,0,0,525,0,319.5,239.5,1]}"#;
        let realsense = r#"{"width":640,"height":480,"fx":525,"fy":525,"ppx":319.5,"ppy":239.5,"depth_scale":SCALE}"#;
        let info =
            r#"{"width":640,"height":480,"k":[525,0,319.5,0,525,239.5,0,0,1],"depth_scale":SCALE}"#;
        let own = CAMERA.replace("0.001", "SCALE");
        for form in [open3d, realsense, info, &own] {
            for scale in ["0.00025", "4000", "4000.0"] {
                let camera = read(&form.replace("SCALE", scale)).unwrap().value;
                assert_eq!(camera.depth_scale, 0.00025, "{form}");
            }
        }
    }

    #[test]
    fn intrinsics_of_realsense_are_read() {
        let text = r#"{"width":640,"height":480,"ppx":320.5,"ppy":240.25,"fx":610.5,"fy":611,
            "model":"distortion.inverse_brown_conrady","coeffs":[0.0,0.0,0.0,0.0,0.0]}"#;
        let read_all = read(text).unwrap();
        let codes: Vec<_> = read_all.warnings.iter().map(|w| w.code).collect();
        assert_eq!(
            codes,
            [WarningCode::FrameIdAssumed, WarningCode::DepthScaleAssumed]
        );
        let camera = read_all.value;
        assert_eq!((camera.fx, camera.cx, camera.cy), (610.5, 320.5, 240.25));
        assert_eq!(camera.distortion, None);
        let bent = text.replace("[0.0,", "[-0.05,");
        let bent = read(&bent).unwrap();
        assert!(
            bent.warnings
                .iter()
                .any(|w| w.code == WarningCode::InverseLens)
        );
        bent.value.validate().unwrap();
    }

    #[test]
    fn a_message_is_read_as_json() {
        let text = r#"{"header":{"stamp":{"sec":1,"nanosec":2},"frame_id":"optical"},"height":480,"width":640,
            "distortion_model":"plumb_bob","d":[0.1,-0.2,0.001,0.002,0.05],
            "k":[500.5,0,320,0,501,240.25,0,0,1],"r":[1,0,0,0,1,0,0,0,1],
            "p":[500.5,0,320,0,0,501,240.25,0,0,0,1,0],"binning_x":0,"binning_y":0,
            "roi":{"x_offset":0,"y_offset":0,"height":0,"width":0,"do_rectify":false}}"#;
        let camera = read(text).unwrap().value;
        assert_eq!((camera.fx, &*camera.frame_id), (500.5, "optical"));
        assert_eq!(camera.distortion.unwrap().coefficients[4], 0.05);
    }
}
