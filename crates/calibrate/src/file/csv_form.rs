use super::checks::{check_ids, not_rigid};
use super::columns::{Columns, RotationColumns, SideColumns};
use crate::rotation_form::RotationForm;
use crate::sample_options::SampleOptions;
use crate::units::{AngleUnit, LengthUnit};
use crate::{FrameIds, PointSample, PoseSample, SampleSet, Samples};
use csv::{ReaderBuilder, StringRecord, Trim};
use pomona_files::{Malformed, Warning, WarningCode};
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

/// A length that is no longer one of an arm in metres; the shortest arms count hundreds of millimetres.
const MILLIMETRES: f64 = 20.0;
/// An angle that no program writes in radians: a whole turn, and a little for rounding.
const DEGREES: f64 = std::f64::consts::TAU + 0.01;

/// A row with its place in the file.
struct Row {
    line: u64,
    id: String,
    /// The numbers of all columns; that of the id is 0.
    numbers: Vec<f64>,
}

pub(super) fn parse(bytes: &[u8], options: &SampleOptions) -> Result<SampleSet, Malformed> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let delimiter = delimiter(bytes);
    let mut reader = ReaderBuilder::new()
        .trim(Trim::All)
        .delimiter(delimiter)
        .from_reader(bytes);
    let header = reader.headers().map_err(|e| syntax(&e))?.clone();
    let columns = match Columns::of(header.iter(), options) {
        Ok(Some(columns)) => columns,
        // In the words of the project's own columns, where these are meant.
        Ok(None) => return Err(own_fault(&header)),
        Err(fault) if is_own(&header) => return Err(own_fault_or(&header, fault)),
        Err(fault) => return Err(fault),
    };
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| syntax(&e))?;
        rows.push(row(&record, &header, columns.id, delimiter != b',')?);
    }
    let ids: Vec<_> = rows
        .iter()
        .map(|r| (format!("line {}", r.line), r.id.as_str()))
        .collect();
    check_ids(&ids)?;
    let mut warnings = Vec::new();
    let sides = columns
        .sides
        .each_ref()
        .map(|side| Units::of(side, &rows, &mut warnings));
    let samples = if columns.sides[0].rotation.is_none() {
        let point = |row: Row| PointSample {
            robot: Position::new(sides[0].place(&row).into()),
            camera: Position::new(sides[1].place(&row).into()),
            id: row.id,
        };
        Samples::Points(rows.into_iter().map(point).collect())
    } else {
        let pose = |row: Row| {
            Ok(PoseSample {
                robot_from_flange: sides[0].transform(&row, POSES[0])?,
                camera_from_target: sides[1].transform(&row, POSES[1])?,
                id: row.id,
            })
        };
        Samples::Poses(rows.into_iter().map(pose).collect::<Result<_, _>>()?)
    };
    // Both sides say the same about themselves.
    warnings.dedup();
    Ok(SampleSet {
        samples,
        frames: FrameIds::default(),
        warnings,
    })
}

/// What parts the columns: in the first line, the most frequent of comma, semicolon and tab.
fn delimiter(bytes: &[u8]) -> u8 {
    let first = bytes.split(|b| *b == b'\n').next().unwrap_or_default();
    let count = |d: u8| first.split(|b| *b == d).count();
    [b',', b';', b'\t']
        .into_iter()
        .rev()
        .max_by_key(|d| count(*d))
        .unwrap_or(b',')
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

fn own_columns(header: &StringRecord) -> Vec<String> {
    if header.iter().any(|c| POINT[1..].contains(&c)) {
        return POINT.map(String::from).to_vec();
    }
    let of_pose = |pose: &str| NUMBERS.map(|n| format!("{pose}_{n}"));
    std::iter::once("id".to_owned())
        .chain(POSES.iter().flat_map(|pose| of_pose(pose)))
        .collect()
}

/// Whether the columns are those of the project, as far as they go.
fn is_own(header: &StringRecord) -> bool {
    let own = own_columns(header);
    header.iter().all(|name| own.iter().any(|c| c == name))
}

/// What is wrong with a header by the names of the project's own columns.
fn own_fault(header: &StringRecord) -> Malformed {
    let fallback = Malformed::new("line 1", "a column is unknown", "give other columns");
    own_fault_or(header, fallback)
}

fn own_fault_or(header: &StringRecord, other: Malformed) -> Malformed {
    let columns = own_columns(header);
    let remedy = || format!("give the columns {}", columns.join(","));
    for (i, name) in header.iter().enumerate() {
        if !columns.iter().any(|c| c == name) {
            let problem = format!("the column `{name}` is unknown");
            return Malformed::new("line 1", problem, remedy());
        }
        if header.iter().take(i).any(|earlier| earlier == name) {
            let problem = format!("the column `{name}` is given twice");
            return Malformed::new("line 1", problem, remedy());
        }
    }
    let missing = columns.iter().find(|c| header.iter().all(|h| h != *c));
    match missing {
        Some(column) => {
            let problem = format!("the column `{column}` is missing");
            Malformed::new("line 1", problem, remedy())
        }
        None => other,
    }
}

/// The numbers of a row. Where a comma does not part the columns, it may be the decimal one.
fn row(
    record: &StringRecord,
    header: &StringRecord,
    id: Option<usize>,
    decimal_comma: bool,
) -> Result<Row, Malformed> {
    let line = record.position().map_or(0, csv::Position::line);
    let numbers = (0..header.len()).map(|k| {
        if id == Some(k) {
            return Ok(0.0);
        }
        let field = record.get(k).unwrap_or_default();
        let plain = if decimal_comma && !field.contains('.') {
            field.replacen(',', ".", 1)
        } else {
            field.to_owned()
        };
        let number: Option<f64> = plain.parse().ok();
        number.filter(|n| n.is_finite()).ok_or_else(|| {
            Malformed::new(
                format!("line {line}, column `{}`", &header[k]),
                format!("`{field}` is no finite number"),
                "write a number with a point, or leave the sample out",
            )
        })
    });
    let own_id = id.map(|k| record.get(k).unwrap_or_default().to_owned());
    Ok(Row {
        line,
        id: own_id.unwrap_or_else(|| format!("line {line}")),
        numbers: numbers.collect::<Result<_, _>>()?,
    })
}

/// The columns of one side, and what their numbers count.
struct Units<'a> {
    columns: &'a SideColumns,
    length: LengthUnit,
    angle: AngleUnit,
}

impl<'a> Units<'a> {
    /// Units that neither the columns nor the options name are told by the numbers.
    fn of(columns: &'a SideColumns, rows: &[Row], warnings: &mut Vec<Warning>) -> Self {
        let largest = |at: &[usize]| {
            let numbers = rows
                .iter()
                .flat_map(|row| at.iter().map(|&k| row.numbers[k].abs()));
            numbers.fold(0.0, f64::max)
        };
        let mut assume = |what: &str, unit: &str| {
            let message = format!(
                "{what} are taken to be {unit}, by their size; name the unit in the columns, or by an option"
            );
            warnings.push(Warning::new(WarningCode::SampleUnitsAssumed, message));
        };
        let length = columns.length.unwrap_or_else(|| {
            let unit = if largest(&columns.position) > MILLIMETRES {
                LengthUnit::Millimetres
            } else {
                LengthUnit::Metres
            };
            assume("lengths", unit.name());
            unit
        });
        let angle = match &columns.rotation {
            Some(RotationColumns { form, unit, at }) => match (form, unit) {
                (RotationForm::QuaternionXyzw | RotationForm::QuaternionWxyz, _) => {
                    AngleUnit::Radians
                }
                (_, Some(unit)) => *unit,
                (_, None) => {
                    let unit = if largest(at) > DEGREES {
                        AngleUnit::Degrees
                    } else {
                        AngleUnit::Radians
                    };
                    assume("angles", unit.name());
                    unit
                }
            },
            None => AngleUnit::Radians,
        };
        Self {
            columns,
            length,
            angle,
        }
    }

    /// The position in a row, m.
    fn place(&self, row: &Row) -> [f64; 3] {
        self.columns
            .position
            .map(|k| self.length.metres(row.numbers[k]))
    }

    fn transform<To: FrameTag, From: FrameTag>(
        &self,
        row: &Row,
        name: &str,
    ) -> Result<Transform<To, From>, Malformed> {
        let place = || format!("line {}: {name}", row.line);
        let Some(RotationColumns { at, form, .. }) = &self.columns.rotation else {
            return Err(Malformed::new(place(), "no rotation", "give one"));
        };
        let numbers: Vec<f64> = at.iter().map(|&k| row.numbers[k]).collect();
        let translation = self.place(row);
        let found = match (form, &numbers[..]) {
            (RotationForm::QuaternionXyzw, &[x, y, z, w])
            | (RotationForm::QuaternionWxyz, &[w, x, y, z]) => {
                Transform::from_quaternion(translation, [x, y, z, w])
            }
            _ => {
                let rotation = form.rotation(&numbers, self.angle).unwrap_or_default();
                Transform::from_quaternion(translation, rotation.coords.into())
            }
        };
        found.map_err(|e| not_rigid(place(), &e))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn the_delimiter_is_told_by_the_first_line() {
        for (text, expected) in [
            ("a,b\n1;2", b','),
            ("a;b;c\n", b';'),
            ("a\tb", b'\t'),
            ("", b','),
        ] {
            assert_eq!(delimiter(text.as_bytes()), expected, "{text}");
        }
    }

    #[test]
    fn a_point_of_a_row_is_in_metres() {
        let text = "id;robot_x;robot_y;robot_z;camera_x_m;camera_y_m;camera_z_m\np;400,5;-100;20;0,1;0,2;0,9\n";
        let set = parse(text.as_bytes(), &SampleOptions::default()).unwrap();
        let Samples::Points(points) = &set.samples else {
            panic!("points");
        };
        assert_eq!(points[0].robot.point(), Point3::new(0.4005, -0.1, 0.02));
        assert_eq!(points[0].camera.point(), Point3::new(0.1, 0.2, 0.9));
        assert_eq!(set.warnings.len(), 1);
    }
}
