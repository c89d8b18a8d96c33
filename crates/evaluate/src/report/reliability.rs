use super::colors::{FAINT, OURS};
use super::spread::SIZE;
use crate::apple_row::AppleRow;
use crate::evaluation::Evaluation;
use crate::suite::{RIGHT_RAD, Reliability, SuiteResult};
use pomona_report::html::{figures, heading, paragraph, table};
use pomona_report::number::{degrees, or_unknown, percent, with_interval};
use pomona_report::plot::{Axis, GREEN, Marks, PlotError, Rgb, Series, from_zero, plot};
use pomona_statistics::Proportion;

/// Largest ratio of error and standard deviation that is drawn.
const RATIO_TOP: f64 = 5.0;

/// Every suite and method that says how sure it is, in one table; empty where none does.
pub(super) fn overview(evaluation: &Evaluation) -> String {
    let rows: Vec<Vec<String>> = evaluation
        .results
        .iter()
        .filter_map(|result| {
            let own = result.reliability.as_ref()?;
            let sd = own.direction_sd.as_ref();
            Some(vec![
                format!("{} · {}", result.suite, result.method),
                own.right.of.to_string(),
                percent(own.mean_confidence),
                with_interval(&own.right),
                format!("{:.3}", own.calibration_error),
                format!("{:.3}", own.calibration_error_equal_count),
                format!("{:.4}", own.brier),
                counted(&own.doubted_of_wrong),
                counted(&own.doubted_of_right),
                or_unknown(sd, |s| with_interval(&s.within_1_sd)),
                or_unknown(sd, |s| with_interval(&s.within_2_sd)),
                or_unknown(sd, |s| format!("{:.2}", s.ratio_rms)),
            ])
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    String::from("<h3>Does it know how sure it is?</h3>\n")
        + &table(
            &[
                "suite · method",
                "answers",
                "confidence %",
                "≤ 20° %",
                "ECE",
                "ECE, equal counts",
                "Brier",
                "wrong: doubted",
                "right: doubted",
                "≤ 1 sd %",
                "≤ 2 sd %",
                "rms error / sd",
            ],
            &rows,
        )
        + &paragraph(
            "A confidence is the probability of an error of at most 20°, which is called right here; doubted is a \
             confidence under 0.5. ECE is the expected calibration error over ten bins of equal width, beside it over \
             ten of equal count. The standard deviation of a direction is that along each of two axes, over right \
             answers: calibrated are 39.3 % within one, 86.5 % within two, and a root mean square of 1.41.",
        )
}

/// The diagram, the curve and the tables of one suite and method; empty where it says nothing of how sure it is.
pub(super) fn section(result: &SuiteResult, rows: &[&AppleRow]) -> Result<String, PlotError> {
    let Some(own) = &result.reliability else {
        return Ok(String::new());
    };
    let mut plots = vec![
        (
            diagram(own)?,
            "Reliability: share of answers at most 20° off over their mean confidence, in ten bins of equal width, \
             with 95 % intervals; the line is perfect calibration."
                .to_owned(),
        ),
        (
            confidences(rows)?,
            "Confidences of the answers: right ones green, wrong ones (over 20°) red, as shares of all answers."
                .to_owned(),
        ),
        (
            risk(own)?,
            "Risk over coverage: what share of the answers is wrong when only the surest are given, in per cent of \
             the apples asked for; the grey line is the mean angle error in degrees."
                .to_owned(),
        ),
    ];
    if own.direction_sd.is_some() {
        plots.push((
            ratios(rows)?,
            "Angle error over the standard deviation given, cumulative, of the right answers; grey what calibrated \
             ones have."
                .to_owned(),
        ));
    }
    let bins: Vec<Vec<String>> = own
        .bins
        .iter()
        .map(|bin| {
            vec![
                format!("{:.1} – {:.1}", bin.from, bin.to),
                bin.right.of.to_string(),
                percent(bin.mean_confidence),
                with_interval(&bin.right),
            ]
        })
        .collect();
    let thresholds: Vec<Vec<String>> = [1.0, 0.99, 0.98, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.25]
        .iter()
        .filter_map(|&share| {
            let full = own.risk_coverage.last()?.coverage;
            let mut points = own.risk_coverage.iter();
            let point = points.rfind(|p| p.coverage <= share * full + 1e-9)?;
            Some(vec![
                format!("{:.3}", point.confidence),
                percent(point.coverage),
                with_interval(&point.wrong),
                degrees(point.angle_mean),
            ])
        })
        .collect();
    Ok(heading("Confidence against outcome")
        + &figures(2, &plots)
        + &table(
            &["confidence", "answers", "mean confidence %", "≤ 20° %"],
            &bins,
        )
        + &table(
            &[
                "refused below",
                "answered %",
                "wrong %",
                "mean angle error °",
            ],
            &thresholds,
        ))
}

fn counted(share: &Proportion) -> String {
    if share.of == 0 {
        return "0 of 0".to_owned();
    }
    format!(
        "{} of {}\n{} %",
        share.count,
        share.of,
        percent(share.share)
    )
}

fn line(color: Rgb, points: Vec<(f64, f64)>) -> Series {
    Series {
        color,
        marks: Marks::Line(points),
    }
}

fn diagram(own: &Reliability) -> Result<String, PlotError> {
    let points = own.bins.iter().map(|bin| {
        let right = &bin.right;
        (bin.mean_confidence, right.low, right.share, right.high)
    });
    let x = Axis::new("confidence given", 0.0..1.04);
    let y = Axis::new("share at most 20° off", 0.0..1.04);
    let marks = Marks::Intervals(points.collect());
    let series = [
        line(FAINT, vec![(0.0, 0.0), (1.0, 1.0)]),
        Series { color: OURS, marks },
    ];
    plot(SIZE, &x, &y, &series)
}

fn confidences(rows: &[&AppleRow]) -> Result<String, PlotError> {
    const BARS: usize = 25;
    let answers: Vec<(f64, f64)> = rows
        .iter()
        .filter_map(|row| Some((row.confidence?, row.angle_error?)))
        .collect();
    let bars = |right: Option<bool>| -> Vec<(f64, f64, f64)> {
        let of = |i: usize| {
            let number = |c: f64| ((c * BARS as f64).max(0.0) as usize).min(BARS - 1);
            let wanted = |e: f64| right.is_none_or(|right| (e <= RIGHT_RAD) == right);
            let inside = answers
                .iter()
                .filter(|a| number(a.0) == i && wanted(a.1))
                .count();
            100.0 * inside as f64 / answers.len() as f64
        };
        let at = |i: usize| i as f64 / BARS as f64;
        (0..BARS).map(|i| (at(i), at(i + 1), of(i))).collect()
    };
    let (all, wrong) = (bars(None), bars(Some(false)));
    let x = Axis::new("confidence given", 0.0..1.0);
    let y = Axis::new("share of answers (%)", from_zero(all.iter().map(|b| b.2)));
    let bar = |color, bars| Series {
        color,
        marks: Marks::Bars(bars),
    };
    plot(SIZE, &x, &y, &[bar(GREEN, all), bar(OURS, wrong)])
}

fn risk(own: &Reliability) -> Result<String, PlotError> {
    let curve = &own.risk_coverage;
    let wrong = curve
        .iter()
        .map(|p| (100.0 * p.coverage, 100.0 * p.wrong.share));
    let angle = curve
        .iter()
        .map(|p| (100.0 * p.coverage, p.angle_mean.to_degrees()));
    let top = wrong.clone().chain(angle.clone()).map(|p| p.1);
    let x = Axis::new("answered (%)", 0.0..101.0);
    let y = Axis::new("wrong (%), mean error (°)", from_zero(top));
    let series = [line(FAINT, angle.collect()), line(OURS, wrong.collect())];
    plot(SIZE, &x, &y, &series)
}

fn ratios(rows: &[&AppleRow]) -> Result<String, PlotError> {
    let mut ratios: Vec<f64> = rows
        .iter()
        .filter_map(|row| {
            let error = row.angle_error.filter(|&e| e <= RIGHT_RAD)?;
            Some(error / row.direction_sd.filter(|&sd| sd > 0.0)?)
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    let share = |i: usize| 100.0 * (i + 1) as f64 / ratios.len() as f64;
    let own = ratios.iter().enumerate();
    let own = own
        .map(|(i, &r)| (r, share(i)))
        .take_while(|p| p.0 <= RATIO_TOP);
    let calibrated = (0..=50).map(|i| {
        let r = RATIO_TOP * f64::from(i) / 50.0;
        (r, 100.0 * (1.0 - (-0.5 * r * r).exp()))
    });
    let x = Axis::new("angle error / sd given", 0.0..RATIO_TOP);
    let y = Axis::new("cumulative share (%)", 0.0..104.0);
    let series = [line(FAINT, calibrated.collect()), line(OURS, own.collect())];
    plot(SIZE, &x, &y, &series)
}
