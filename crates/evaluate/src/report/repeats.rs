use super::colors::{OURS, PAPER};
use super::spread::{cumulative, histogram};
use crate::apple_row::AppleRow;
use crate::paper_figures::repeats as paper;
use crate::suite::{AngleErrors, Repeatability, SuiteResult};
use nalgebra::Vector3;
use pomona_geometry::angle_between;
use pomona_report::html::{figures, paragraph, table};
use pomona_report::number::{degrees, mm, percent};
use pomona_report::plot::{Axis, GREEN, Marks, PlotError, Series, plot, range_of};

/// Figures 13–15 and the figures of section 3; empty where the suite does not repeat one scene.
pub(super) fn section(result: &SuiteResult, rows: &[&AppleRow]) -> Result<String, PlotError> {
    let Some(repeats) = &result.repeatability else {
        return Ok(String::new());
    };
    let expected = Vector3::from(repeats.mean_foot) - Vector3::from(repeats.mean_center);
    let angles: Vec<f64> = rows
        .iter()
        .filter_map(|row| angle_between(&Vector3::from(row.direction?), &expected))
        .map(f64::to_degrees)
        .collect();
    let stated = [
        (10.0, paper::WITHIN_10_DEG),
        (20.0, paper::WITHIN_20_DEG),
        (50.0, 1.0 - paper::AT_LEAST_50_DEG),
    ];
    let mut text = String::from(
        "<h3>Repeatability: the answers against their own mean, as in section 3 of the paper</h3>\n",
    );
    text += &summary(result, repeats);
    text += &paragraph(
        "The expected direction is the vector from the mean O to the mean C of these very answers: the paper's \
         measure. It does not see an error that all repeats share; the last column does.",
    );
    let projections = [
        (
            [0, 1],
            "Figure 13, seen along the view: centres O red, feet C green, directions OC blue, the mean OC red.",
        ),
        ([0, 2], "The same from above."),
        ([2, 1], "The same from the side."),
    ];
    let scatters = projections
        .map(|(axes, caption)| scatter(rows, repeats, axes).map(|svg| (svg, caption.to_owned())));
    text += &figures(3, &scatters.into_iter().collect::<Result<Vec<_>, _>>()?);
    text += &figures(
        2,
        &[
            (
                histogram(&angles)?,
                "Figure 14: histogram of the angle to the mean direction.".to_owned(),
            ),
            (
                cumulative(&angles, &stated)?,
                "Figure 15: its cumulative share; the blue rings are the shares that the paper states."
                    .to_owned(),
            ),
        ],
    );
    Ok(text)
}

fn summary(result: &SuiteResult, repeats: &Repeatability) -> String {
    let own = &repeats.angle_to_mean;
    let row = |name: &str, paper: String, ours: String, truth: String| {
        vec![name.to_owned(), paper, ours, truth]
    };
    let angle = |form: fn(&AngleErrors) -> f64, write: fn(f64) -> String| {
        let truth = result
            .angle
            .as_ref()
            .map_or_else(String::new, |a| write(form(a)));
        (write(form(own)), truth)
    };
    let deg = |d: f64| format!("{d:.2}");
    let mut rows = vec![row(
        "repeats",
        paper::COUNT.to_string(),
        repeats.repeats.to_string(),
        String::new(),
    )];
    for (name, stated, form, write) in [
        (
            "angle mean °",
            deg(paper::ANGLE_MEAN_DEG),
            (|a| a.error.mean) as fn(&AngleErrors) -> f64,
            degrees as fn(f64) -> String,
        ),
        (
            "angle sd °",
            deg(paper::ANGLE_SD_DEG),
            |a| a.error.sd,
            degrees,
        ),
        (
            "≤ 10° %",
            percent(paper::WITHIN_10_DEG),
            |a| a.within_10_deg.share,
            percent,
        ),
        (
            "≤ 20° %",
            percent(paper::WITHIN_20_DEG),
            |a| a.within_20_deg.share,
            percent,
        ),
        (
            "≥ 50° %",
            percent(paper::AT_LEAST_50_DEG),
            |a| a.at_least_50_deg.share,
            percent,
        ),
    ] {
        let (ours, truth) = angle(form, write);
        rows.push(row(name, stated, ours, truth));
    }
    let bias = result
        .radius_error
        .as_ref()
        .map_or_else(String::new, |r| format!("bias {}", mm(r.mean)));
    rows.push(row(
        "radius mean mm",
        format!(
            "{}\nbias {}",
            mm(paper::RADIUS_MEAN),
            mm(paper::RADIUS_MEAN - paper::TRUE_RADIUS)
        ),
        mm(repeats.radius.mean),
        bias,
    ));
    rows.push(row(
        "radius sd mm",
        mm(paper::RADIUS_SD),
        mm(repeats.radius.sd),
        String::new(),
    ));
    let xyz = |sd: [f64; 3]| sd.map(mm).join(", ");
    let center = result
        .center_error
        .as_ref()
        .map_or_else(String::new, |c| format!("off {}", mm(c.mean)));
    let foot = result
        .foot_error
        .as_ref()
        .map_or_else(String::new, |c| format!("off {}", mm(c.mean)));
    rows.push(row(
        "sd of O x, y, z mm",
        format!("≤ {}", mm(paper::CENTER_SD_AT_MOST)),
        xyz(repeats.center_sd),
        center,
    ));
    rows.push(row(
        "sd of C x, y, z mm",
        mm(paper::FOOT_SD),
        xyz(repeats.foot_sd),
        foot,
    ));
    table(
        &["", "paper", "ours, same measure", "ours, against truth"],
        &rows,
    )
}

/// O, C and OC projected onto two axes of the camera, mm; y points down as in the image.
fn scatter(
    rows: &[&AppleRow],
    repeats: &Repeatability,
    [h, v]: [usize; 2],
) -> Result<String, PlotError> {
    const NAMES: [&str; 3] = ["x (mm)", "y (mm, down)", "z (mm, away)"];
    let flat = |p: [f64; 3]| (p[h] * 1e3, p[v] * 1e3);
    let pairs: Vec<[(f64, f64); 2]> = rows
        .iter()
        .filter_map(|row| Some([flat(row.center?), flat(row.foot?)]))
        .collect();
    let mean = [flat(repeats.mean_center), flat(repeats.mean_foot)];
    let all = || pairs.iter().flatten();
    let x = Axis::new(NAMES[h], range_of(all().map(|p| p.0)));
    // The image's y grows downwards: the range runs backwards.
    let y_range = range_of(all().map(|p| p.1));
    let down = if v == 1 {
        y_range.end..y_range.start
    } else {
        y_range
    };
    let y = Axis::new(NAMES[v], down);
    let (centers, feet) = (
        pairs.iter().map(|p| p[0]).collect(),
        pairs.iter().map(|p| p[1]).collect(),
    );
    plot(
        (420, 400),
        &x,
        &y,
        &[
            Series {
                color: PAPER,
                marks: Marks::Segments(pairs),
            },
            Series {
                color: GREEN,
                marks: Marks::Dots(feet),
            },
            Series {
                color: OURS,
                marks: Marks::Dots(centers),
            },
            Series {
                color: OURS,
                marks: Marks::Line(mean.to_vec()),
            },
        ],
    )
}
