use super::checks::{check_ids, not_rigid};
use crate::{FrameIds, PointSample, PoseSample, SampleSet, Samples};
use csv::{ReaderBuilder, StringRecord, Trim};
use nalgebra::Point3;
use pomona_files::Malformed;
use pomona_transforms::{FrameTag, Position, Transform};

const POINT: [&str; 7] = [
    "id",
    "camera_x_m",
    "camera_y_m",
    "camera_z_m",
    "robot_x_m",
    "robot_y_m",
    "robot_z_m",
];
const POSES: [&str; 2] = ["robot_from_flange", "camera_from_target"];
const NUMBERS: [&str; 7] = ["x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"];

/// A row with its place in the file.
struct Row {
    place: String,
    id: String,
    numbers: Vec<f64>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<SampleSet, Malformed> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(bytes);
    let header = reader.headers().map_err(|e| syntax(&e))?.clone();
    let points: Vec<String> = POINT.map(String::from).to_vec();
    let of_pose = |pose: &str| NUMBERS.map(|n| format!("{pose}_{n}"));
    let poses: Vec<String> = std::iter::once("id".to_owned())
        .chain(POSES.iter().flat_map(|pose| of_pose(pose)))
        .collect();
    let is_points = header.iter().any(|c| POINT[1..].contains(&c));
    let columns = if is_points { &points } else { &poses };
    let order = order(&header, columns)?;
    let mut rows = Vec::new();
    for record in reader.records() {
        rows.push(row(&record.map_err(|e| syntax(&e))?, columns, &order)?);
    }
    let ids: Vec<_> = rows
        .iter()
        .map(|r| (r.place.clone(), r.id.as_str()))
        .collect();
    check_ids(&ids)?;
    let samples = if is_points {
        Samples::Points(rows.into_iter().map(point).collect())
    } else {
        Samples::Poses(rows.into_iter().map(pose).collect::<Result<_, _>>()?)
    };
    Ok(SampleSet {
        samples,
        frames: FrameIds::default(),
    })
}

fn syntax(error: &csv::Error) -> Malformed {
    let place = error
        .position()
        .map_or_else(|| "CSV".to_owned(), |p| format!("line {}", p.line()));
    Malformed::new(
        place,
        error.to_string(),
        "give as many fields in each line as there are columns",
    )
}

/// The index of each of `columns` in the header, which has these and no others.
fn order(header: &StringRecord, columns: &[String]) -> Result<Vec<usize>, Malformed> {
    let remedy = || format!("give the columns {}", columns.join(","));
    for (i, name) in header.iter().enumerate() {
        if !columns.iter().any(|c| c == name) {
            let problem = format!("the column `{name}` is unknown");
            return Err(Malformed::new("line 1", problem, remedy()));
        }
        if header.iter().take(i).any(|other| other == name) {
            let problem = format!("the column `{name}` is given twice");
            return Err(Malformed::new("line 1", problem, remedy()));
        }
    }
    let place = |column: &String| {
        header.iter().position(|h| h == column).ok_or_else(|| {
            Malformed::new(
                "line 1",
                format!("the column `{column}` is missing"),
                remedy(),
            )
        })
    };
    columns.iter().map(place).collect()
}

fn row(record: &StringRecord, columns: &[String], order: &[usize]) -> Result<Row, Malformed> {
    let line = record.position().map_or(0, csv::Position::line);
    let field = |k: usize| record.get(order[k]).unwrap_or_default();
    let numbers = (1..columns.len()).map(|k| {
        let number: Option<f64> = field(k).parse().ok();
        number.filter(|n| n.is_finite()).ok_or_else(|| {
            Malformed::new(
                format!("line {line}, column `{}`", columns[k]),
                format!("`{}` is no finite number", field(k)),
                "write a number with a point, or leave the sample out",
            )
        })
    });
    Ok(Row {
        place: format!("line {line}"),
        id: field(0).to_owned(),
        numbers: numbers.collect::<Result<_, _>>()?,
    })
}

fn point(row: Row) -> PointSample {
    let at = |k: usize| Point3::new(row.numbers[k], row.numbers[k + 1], row.numbers[k + 2]);
    PointSample {
        camera: Position::new(at(0)),
        robot: Position::new(at(3)),
        id: row.id,
    }
}

fn pose(row: Row) -> Result<PoseSample, Malformed> {
    Ok(PoseSample {
        robot_from_flange: transform(&row, 0)?,
        camera_from_target: transform(&row, 1)?,
        id: row.id,
    })
}

fn transform<To: FrameTag, From: FrameTag>(
    row: &Row,
    which: usize,
) -> Result<Transform<To, From>, Malformed> {
    let n = &row.numbers[7 * which..][..7];
    Transform::from_quaternion([n[0], n[1], n[2]], [n[3], n[4], n[5], n[6]])
        .map_err(|e| not_rigid(format!("{}: {}", row.place, POSES[which]), &e))
}
