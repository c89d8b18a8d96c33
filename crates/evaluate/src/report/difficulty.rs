use super::colors::{FAINT, OURS};
use super::spread::SIZE;
use crate::apple_row::AppleRow;
use crate::suite::{Difficulty, Group, Grouping, SuiteResult};
use pomona_report::html::{figures, table};
use pomona_report::number::{degrees, mean_with_interval, mm, or_unknown, with_interval};
use pomona_report::plot::{Axis, Marks, PlotError, Series, plot, range_of};

/// Errors against what makes an apple hard: a plot and a table for each grouping of more than one group.
pub(super) fn section(result: &SuiteResult, rows: &[&AppleRow]) -> Result<String, PlotError> {
    let groupings: Vec<&Grouping> = result
        .groupings
        .iter()
        .filter(|g| g.groups.len() > 1)
        .collect();
    if groupings.is_empty() {
        return Ok(String::new());
    }
    let mut plots = Vec::new();
    let mut tables = String::new();
    for grouping in groupings {
        plots.push((
            draw(grouping, rows)?,
            format!(
                "Angle error against {}: each apple, and the groups' means with their intervals.",
                words(grouping.by).0
            ),
        ));
        let rows: Vec<Vec<String>> = grouping
            .groups
            .iter()
            .map(|group| line(grouping.by, group))
            .collect();
        let (name, unit, _) = words(grouping.by);
        let header = format!("{name}{unit}");
        tables += &table(
            &[
                &header,
                "apples",
                "answered %",
                "angle error °: mean",
                "median",
                "≤ 10° %",
                "≥ 50° %",
                "centre error mm",
            ],
            &rows,
        );
    }
    Ok(String::from("<h3>Errors against difficulty</h3>\n") + &figures(2, &plots) + &tables)
}

/// Name, unit, and the unit in SI.
fn words(by: Difficulty) -> (&'static str, &'static str, f64) {
    match by {
        Difficulty::Distance => ("distance", " (m)", 1.0),
        Difficulty::Occlusion => ("occlusion", " (%)", 100.0),
        Difficulty::BranchThickness => ("branch diameter", " (mm)", 1000.0),
        Difficulty::Leaves => ("leaves", "", 1.0),
        Difficulty::VisibleBranchLength => ("visible branch length", " (mm)", 1000.0),
    }
}

fn line(by: Difficulty, group: &Group) -> Vec<String> {
    let (_, _, per_si) = words(by);
    let bound = |value: f64| {
        let text = format!("{:.2}", value * per_si);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    let range = match group.to {
        Some(to) => format!("{} – {}", bound(group.from), bound(to)),
        None => format!("{} and more", bound(group.from)),
    };
    let angle = group.angle.as_ref();
    vec![
        range,
        group.apples.to_string(),
        with_interval(&group.answered),
        or_unknown(angle, |a| mean_with_interval(&a.error, degrees)),
        or_unknown(angle, |a| degrees(a.error.median)),
        or_unknown(angle, |a| with_interval(&a.within_10_deg)),
        or_unknown(angle, |a| with_interval(&a.at_least_50_deg)),
        or_unknown(group.center_error.as_ref(), |s| mean_with_interval(s, mm)),
    ]
}

fn draw(grouping: &Grouping, rows: &[&AppleRow]) -> Result<String, PlotError> {
    let (name, unit, per_si) = words(grouping.by);
    let dots: Vec<(f64, f64)> = rows
        .iter()
        .filter_map(|row| Some((grouping.by.of(row)? * per_si, row.angle_error?.to_degrees())))
        .collect();
    let x_range = range_of(dots.iter().map(|p| p.0));
    let label = format!("{name}{unit}");
    let x = Axis::new(&label, x_range);
    let top = dots.iter().map(|p| p.1).fold(10.0, f64::max);
    let y = Axis::new("angle error (°)", 0.0..1.05 * top);
    // A group's mean stands at the mean of its apples.
    let means = grouping.groups.iter().filter_map(|group| {
        let error = &group.angle.as_ref()?.error;
        let inside: Vec<f64> = dots
            .iter()
            .map(|p| p.0)
            .filter(|&v| {
                let below = group.to.is_none_or(|to| v < to * per_si);
                v >= group.from * per_si && below
            })
            .collect();
        let place = inside.iter().sum::<f64>() / inside.len() as f64;
        let [low, high] = error.mean_interval.map(f64::to_degrees);
        place
            .is_finite()
            .then_some((place, low, error.mean.to_degrees(), high))
    });
    let means = Marks::Intervals(means.collect());
    plot(
        SIZE,
        &x,
        &y,
        &[
            Series {
                color: FAINT,
                marks: Marks::Dots(dots),
            },
            Series {
                color: OURS,
                marks: means,
            },
        ],
    )
}
