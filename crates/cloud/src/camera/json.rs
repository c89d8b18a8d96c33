//! The project's own `camera.json`, and Open3D's `PinholeCameraIntrinsic` JSON in its place.

use super::{Camera, Distortion, assumed};
use pomona_files::{Malformed, WithWarnings};
use serde::Deserialize;
use serde_json::Value;

const REMEDY: &str = "give width, height, fx, fy, cx, cy, depth_scale, frame_id and, where the lens bends, distortion: {model, coefficients}";
const OPEN3D_REMEDY: &str =
    "give width, height and intrinsic_matrix: [fx, 0, 0, 0, fy, 0, cx, cy, 1]";

pub(super) fn parse(text: &str) -> Result<WithWarnings<Camera>, Malformed> {
    let fault = |e: serde_json::Error, remedy: &str| {
        Malformed::new(
            format!("line {} column {}", e.line(), e.column()),
            e.to_string(),
            remedy,
        )
    };
    let value: Value = serde_json::from_str(text).map_err(|e| fault(e, REMEDY))?;
    if value.get("intrinsic_matrix").is_some() {
        let intrinsic: Open3d = serde_json::from_str(text).map_err(|e| fault(e, OPEN3D_REMEDY))?;
        return intrinsic.into_camera();
    }
    let own: Own = serde_json::from_str(text).map_err(|e| fault(e, REMEDY))?;
    Ok(own.into_camera())
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
    depth_scale: f64,
    frame_id: Option<String>,
    distortion: Option<Distortion>,
}

impl Own {
    fn into_camera(self) -> WithWarnings<Camera> {
        let size = [self.width, self.height];
        let mut camera = Camera::new(size, [self.fx, self.fy], [self.cx, self.cy]);
        camera.depth_scale = self.depth_scale;
        camera.distortion = self.distortion;
        let mut warnings = Vec::new();
        match self.frame_id {
            Some(frame_id) => camera.frame_id = frame_id,
            None => warnings.push(assumed::frame_id(&camera)),
        }
        WithWarnings::new(camera, warnings)
    }
}

pub(super) fn format(camera: &Camera) -> String {
    // A struct of numbers and strings always serialises.
    serde_json::to_string_pretty(camera).unwrap_or_default() + "\n"
}

/// Open3D writes the matrix column by column; its recordings add further fields, one of
/// which, `depth_scale`, counts depth units in a metre.
#[derive(Deserialize)]
struct Open3d {
    width: usize,
    height: usize,
    intrinsic_matrix: [f64; 9],
    depth_scale: Option<f64>,
}

impl Open3d {
    fn into_camera(self) -> Result<WithWarnings<Camera>, Malformed> {
        let fault = |problem: &str| Malformed::new("`intrinsic_matrix`", problem, OPEN3D_REMEDY);
        let [fx, skew, low, below, fy, low2, cx, cy, one] = self.intrinsic_matrix;
        // Row by row, the principal point would stand here.
        if low != 0.0 || low2 != 0.0 {
            return Err(fault("not the matrix column by column"));
        }
        if skew != 0.0 || below != 0.0 || one != 1.0 {
            return Err(fault("a skewed or scaled matrix"));
        }
        let mut camera = Camera::new([self.width, self.height], [fx, fy], [cx, cy]);
        let mut warnings = vec![assumed::frame_id(&camera)];
        match self.depth_scale {
            Some(units_per_metre) => camera.depth_scale = 1.0 / units_per_metre,
            None => warnings.push(assumed::depth_scale(&camera)),
        }
        Ok(WithWarnings::new(camera, warnings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_files::WarningCode;

    const CAMERA: &str = r#"{"width":640,"height":480,"fx":500.5,"fy":501,"cx":320,"cy":240.25,
        "depth_scale":0.001,"frame_id":"optical"}"#;

    #[test]
    fn reads_what_it_writes() {
        let mut camera = parse(CAMERA).unwrap().value;
        assert_eq!(parse(&format(&camera)).unwrap(), camera_alone(&camera));
        camera.distortion = Some(Distortion {
            model: "plumb_bob".to_owned(),
            coefficients: vec![0.1, -0.2, 0.001, 0.002, 0.05],
        });
        assert_eq!(parse(&format(&camera)).unwrap(), camera_alone(&camera));
    }

    fn camera_alone(camera: &Camera) -> WithWarnings<Camera> {
        WithWarnings::new(camera.clone(), Vec::new())
    }

    #[test]
    fn a_frame_that_is_not_named_is_assumed_and_said() {
        let unnamed = CAMERA.replace(r#","frame_id":"optical""#, "");
        let read = parse(&unnamed).unwrap();
        assert_eq!(read.value.frame_id, "camera_color_optical_frame");
        assert_eq!(read.warnings[0].code, WarningCode::FrameIdAssumed);
        assert!(read.warnings[0].message.contains("frame_id"));
        assert_eq!(read.warnings.len(), 1);
    }

    #[test]
    fn the_wrong_schema_names_the_field() {
        let unknown = CAMERA.replace("\"fx\"", "\"focal\"");
        assert!(parse(&unknown).unwrap_err().problem.contains("`focal`"));
        let missing = CAMERA.replace("\"fx\":500.5,", "");
        assert!(parse(&missing).unwrap_err().problem.contains("`fx`"));
        let text = CAMERA.replace("500.5", "\"wide\"");
        assert!(parse(&text).unwrap_err().place.starts_with("line 1"));
        assert!(parse("[]").is_err());
        assert!(parse("").is_err());
    }

    #[test]
    fn open3d_counts_units_in_a_metre_and_stands_column_by_column() {
        let text = r#"{"width":640,"height":480,"fps":30.0,"depth_scale":5000.0,
            "intrinsic_matrix":[525,0,0,0,526,0,319.5,239.5,1]}"#;
        let WithWarnings {
            value: camera,
            warnings,
            ..
        } = parse(text).unwrap();
        assert_eq!(warnings.len(), 1, "the frame alone: {warnings:?}");
        assert_eq!(
            (camera.fx, camera.fy, camera.cx, camera.cy),
            (525.0, 526.0, 319.5, 239.5)
        );
        assert_eq!(camera.depth_scale, 0.0002);
        let silent = parse(&text.replace(r#""depth_scale":5000.0,"#, "")).unwrap();
        assert_eq!(silent.value.depth_scale, 0.001);
        assert_eq!(silent.warnings[1].code, WarningCode::DepthScaleAssumed);
        let by_rows = text.replace(
            "525,0,0,0,526,0,319.5,239.5,1",
            "525,0,319.5,0,526,239.5,0,0,1",
        );
        assert!(
            parse(&by_rows)
                .unwrap_err()
                .problem
                .contains("column by column")
        );
        assert!(parse(r#"{"intrinsic_matrix":[1,2]}"#).is_err());
    }
}
