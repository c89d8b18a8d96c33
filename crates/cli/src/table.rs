use crate::summary::plural;
use crate::terminal::{FAINT, GOOD, HEADING, REFUSED, Terminal, one_line};
use pomona::{Pick, Record, RobotRecord, Status};

/// What stands where nothing is known.
const UNKNOWN: &str = "-";

struct Column {
    header: &'static str,
    left: bool,
    cell: fn(&Pick) -> Option<String>,
}

const fn number(header: &'static str, cell: fn(&Pick) -> Option<String>) -> Column {
    Column {
        header,
        left: false,
        cell,
    }
}

const fn word(header: &'static str, cell: fn(&Pick) -> Option<String>) -> Column {
    Column {
        header,
        left: true,
        cell,
    }
}

/// The columns of every table. `angle`: that of the arrow in the picture, 0 to the right and 90
/// upwards; `away`: that out of the image plane, away from the camera.
const COLUMNS: &[Column] = &[
    number("id", |p| Some(p.id.to_string())),
    word("name", |p| Some(one_line(&p.pixel_box.name))),
    word("status", |p| Some(p.status.name().to_owned())),
    number("x mm", |p| Some(mm(p.apple.as_ref()?.center[0]))),
    number("y mm", |p| Some(mm(p.apple.as_ref()?.center[1]))),
    number("z mm", |p| Some(mm(p.apple.as_ref()?.center[2]))),
    number("r mm", |p| Some(mm(p.apple.as_ref()?.radius))),
    number("points", |p| Some(p.apple.as_ref()?.inliers.to_string())),
    number("rms mm", |p| Some(mm(p.apple.as_ref()?.rms))),
    number("branch pts", |p| {
        Some(p.branch.as_ref()?.inliers.to_string())
    }),
    number("rms mm", |p| Some(mm(p.branch.as_ref()?.rms))),
    number("angle deg", |p| {
        p.direction.map(|[x, y, _]| degrees((-y).atan2(x)))
    }),
    number("away deg", |p| {
        p.direction
            .map(|[.., z]| degrees(z.clamp(-1.0, 1.0).asin()))
    }),
];

/// What a detector adds.
const FOUND_COLUMNS: &[Column] = &[
    number("score", |p| Some(format!("{:.2}", p.pixel_box.score))),
    word("found by", |p| {
        Some(p.pixel_box.found?.found_by.name().to_owned())
    }),
    word("mark", |p| Some(p.pixel_box.found?.mark.name().to_owned())),
];

/// What a transform to the robot adds.
const ROBOT_COLUMNS: &[Column] = &[
    number("robot x mm", |p| Some(mm(p.robot.as_ref()?.center[0]))),
    number("y mm", |p| Some(mm(p.robot.as_ref()?.center[1]))),
    number("z mm", |p| Some(mm(p.robot.as_ref()?.center[2]))),
    number("rx deg", |p| Some(degrees(p.robot.as_ref()?.euler_zyx[0]))),
    number("ry deg", |p| Some(degrees(p.robot.as_ref()?.euler_zyx[1]))),
    number("rz deg", |p| p.robot.as_ref().map(yaw)),
];

const LAST_COLUMNS: &[Column] = &[number("time ms", |p| {
    Some(format!("{:.1}", p.timing_ms.total))
})];

fn mm(metres: f64) -> String {
    format!("{:.1}", metres * 1000.0)
}

fn degrees(radians: f64) -> String {
    format!("{:.1}", radians.to_degrees())
}

/// The angle about z, with a mark where it is not determined.
fn yaw(robot: &RobotRecord) -> String {
    let mark = if robot.singular { "*" } else { "" };
    degrees(robot.euler_zyx[2]) + mark
}

/// The answers of a frame as lines of text, with a heading.
pub(crate) fn table(record: &Record, terminal: Terminal) -> String {
    let has_robot = record.picks.iter().any(|p| p.robot.is_some());
    let robot = if has_robot { ROBOT_COLUMNS } else { &[] };
    let found = if record.detection.is_some() {
        FOUND_COLUMNS
    } else {
        &[]
    };
    let columns: Vec<&Column> = COLUMNS
        .iter()
        .chain(found)
        .chain(robot)
        .chain(LAST_COLUMNS)
        .collect();
    let rows: Vec<Vec<String>> = record
        .picks
        .iter()
        .map(|pick| {
            let cell = |c: &&Column| (c.cell)(pick).unwrap_or_else(|| UNKNOWN.to_owned());
            columns.iter().map(cell).collect()
        })
        .collect();
    let widths: Vec<usize> = columns
        .iter()
        .enumerate()
        .map(|(i, column)| {
            let cells = rows.iter().map(|row| row[i].chars().count());
            cells.chain([column.header.len()]).max().unwrap_or(0)
        })
        .collect();
    let line = |cells: &[String]| -> Vec<String> {
        let cells = cells.iter().zip(&columns).zip(&widths);
        cells
            .map(|((text, column), &width)| padded(text, width, column.left))
            .collect()
    };

    let title = format!(
        "{}: {}, method {}, seed {}",
        one_line(&record.frame.id),
        plural(record.picks.len(), "apple"),
        record.method,
        record.seed
    );
    let mut text = terminal.paint(HEADING, &title) + "\n";
    let headers: Vec<String> = columns.iter().map(|c| c.header.to_owned()).collect();
    text += &terminal.paint(FAINT, line(&headers).join("  ").trim_end());
    text.push('\n');
    for (row, pick) in rows.iter().zip(&record.picks) {
        let mut cells = line(row);
        let style = if pick.status == Status::Picked {
            GOOD
        } else {
            REFUSED
        };
        if let Some(at) = columns.iter().position(|c| c.header == "status") {
            cells[at] = terminal.paint(style, &cells[at]);
        }
        text += cells.join("  ").trim_end();
        text.push('\n');
    }
    if record
        .picks
        .iter()
        .filter_map(|p| p.robot.as_ref())
        .any(|r| r.singular)
    {
        text += "* the direction lies along the robot's z axis, where the angle about z is not determined\n";
    }
    text
}

fn padded(text: &str, width: usize, left: bool) -> String {
    if left {
        format!("{text:<width$}")
    } else {
        format!("{text:>width$}")
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use clap::ColorChoice;
    use pomona::{
        AppleRecord, BoxRecord, DetectionRecord, FoundBy, FoundRecord, FrameRecord, Mark,
        TimingRecord,
    };

    /// A record with an apple of each status; a picked one points up.
    pub(crate) fn record(statuses: &[Status]) -> Record {
        let pick = |(id, &status): (usize, &Status)| {
            let picked = status == Status::Picked;
            let apple = AppleRecord {
                center: [0.1, -0.02, 0.8],
                radius: 0.0358,
                inliers: 321,
                rms: 0.002,
                center_covariance: None,
                radius_sd: None,
                visible_share: None,
                agreement: None,
            };
            let name = format!("n{id}");
            Pick {
                id,
                pixel_box: BoxRecord {
                    name,
                    x_min: 1.0,
                    y_min: 2.0,
                    x_max: 3.0,
                    y_max: 4.0,
                    score: 1.0,
                    found: None,
                },
                status,
                apple: picked.then_some(apple),
                branch: None,
                foot: None,
                direction: picked.then_some([0.0, -0.8, 0.6]),
                direction_sd: None,
                confidence: None,
                candidates: Vec::new(),
                view_from: None,
                fallback: None,
                robot: None,
                plan: pomona::PlanRecord::default(),
                timing_ms: TimingRecord {
                    total: 1.25,
                    ..TimingRecord::default()
                },
            }
        };
        Record {
            schema: pomona::SCHEMA.to_owned(),
            method: "paper".to_owned(),
            seed: 3,
            frame: FrameRecord {
                id: "f".to_owned(),
                frame_id: "camera".to_owned(),
            },
            detection: None,
            picks: statuses.iter().enumerate().map(pick).collect(),
        }
    }

    #[test]
    fn units_stand_in_the_header_and_columns_in_line() {
        let text = table(
            &record(&[Status::Picked, Status::NoDepth]),
            Terminal::new(ColorChoice::Never),
        );
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "f: 2 apples, method paper, seed 3");
        for part in ["z mm", "r mm", "angle deg", "away deg"] {
            assert!(lines[1].contains(part), "{text}");
        }
        for part in ["picked", "800.0", "35.8", "321", "90.0", "36.9"] {
            assert!(lines[2].contains(part), "{part}: {text}");
        }
        assert!(
            lines[3].contains("no_depth") && lines[3].contains(" - "),
            "{text}"
        );
        assert_eq!(lines[1].len(), lines[2].len());
        assert_eq!(lines[2].len(), lines[3].len());
    }

    #[test]
    fn marks_stand_in_the_table_where_a_detector_found_the_boxes() {
        let mut record = record(&[Status::Picked, Status::Implausible]);
        let plain = Terminal::new(ColorChoice::Never);
        assert!(!table(&record, plain).contains("mark"));
        record.detection = Some(DetectionRecord::default());
        record.picks[1].pixel_box.found = Some(FoundRecord {
            found_by: FoundBy::Color,
            mark: Mark::TooSmall,
            merged: None,
        });
        let text = table(&record, plain);
        assert!(
            text.contains("mark") && text.contains("too_small"),
            "{text}"
        );
        assert!(text.contains("implausible"), "{text}");
    }

    #[test]
    fn colours_only_where_they_are_wanted() {
        let record = record(&[Status::Picked]);
        assert!(table(&record, Terminal::new(ColorChoice::Always)).contains("\x1b[32mpicked"));
        assert!(!table(&record, Terminal::new(ColorChoice::Never)).contains('\x1b'));
    }
}
