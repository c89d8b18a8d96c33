use super::colors::{FAINT, OURS};
use super::spread::{SIZE, radius};
use crate::calipers::{Alignment, CaliperReport, CaliperResult};
use crate::error::EvaluateError;
use pomona_report::html::{escape, figures, page, paragraph, table};
use pomona_report::number::{UNKNOWN, mean_with_interval, mm, or_unknown};
use pomona_report::plot::{Axis, GREEN, Marks, PlotError, Series, from_zero, plot};

/// A self-contained page of fitted radii beside measured ones.
///
/// # Errors
///
/// [`EvaluateError::Plot`] where a plot cannot be drawn.
pub fn caliper_page(report: &CaliperReport) -> Result<String, EvaluateError> {
    let mut body = paragraph(&format!(
        "Fitted radius beside half the diameter that calipers measured, seed {}. Intervals are 95 %, bootstrap \
         over apples.",
        report.seed
    ));
    for result in &report.results {
        body += &method(result)?;
    }
    Ok(page("Radii against calipers", &body))
}

fn method(result: &CaliperResult) -> Result<String, PlotError> {
    let mut text = format!("<h2>Method {}</h2>\n", escape(&result.method));
    let count = result.radius_error.as_ref().map_or(0, |s| s.count);
    text += &table(
        &[
            "boxes with a sphere",
            "mean |error| mm",
            "bias mm",
            "sd mm",
            "median error mm",
            "largest |error| mm",
        ],
        &[vec![
            count.to_string(),
            or_unknown(result.radius_error_absolute.as_ref(), |s| {
                mean_with_interval(s, mm)
            }),
            or_unknown(result.radius_error.as_ref(), |s| mean_with_interval(s, mm)),
            or_unknown(result.radius_error.as_ref(), |s| mm(s.sd)),
            or_unknown(result.radius_error.as_ref(), |s| mm(s.median)),
            or_unknown(result.radius_error_absolute.as_ref(), |s| mm(s.max)),
        ]],
    );
    let frames: Vec<Vec<String>> = result
        .frames
        .iter()
        .map(|frame| {
            let statuses: Vec<String> = frame
                .by_status
                .iter()
                .map(|(s, n)| format!("{n} {s}"))
                .collect();
            vec![
                frame.frame.clone(),
                frame.boxes.to_string(),
                frame.measured.to_string(),
                or_unknown(frame.radius_error_absolute, mm),
                statuses.join(", "),
            ]
        })
        .collect();
    text += &table(
        &["frame", "boxes", "measured", "mean |error| mm", "statuses"],
        &frames,
    );

    let pairs: Vec<(f64, f64)> = result
        .apples
        .iter()
        .filter_map(|row| Some((row.measured_radius * 1e3, row.radius? * 1e3)))
        .collect();
    let mut plots = vec![(
        radius("measured radius (mm)", &pairs)?,
        "Fitted over measured radius; the line is equality.".to_owned(),
    )];
    for alignment in result.alignments.iter().filter(|a| !a.apples.is_empty()) {
        plots.push((
            distances(alignment)?,
            format!(
                "Centres of {} and {} after alignment: fitted apples red, others grey.",
                alignment.first, alignment.second
            ),
        ));
    }
    text += &figures(2, &plots);
    text += "<h3>The two sights of each tree</h3>\n";
    for alignment in &result.alignments {
        text += &consistency(alignment);
    }
    let apples: Vec<Vec<String>> = result
        .apples
        .iter()
        .map(|row| {
            vec![
                row.box_name.clone(),
                row.frame.clone(),
                row.status.clone(),
                mm(row.measured_radius),
                or_unknown(row.radius, mm),
                or_unknown(row.radius_error, mm),
                or_unknown(row.distance, |d| format!("{d:.3}")),
            ]
        })
        .collect();
    text += "<h3>Apple by apple</h3>\n";
    text += &table(
        &[
            "box",
            "frame",
            "status",
            "measured radius mm",
            "fitted mm",
            "error mm",
            "distance m",
        ],
        &apples,
    );
    Ok(text)
}

fn consistency(alignment: &Alignment) -> String {
    let names = format!("{} and {}", alignment.first, alignment.second);
    let Some(distance) = &alignment.distance else {
        return paragraph(&format!(
            "{names}: {} apples of one name have a centre in both, too few to align by.",
            alignment.shared
        ));
    };
    let way = alignment.translation.map_or_else(
        || UNKNOWN.to_owned(),
        |t| mm(nalgebra::Vector3::from(t).norm()),
    );
    paragraph(&format!(
        "{names}: {} apples of one name have a centre in both; one rigid motion ({way} mm, {:.1}°) brings {} of them \
         to within 30 mm. Their two centres are then {} mm apart on average, median {}, largest {}. An error that both \
         sights share does not show.",
        alignment.shared,
        alignment.rotation_angle.unwrap_or_default().to_degrees(),
        alignment.fitted,
        mm(distance.mean),
        mm(distance.median),
        mm(distance.max)
    ))
}

fn distances(alignment: &Alignment) -> Result<String, PlotError> {
    let mut sorted: Vec<(f64, bool)> = alignment
        .apples
        .iter()
        .map(|a| (a.distance * 1e3, a.fitted))
        .collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let bars = |fitted: bool| {
        let own = sorted.iter().enumerate().filter(|(_, (_, f))| *f == fitted);
        Marks::Bars(
            own.map(|(i, &(d, _))| (i as f64, i as f64 + 1.0, d.min(100.0)))
                .collect(),
        )
    };
    let x = Axis::new("apples, by distance", 0.0..sorted.len() as f64);
    let y = Axis::new(
        "distance of centres (mm, cut at 100)",
        from_zero(sorted.iter().map(|s| s.0.min(100.0))),
    );
    let middle = alignment.distance.as_ref().map_or(0.0, |d| d.median * 1e3);
    let median = Marks::Line(vec![(0.0, middle), (sorted.len() as f64, middle)]);
    plot(
        SIZE,
        &x,
        &y,
        &[
            Series {
                color: OURS,
                marks: bars(true),
            },
            Series {
                color: FAINT,
                marks: bars(false),
            },
            Series {
                color: GREEN,
                marks: median,
            },
        ],
    )
}
