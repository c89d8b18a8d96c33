use crate::evaluation::Evaluation;
use crate::paper_figures::{PaperTime, TIME_DETECTION, TIME_LINE, TIME_SPHERE, TIME_TOTAL};
use crate::suite::{AngleErrors, SuiteResult};
use pomona_report::html::{paragraph, table};
use pomona_report::number::{degrees, mean_with_interval, mm, or_unknown, percent, with_interval};
use pomona_statistics::MeanSd;

/// Every suite under every method in two tables, and the methods in pairs.
pub(super) fn tables(evaluation: &Evaluation) -> String {
    let name = |result: &SuiteResult| format!("{} · {}", result.suite, result.method);
    let directions: Vec<Vec<String>> = evaluation
        .results
        .iter()
        .map(|result| {
            let angle = result.angle.as_ref();
            let of = |form: &dyn Fn(&AngleErrors) -> String| or_unknown(angle, form);
            vec![
                name(result),
                result.apples.to_string(),
                with_interval(&result.answered),
                of(&|a| mean_with_interval(&a.error, degrees)),
                of(&|a| degrees(a.error.sd)),
                of(&|a| degrees(a.error.median)),
                of(&|a| degrees(a.error.p95)),
                of(&|a| degrees(a.error.max)),
                of(&|a| with_interval(&a.within_10_deg)),
                of(&|a| with_interval(&a.within_20_deg)),
                of(&|a| with_interval(&a.at_least_50_deg)),
                with_interval(&result.refusals.hits),
            ]
        })
        .collect();
    let places: Vec<Vec<String>> = evaluation
        .results
        .iter()
        .map(|result| {
            vec![
                name(result),
                or_unknown(result.center_error.as_ref(), |s| mean_with_interval(s, mm)),
                or_unknown(result.center_error.as_ref(), |s| mm(s.p95)),
                or_unknown(result.center_bias, |b| b.map(mm).join(", ")),
                or_unknown(result.radius_error.as_ref(), |s| mean_with_interval(s, mm)),
                or_unknown(result.radius_error_absolute.as_ref(), |s| mm(s.mean)),
                or_unknown(result.foot_error.as_ref(), |s| mean_with_interval(s, mm)),
                or_unknown(result.foot_error.as_ref(), |s| mm(s.median)),
            ]
        })
        .collect();
    let mut text = String::from("<h2>Overview</h2>\n<h3>Direction against truth</h3>\n");
    text += &table(
        &[
            "suite · method",
            "apples",
            "answered %",
            "angle error °: mean",
            "sd",
            "median",
            "p95",
            "max",
            "≤ 10° %",
            "≤ 20° %",
            "≥ 50° %",
            "hits %",
        ],
        &directions,
    );
    text += &paragraph(
        "Angle errors and their shares are over the answered apples; a hit is an answer at most 10° off, of all \
         apples asked for.",
    );
    text += "<h3>Centre, radius and foot against truth, mm</h3>\n";
    text += &table(
        &[
            "suite · method",
            "centre error: mean",
            "p95",
            "centre bias x, y, z",
            "radius bias",
            "radius |error|",
            "foot error: mean",
            "median",
        ],
        &places,
    );
    text + &comparisons(evaluation)
}

fn comparisons(evaluation: &Evaluation) -> String {
    if evaluation.comparisons.is_empty() {
        return String::new();
    }
    let rows: Vec<Vec<String>> = evaluation
        .comparisons
        .iter()
        .map(|c| {
            vec![
                format!("{} · {} less {}", c.suite, c.second, c.first),
                or_unknown(c.angle_difference.as_ref(), |s| s.count.to_string()),
                or_unknown(c.angle_difference.as_ref(), |s| {
                    mean_with_interval(s, degrees)
                }),
                or_unknown(c.angle_difference.as_ref(), |s| degrees(s.median)),
                or_unknown(c.center_difference.as_ref(), |s| mean_with_interval(s, mm)),
                c.only_first_answered.to_string(),
                c.only_second_answered.to_string(),
            ]
        })
        .collect();
    String::from("<h3>Methods in pairs, on the same apples</h3>\n")
        + &table(
            &[
                "pair",
                "both answered",
                "angle difference °: mean",
                "median",
                "centre difference mm",
                "only first answered",
                "only second",
            ],
            &rows,
        )
}

/// Answers and refusals against what the camera could see.
pub(super) fn refusals(result: &SuiteResult) -> String {
    let refusals = &result.refusals;
    let by_status: Vec<String> = refusals
        .by_status
        .iter()
        .map(|(status, count)| format!("{count} {status}"))
        .collect();
    paragraph(&format!(
        "{} apples in {} frames: {}. Refused rightly (apple or branch out of sight) {}, wrongly {}, not judged {}; \
         answered with apple or branch out of sight {}; picks of no known apple {}.",
        result.apples,
        result.cases,
        by_status.join(", "),
        refusals.right,
        refusals.wrong,
        refusals.unjudged,
        refusals.answered_unseen,
        result.stray_picks
    ))
}

/// Table 4.
pub(super) fn timing(result: &SuiteResult) -> String {
    let Some(timing) = &result.timing_ms else {
        return String::new();
    };
    let row = |name: &str, paper: PaperTime, ours: Option<MeanSd>| {
        vec![
            name.to_owned(),
            format!("{:.0}", 1000.0 * paper.mean_s),
            format!("{:.0}", 1000.0 * paper.sd_s),
            or_unknown(ours, |s| format!("{:.2}", s.mean)),
            or_unknown(ours, |s| format!("{:.2}", s.sd)),
        ]
    };
    String::from("<h3>Table 4: time per apple, ms</h3>\n")
        + &table(
            &["stage", "paper", "± sd", "ours", "± sd"],
            &[
                row("detection in the colour image", TIME_DETECTION, None),
                row("sphere", TIME_SPHERE, Some(timing.sphere)),
                row("shell, line and direction", TIME_LINE, Some(timing.branch)),
                row(
                    "total (ours: from the box on)",
                    TIME_TOTAL,
                    Some(timing.total),
                ),
            ],
        )
        + &paragraph(&format!(
            "Paper: AMD R7-5800H. Ours: answered apples, while other frames share the cores; boxes are given. \
             {} % of the answers are at most 10° off.",
            or_unknown(result.angle.as_ref(), |a| percent(a.within_10_deg.share))
        ))
}
