use crate::apple_row::AppleRow;
use crate::error::EvaluateError;
use crate::evaluation::Evaluation;

/// Every apple under every method as CSV; metres, radians, milliseconds, empty where not known.
///
/// # Errors
///
/// [`EvaluateError::Table`] where the rows cannot be written, which takes a lack of memory.
pub fn apples_csv(evaluation: &Evaluation) -> Result<String, EvaluateError> {
    let refused = |reason: String| EvaluateError::Table { reason };
    let mut writer = csv::Writer::from_writer(Vec::new());
    let names = COLUMNS.iter().map(|(name, _)| *name);
    writer
        .write_record(names)
        .map_err(|e| refused(e.to_string()))?;
    for row in &evaluation.apples {
        let cells = COLUMNS
            .iter()
            .map(|(_, cell)| cell(row).unwrap_or_default());
        writer
            .write_record(cells)
            .map_err(|e| refused(e.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|e| refused(e.to_string()))?;
    String::from_utf8(bytes).map_err(|e| refused(e.to_string()))
}

type Column = (&'static str, fn(&AppleRow) -> Option<String>);

fn coordinate(point: Option<[f64; 3]>, axis: usize) -> Option<String> {
    point.map(|p| p[axis].to_string())
}

fn text<T: ToString>(value: Option<T>) -> Option<String> {
    value.map(|v| v.to_string())
}

const COLUMNS: &[Column] = &[
    ("suite", |r| Some(r.suite.clone())),
    ("case", |r| Some(r.case.clone())),
    ("apple", |r| Some(r.apple.clone())),
    ("method", |r| Some(r.method.clone())),
    ("target", |r| Some(r.target.to_string())),
    ("status", |r| Some(r.status.clone())),
    ("answerable", |r| text(r.answerable)),
    ("angle_error_rad", |r| text(r.angle_error)),
    ("center_error_m", |r| text(r.center_error)),
    ("radius_error_m", |r| text(r.radius_error)),
    ("foot_error_m", |r| text(r.foot_error)),
    ("radius_m", |r| text(r.radius)),
    ("center_x_m", |r| coordinate(r.center, 0)),
    ("center_y_m", |r| coordinate(r.center, 1)),
    ("center_z_m", |r| coordinate(r.center, 2)),
    ("foot_x_m", |r| coordinate(r.foot, 0)),
    ("foot_y_m", |r| coordinate(r.foot, 1)),
    ("foot_z_m", |r| coordinate(r.foot, 2)),
    ("direction_x", |r| coordinate(r.direction, 0)),
    ("direction_y", |r| coordinate(r.direction, 1)),
    ("direction_z", |r| coordinate(r.direction, 2)),
    ("confidence", |r| text(r.confidence)),
    ("direction_sd_rad", |r| text(r.direction_sd)),
    ("true_radius_m", |r| Some(r.true_radius.to_string())),
    ("true_center_x_m", |r| coordinate(Some(r.true_center), 0)),
    ("true_center_y_m", |r| coordinate(Some(r.true_center), 1)),
    ("true_center_z_m", |r| coordinate(Some(r.true_center), 2)),
    ("true_direction_x", |r| coordinate(r.true_direction, 0)),
    ("true_direction_y", |r| coordinate(r.true_direction, 1)),
    ("true_direction_z", |r| coordinate(r.true_direction, 2)),
    ("distance_m", |r| Some(r.distance.to_string())),
    ("visible_share", |r| text(r.visible_share)),
    ("branch_radius_m", |r| text(r.branch_radius)),
    ("visible_branch_length_m", |r| text(r.visible_branch_length)),
    ("leaves", |r| text(r.leaves)),
    ("crop_ms", |r| text(r.timing_ms.map(|t| t.crop))),
    ("sphere_ms", |r| text(r.timing_ms.map(|t| t.sphere))),
    ("branch_ms", |r| text(r.timing_ms.map(|t| t.branch))),
    ("total_ms", |r| text(r.timing_ms.map(|t| t.total))),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::evaluate;
    use crate::subject::Subject;
    use pomona::{Config, Method, Picker};

    #[test]
    fn a_row_for_each_apple_and_a_cell_for_each_column() {
        let subjects = Subject::named("lab15", Some(1)).unwrap();
        let picker = Picker::new(Config::default().with(|c| c.method = Method::Paper)).unwrap();
        let evaluation = evaluate(&subjects, &[&picker], 0, &|| {}).unwrap();
        let text = apples_csv(&evaluation).unwrap();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 1);
        assert_eq!(rows[0].len(), COLUMNS.len());
        assert_eq!(&rows[0][1], "lab-x-90-s0");
        let error: f64 = rows[0][7].parse().unwrap();
        assert_eq!(Some(error), evaluation.apples[0].angle_error);
    }
}
