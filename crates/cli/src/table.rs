use crate::summary::plural;
use crate::terminal::{FAINT, GOOD, HEADING, REFUSED, Terminal, one_line};
use pomona::{AppleAnswer, FrameAnswer, RobotTarget};

/// Shown in place of an unknown value.
const UNKNOWN: &str = "-";

struct Column {
    header: &'static str,
    left: bool,
    cell: fn(&AppleAnswer) -> Option<String>,
}

const fn number(header: &'static str, cell: fn(&AppleAnswer) -> Option<String>) -> Column {
    Column {
        header,
        left: false,
        cell,
    }
}

const fn word(header: &'static str, cell: fn(&AppleAnswer) -> Option<String>) -> Column {
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
    word("name", |p| Some(one_line(&p.bounds.name))),
    word("status", |p| Some(p.status.name().to_owned())),
    number("x mm", |p| Some(mm(p.apple?.center.point().x))),
    number("y mm", |p| Some(mm(p.apple?.center.point().y))),
    number("z mm", |p| Some(mm(p.apple?.center.point().z))),
    number("r mm", |p| Some(mm(p.apple?.radius_m))),
    number("points", |p| Some(p.apple?.inliers.to_string())),
    number("rms mm", |p| Some(mm(p.apple?.rms_m))),
    number("branch pts", |p| Some(p.branch?.inliers.to_string())),
    number("rms mm", |p| Some(mm(p.branch?.rms_m))),
    number("angle deg", |p| {
        let d = p.pick?.direction.vector();
        Some(degrees((-d.y).atan2(d.x)))
    }),
    number("away deg", |p| {
        let d = p.pick?.direction.vector();
        Some(degrees(d.z.clamp(-1.0, 1.0).asin()))
    }),
];

/// What a detector adds.
const FOUND_COLUMNS: &[Column] = &[
    number("score", |p| Some(format!("{:.2}", p.bounds.score))),
    word("found by", |p| Some(p.origin?.found_by.name().to_owned())),
    word("mark", |p| Some(p.origin?.mark.name().to_owned())),
];

/// What a transform to the robot adds.
const ROBOT_COLUMNS: &[Column] = &[
    number("robot x mm", |p| {
        Some(mm(p.robot.as_ref()?.center.point().x))
    }),
    number("y mm", |p| Some(mm(p.robot.as_ref()?.center.point().y))),
    number("z mm", |p| Some(mm(p.robot.as_ref()?.center.point().z))),
    number("rx deg", |p| Some(degrees(p.robot.as_ref()?.tool.euler.rx))),
    number("ry deg", |p| Some(degrees(p.robot.as_ref()?.tool.euler.ry))),
    number("rz deg", |p| p.robot.as_ref().map(yaw)),
];

const LAST_COLUMNS: &[Column] = &[number("time ms", |p| {
    Some(format!("{:.1}", p.times.total.as_secs_f64() * 1e3))
})];

fn mm(metres: f64) -> String {
    format!("{:.1}", metres * 1000.0)
}

fn degrees(radians: f64) -> String {
    format!("{:.1}", radians.to_degrees())
}

/// The angle about z, with a mark where it is not determined.
fn yaw(robot: &RobotTarget) -> String {
    let mark = if robot.tool.singular { "*" } else { "" };
    degrees(robot.tool.euler.rz) + mark
}

/// The answers of a frame as lines of text, with a heading.
pub(crate) fn table(answer: &FrameAnswer, terminal: Terminal) -> String {
    let has_robot = answer.apples.iter().any(|p| p.robot.is_some());
    let robot = if has_robot { ROBOT_COLUMNS } else { &[] };
    let found = if answer.detection.is_some() {
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
    let rows: Vec<Vec<String>> = answer
        .apples
        .iter()
        .map(|apple| {
            let cell = |c: &&Column| (c.cell)(apple).unwrap_or_else(|| UNKNOWN.to_owned());
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
        one_line(&answer.id),
        plural(answer.apples.len(), "apple"),
        answer.method.name(),
        answer.seed
    );
    let mut text = terminal.paint(HEADING, &title) + "\n";
    let headers: Vec<String> = columns.iter().map(|c| c.header.to_owned()).collect();
    text += &terminal.paint(FAINT, line(&headers).join("  ").trim_end());
    text.push('\n');
    for (row, apple) in rows.iter().zip(&answer.apples) {
        let mut cells = line(row);
        let style = if apple.is_picked() { GOOD } else { REFUSED };
        if let Some(at) = columns.iter().position(|c| c.header == "status") {
            cells[at] = terminal.paint(style, &cells[at]);
        }
        text += cells.join("  ").trim_end();
        text.push('\n');
    }
    if answer
        .apples
        .iter()
        .filter_map(|p| p.robot.as_ref())
        .any(|r| r.tool.singular)
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
    use nalgebra::{Point3, Vector3};
    use pomona::{
        BoxOrigin, DetectionSummary, FittedApple, FoundBy, Mark, Method, PickDirection, Status,
    };
    use pomona_cloud::PixelBox;
    use pomona_transforms::Position;
    use std::time::Duration;

    /// Answers with an apple of each status; a picked one points up and away.
    pub(crate) fn answer(statuses: &[Status]) -> FrameAnswer {
        let apple = |(id, &status): (usize, &Status)| {
            let bounds = PixelBox {
                name: format!("n{id}"),
                x_min: 1.0,
                y_min: 2.0,
                x_max: 3.0,
                y_max: 4.0,
                score: 1.0,
            };
            let mut answer = AppleAnswer::new(id, bounds, status);
            answer.times.total = Duration::from_micros(1250);
            if status == Status::Picked {
                let center = Point3::new(0.1, -0.02, 0.8);
                let foot = Position::new(center + Vector3::new(0.0, -0.04, 0.03));
                let center = Position::new(center);
                answer.apple = Some(FittedApple::new(center, 0.0358, 321, 0.002));
                answer.pick = PickDirection::new(&center, foot);
            }
            answer
        };
        let apples = statuses.iter().enumerate().map(apple);
        FrameAnswer::new(Method::Paper, 3, "f", "camera", apples.collect())
    }

    #[test]
    fn units_stand_in_the_header_and_columns_in_line() {
        let text = table(
            &answer(&[Status::Picked, Status::NoDepth]),
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
        let mut answer = answer(&[Status::Picked, Status::Implausible]);
        let plain = Terminal::new(ColorChoice::Never);
        assert!(!table(&answer, plain).contains("mark"));
        answer.detection = Some(DetectionSummary::default());
        answer.apples[1].origin = Some(BoxOrigin::new(FoundBy::Color, Mark::TooSmall));
        let text = table(&answer, plain);
        assert!(
            text.contains("mark") && text.contains("too_small"),
            "{text}"
        );
        assert!(text.contains("implausible"), "{text}");
    }

    #[test]
    fn colours_only_where_they_are_wanted() {
        let answer = answer(&[Status::Picked]);
        assert!(table(&answer, Terminal::new(ColorChoice::Always)).contains("\x1b[32mpicked"));
        assert!(!table(&answer, Terminal::new(ColorChoice::Never)).contains('\x1b'));
    }
}
