use super::record::{RealReport, RealRow};
use crate::error::EvaluateError;

/// Every box of every frame under every method as CSV; metres, radians and pixels, empty where not known.
///
/// # Errors
///
/// [`EvaluateError::Table`] where the rows cannot be written, which takes a lack of memory.
pub fn real_csv(report: &RealReport) -> Result<String, EvaluateError> {
    let refused = |reason: String| EvaluateError::Table { reason };
    let mut writer = csv::Writer::from_writer(Vec::new());
    let names = COLUMNS.iter().map(|(name, _)| *name);
    writer
        .write_record(["method"].into_iter().chain(names))
        .map_err(|e| refused(e.to_string()))?;
    for result in &report.results {
        for row in &result.apples {
            let cells = COLUMNS
                .iter()
                .map(|(_, cell)| cell(row).unwrap_or_default());
            writer
                .write_record([result.method.clone()].into_iter().chain(cells))
                .map_err(|e| refused(e.to_string()))?;
        }
    }
    let bytes = writer.into_inner().map_err(|e| refused(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| refused(e.to_string()))
}

type Column = (&'static str, fn(&RealRow) -> Option<String>);

fn number(value: Option<f64>) -> Option<String> {
    value.map(|v| v.to_string())
}

fn part<const N: usize>(point: Option<[f64; N]>, axis: usize) -> Option<String> {
    point.map(|p| p[axis].to_string())
}

const COLUMNS: &[Column] = &[
    ("frame", |r| Some(r.frame.clone())),
    ("box_name", |r| Some(r.box_name.clone())),
    ("wood", |r| Some(r.wood.name().to_owned())),
    ("verdict", |r| Some(r.verdict.name().to_owned())),
    ("status", |r| Some(r.status.clone())),
    ("confidence", |r| number(r.confidence)),
    ("image_angle_rad", |r| number(r.image_angle)),
    ("wood_distance_radii", |r| number(r.wood_distance_radii)),
    ("foot_from_wood_radii", |r| number(r.foot_from_wood_radii)),
    ("foot_off_wood_radii", |r| number(r.foot_off_wood_radii)),
    ("passed_over", |r| Some(r.passed_over.to_string())),
    ("distance_m", |r| number(r.distance)),
    ("radius_m", |r| number(r.radius)),
    ("box_radius_px", |r| Some(r.box_radius_px.to_string())),
    ("center_u_px", |r| part(r.center_px, 0)),
    ("center_v_px", |r| part(r.center_px, 1)),
    ("foot_u_px", |r| part(r.foot_px, 0)),
    ("foot_v_px", |r| part(r.foot_px, 1)),
    ("wood_u_px", |r| part(r.wood_px.first().copied(), 0)),
    ("wood_v_px", |r| part(r.wood_px.first().copied(), 1)),
    ("center_x_m", |r| part(r.center, 0)),
    ("center_y_m", |r| part(r.center, 1)),
    ("center_z_m", |r| part(r.center, 2)),
    ("foot_x_m", |r| part(r.foot, 0)),
    ("foot_y_m", |r| part(r.foot, 1)),
    ("foot_z_m", |r| part(r.foot, 2)),
];
