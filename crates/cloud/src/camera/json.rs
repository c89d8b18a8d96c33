//! The project's own `camera.json`, and Open3D's `PinholeCameraIntrinsic` JSON in its place.

use super::Camera;
use pomona_files::Malformed;
use serde::Deserialize;
use serde_json::Value;

const REMEDY: &str = "give width, height, fx, fy, cx, cy, depth_scale, frame_id and, where the lens bends, distortion: {model, coefficients}";
const OPEN3D_REMEDY: &str =
    "give width, height and intrinsic_matrix: [fx, 0, 0, 0, fy, 0, cx, cy, 1]";

pub(super) fn parse(text: &str) -> Result<Camera, Malformed> {
    let fault = |e: serde_json::Error, remedy: &str| {
        Malformed::new(
            format!("line {} column {}", e.line(), e.column()),
            e.to_string(),
            remedy,
        )
    };
    let is_open3d = serde_json::from_str::<Value>(text)
        .map_err(|e| fault(e, REMEDY))?
        .get("intrinsic_matrix")
        .is_some();
    if is_open3d {
        let intrinsic: Open3d = serde_json::from_str(text).map_err(|e| fault(e, OPEN3D_REMEDY))?;
        intrinsic.into_camera()
    } else {
        serde_json::from_str(text).map_err(|e| fault(e, REMEDY))
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
    #[serde(default = "units_per_metre")]
    depth_scale: f64,
}

fn units_per_metre() -> f64 {
    1000.0
}

impl Open3d {
    fn into_camera(self) -> Result<Camera, Malformed> {
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
        camera.depth_scale = 1.0 / self.depth_scale;
        Ok(camera)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: &str = r#"{"width":640,"height":480,"fx":500.5,"fy":501,"cx":320,"cy":240.25,
        "depth_scale":0.001,"frame_id":"optical"}"#;

    #[test]
    fn reads_what_it_writes() {
        let mut camera = parse(CAMERA).unwrap();
        assert_eq!(parse(&format(&camera)).unwrap(), camera);
        camera.distortion = Some(super::super::Distortion {
            model: "plumb_bob".to_owned(),
            coefficients: vec![0.1, -0.2, 0.001, 0.002, 0.05],
        });
        assert_eq!(parse(&format(&camera)).unwrap(), camera);
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
        let camera = parse(text).unwrap();
        assert_eq!(
            (camera.fx, camera.fy, camera.cx, camera.cy),
            (525.0, 526.0, 319.5, 239.5)
        );
        assert_eq!(camera.depth_scale, 0.0002);
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
