use super::colors::{FAINT, OURS, PAPER};
use crate::apple_row::AppleRow;
use pomona_report::html::figures;
use pomona_report::plot::{Axis, GREEN, Marks, PlotError, Series, from_zero, plot, range_of};

pub(super) const SIZE: (u32, u32) = (560, 320);

/// How the errors of direction and place are spread.
pub(super) fn section(rows: &[&AppleRow]) -> Result<String, PlotError> {
    let angles: Vec<f64> = rows
        .iter()
        .filter_map(|row| row.angle_error)
        .map(f64::to_degrees)
        .collect();
    if angles.is_empty() {
        return Ok(String::new());
    }
    let pair =
        |x: fn(&AppleRow) -> Option<f64>, y: fn(&AppleRow) -> Option<f64>| -> Vec<(f64, f64)> {
            rows.iter()
                .filter_map(|row| Some((x(row)?, y(row)?)))
                .collect()
        };
    let radii = pair(
        |row| Some(row.true_radius * 1e3),
        |row| row.radius.map(|r| r * 1e3),
    );
    Ok(
        String::from("<h3>Spread of the errors against truth</h3>\n")
            + &figures(
                2,
                &[
                    (
                        histogram(&angles)?,
                        "Histogram of the angle error against truth.".to_owned(),
                    ),
                    (
                        cumulative(&angles, &[])?,
                        "Its cumulative share.".to_owned(),
                    ),
                    (
                        offsets(rows)?,
                        "Centre less true centre: across the view, and in depth.".to_owned(),
                    ),
                    (
                        radius("true radius (mm)", &radii)?,
                        "Fitted radius over true radius; the line is equality.".to_owned(),
                    ),
                ],
            ),
    )
}

/// Shares of angles in bars.
pub(super) fn histogram(angles: &[f64]) -> Result<String, PlotError> {
    let top = top_angle(angles);
    // Few and clear bars, whatever the range.
    let width = if top <= 30.0 { 1.0 } else { 5.0 };
    let count = (top / width).round() as usize;
    let bars: Vec<(f64, f64, f64)> = (0..count)
        .map(|i| {
            let number = |angle: f64| ((angle / width) as usize).min(count - 1);
            let inside = angles.iter().filter(|&&angle| number(angle) == i).count();
            let from = width * i as f64;
            (
                from,
                from + width,
                100.0 * inside as f64 / angles.len() as f64,
            )
        })
        .collect();
    let y = Axis::new("share (%)", from_zero(bars.iter().map(|b| b.2)));
    let x = Axis::new("angle error (°)", 0.0..top);
    plot(
        SIZE,
        &x,
        &y,
        &[Series {
            color: OURS,
            marks: Marks::Bars(bars),
        }],
    )
}

/// Share of angles up to each angle; `paper` are points that the paper states, in degrees and shares.
pub(super) fn cumulative(angles: &[f64], paper: &[(f64, f64)]) -> Result<String, PlotError> {
    let mut sorted = angles.to_vec();
    sorted.sort_by(f64::total_cmp);
    let top = top_angle(angles).max(paper.iter().map(|p| p.0 + 5.0).fold(0.0, f64::max));
    let share = |count: usize| 100.0 * count as f64 / sorted.len() as f64;
    let mut steps = vec![(0.0, 0.0)];
    for (i, &angle) in sorted.iter().enumerate() {
        steps.extend([(angle, share(i)), (angle, share(i + 1))]);
    }
    steps.push((top, 100.0));
    let x = Axis::new("angle error (°)", 0.0..top);
    let y = Axis::new("cumulative share (%)", 0.0..104.0);
    let mut series = vec![Series {
        color: OURS,
        marks: Marks::Line(steps),
    }];
    if !paper.is_empty() {
        let points = paper
            .iter()
            .map(|&(angle, share)| (angle, 100.0 * share))
            .collect();
        series.push(Series {
            color: PAPER,
            marks: Marks::Rings(points),
        });
    }
    plot(SIZE, &x, &y, &series)
}

/// The least multiple of 10° from 20° on that holds all angles.
fn top_angle(angles: &[f64]) -> f64 {
    let largest = angles.iter().fold(0.0, |a: f64, &b| a.max(b));
    (10.0 * (largest / 10.0).ceil()).clamp(20.0, 180.0)
}

fn offsets(rows: &[&AppleRow]) -> Result<String, PlotError> {
    let offsets: Vec<[f64; 3]> = rows
        .iter()
        .filter_map(|row| row.center_offset)
        .map(|o| o.map(|v| v * 1e3))
        .collect();
    let across = |o: &[f64; 3]| o[0].hypot(o[1]);
    let x = Axis::new(
        "across the view (mm)",
        from_zero(offsets.iter().map(across)),
    );
    let y = Axis::new(
        "in depth (mm)",
        range_of(offsets.iter().map(|o| o[2]).chain([0.0])),
    );
    let zero = Marks::Line(vec![(0.0, 0.0), (x.range.end, 0.0)]);
    let dots = Marks::Dots(offsets.iter().map(|o| (across(o), o[2])).collect());
    plot(
        SIZE,
        &x,
        &y,
        &[
            Series {
                color: FAINT,
                marks: zero,
            },
            Series {
                color: GREEN,
                marks: dots,
            },
        ],
    )
}

/// Fitted over true radius, mm, with the line of equality; `label` says whose truth it is.
pub(super) fn radius(label: &str, pairs: &[(f64, f64)]) -> Result<String, PlotError> {
    let both = range_of(pairs.iter().flat_map(|&(a, b)| [a, b]));
    let x = Axis::new(label, both.clone());
    let y = Axis::new("fitted radius (mm)", both.clone());
    let equal = Marks::Line(vec![(both.start, both.start), (both.end, both.end)]);
    plot(
        SIZE,
        &x,
        &y,
        &[
            Series {
                color: FAINT,
                marks: equal,
            },
            Series {
                color: OURS,
                marks: Marks::Dots(pairs.to_vec()),
            },
        ],
    )
}
