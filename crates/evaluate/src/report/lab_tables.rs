use super::colors::{OURS, PAPER};
use crate::paper_figures::LAB_RADIUS;
use crate::suite::{LabRow, SuiteResult};
use pomona_report::html::{figures, heading, paragraph, table};
use pomona_report::number::{degrees, mm, or_unknown};
use pomona_report::plot::{Axis, Marks, PlotError, Series, from_zero, plot};

/// Tables 1–3, and a plot of all fifteen; empty where the suite is not the lab's.
pub(super) fn section(result: &SuiteResult) -> Result<String, PlotError> {
    if result.lab.is_empty() {
        return Ok(String::new());
    }
    let mut text = String::new();
    for (number, axis) in [(1, 'x'), (2, 'y'), (3, 'z')] {
        let own: Vec<&LabRow> = result
            .lab
            .iter()
            .filter(|row| row.orientation.starts_with(axis))
            .collect();
        if own.is_empty() {
            continue;
        }
        let draws = own[0].draws;
        text += &heading(&format!(
            "Table {number}: rotated about {axis}, {draws} draws each"
        ));
        let rows: Vec<Vec<String>> = own.iter().map(|row| line(row)).collect();
        text += &table(
            &[
                "angle °",
                "true direction",
                "paper's direction",
                "our mean direction",
                "radius mm\npaper",
                "radius mm\nours",
                "sd mm\nours",
                "centre off\nmm",
                "error °\npaper",
                "error °\nour mean",
                "error °\nleast",
                "error °\nlargest",
            ],
            &rows,
        );
    }
    text += &paragraph(&format!(
        "True radius {} mm. The paper's vector for x = −90° is misprinted: its norm is 1.166 and it lies 34.2° off, \
         not the 5.23° printed beside it.",
        mm(LAB_RADIUS)
    ));
    let caption = "Angle error of each orientation: ours red, mean and range over the noise draws; the paper's blue.";
    text += &figures(1, &[(draw(&result.lab)?, caption.to_owned())]);
    Ok(text)
}

fn line(row: &LabRow) -> Vec<String> {
    let vector = |v: [f64; 3]| {
        v.map(|c| format!("{:.3}", if c.abs() < 5e-4 { 0.0 } else { c }))
            .join(", ")
    };
    let angle = row.angle_error.as_ref();
    vec![
        row.orientation[1..].to_owned(),
        or_unknown(row.true_direction, vector),
        vector(row.paper_direction),
        or_unknown(row.direction, vector),
        mm(row.paper_radius),
        or_unknown(row.radius, |s| mm(s.mean)),
        or_unknown(row.radius, |s| mm(s.sd)),
        or_unknown(row.center_error.as_ref(), |s| mm(s.mean)),
        degrees(row.paper_angle_error),
        or_unknown(angle, |s| degrees(s.mean)),
        or_unknown(angle, |s| degrees(s.min)),
        or_unknown(angle, |s| degrees(s.max)),
    ]
}

fn draw(rows: &[LabRow]) -> Result<String, PlotError> {
    let place = |i: usize| i as f64 + 1.0;
    let ours: Vec<(f64, f64, f64, f64)> = rows
        .iter()
        .enumerate()
        .filter_map(|(i, row)| {
            let error = row.angle_error.as_ref()?;
            let [low, mean, high] = [error.min, error.mean, error.max].map(f64::to_degrees);
            Some((place(i) - 0.12, low, mean, high))
        })
        .collect();
    let paper: Vec<(f64, f64)> = rows
        .iter()
        .enumerate()
        .map(|(i, row)| (place(i) + 0.12, row.paper_angle_error.to_degrees()))
        .collect();
    let values = ours.iter().map(|o| o.3).chain(paper.iter().map(|p| p.1));
    let names: Vec<&str> = rows.iter().map(|row| row.orientation.as_str()).collect();
    let x = Axis {
        names: &names,
        ..Axis::new("axis and angle (°)", 0.4..rows.len() as f64 + 0.6)
    };
    let y = Axis::new("angle error (°)", from_zero(values));
    plot(
        (1100, 300),
        &x,
        &y,
        &[
            Series {
                color: OURS,
                marks: Marks::Intervals(ours),
            },
            Series {
                color: PAPER,
                marks: Marks::Rings(paper),
            },
        ],
    )
}
