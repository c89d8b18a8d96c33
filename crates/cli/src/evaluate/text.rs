mod base;

use crate::terminal::{FAINT, HEADING, Terminal, one_line};
use pomona_evaluate::{Alignment, CaliperReport, Evaluation, LabRow, SuiteResult};
use pomona_statistics::{Proportion, Summary};

/// Shown in place of an unknown value.
pub(super) const UNKNOWN: &str = "-";

/// An evaluation as tables of text.
pub(super) fn evaluation(evaluation: &Evaluation, terminal: Terminal) -> String {
    let header = [
        "suite",
        "method",
        "apples",
        "answered %",
        "angle deg",
        "95 %",
        "sd",
        "median",
        "p95",
        "max",
        "<=10 %",
        "<=20 %",
        ">=50 %",
        "O mm",
        "r bias mm",
        "foot mm",
        "ms",
    ];
    let rows: Vec<Vec<String>> = evaluation.results.iter().map(result).collect();
    let mut text = table("Accuracy against truth", &header, &rows, 2, terminal);
    let rows: Vec<Vec<String>> = evaluation.results.iter().filter_map(repeats).collect();
    if !rows.is_empty() {
        let header = [
            "suite",
            "method",
            "repeats",
            "angle deg",
            "sd",
            "<=10 %",
            "<=20 %",
            ">=50 %",
            "r mm",
            "sd",
            "sd O mm x/y/z",
            "sd C mm x/y/z",
        ];
        let title = "Repeatability against the answers' own mean, the paper's measure (paper: 474, 11.81, 13.65, 62.7, \
                     85.0, 3.4, 42.64, 1.79, <=2.5, 15.60)";
        text += &("\n".to_owned() + &table(title, &header, &rows, 2, terminal));
    }
    let rows: Vec<Vec<String>> = evaluation.results.iter().filter_map(reliability).collect();
    if !rows.is_empty() {
        let header = [
            "suite",
            "method",
            "answers",
            "confidence %",
            "<=20 %",
            "ECE",
            "wrong",
            "doubted",
            "<=1 sd %",
            "<=2 sd %",
        ];
        let title = "Confidence against outcome (ECE: expected calibration error, ten bins of equal width; doubted: \
                     wrong answers under 0.5; calibrated sd: 39.3, 86.5)";
        text += &("\n".to_owned() + &table(title, &header, &rows, 2, terminal));
    }
    for of in evaluation.results.iter().filter(|of| !of.lab.is_empty()) {
        let header = [
            "orientation",
            "draws",
            "r mm paper",
            "ours",
            "O off mm",
            "error deg paper",
            "ours",
            "max",
        ];
        let rows: Vec<Vec<String>> = of.lab.iter().map(lab).collect();
        let title = format!("Tables 1-3 of the paper and {}, {}", of.suite, of.method);
        text += &("\n".to_owned() + &table(&title, &header, &rows, 1, terminal));
    }
    text + &pairs(evaluation, terminal) + &base::tables(evaluation, terminal)
}

/// The methods in pairs, apple by apple; nothing where there is one method.
fn pairs(evaluation: &Evaluation, terminal: Terminal) -> String {
    let rows: Vec<Vec<String>> = evaluation
        .comparisons
        .iter()
        .map(|c| {
            let difference = c.angle_difference.as_ref();
            vec![
                c.suite.clone(),
                format!("{} less {}", c.second, c.first),
                known(difference, |s| s.count.to_string()),
                known(difference, |s| degrees(s.mean)),
                known(difference, |s| s.mean_interval.map(degrees).join("..")),
                c.only_first_answered.to_string(),
                c.only_second_answered.to_string(),
            ]
        })
        .collect();
    if !rows.is_empty() {
        let header = [
            "suite",
            "pair",
            "both",
            "angle deg",
            "95 %",
            "only first",
            "only second",
        ];
        return "\n".to_owned() + &table("Methods in pairs", &header, &rows, 2, terminal);
    }
    String::new()
}

/// Radii against calipers as tables of text.
pub(super) fn calipers(report: &CaliperReport, terminal: Terminal) -> String {
    let mut text = String::new();
    for result in &report.results {
        let rows: Vec<Vec<String>> = result
            .apples
            .iter()
            .map(|row| {
                vec![
                    row.box_name.clone(),
                    row.frame.clone(),
                    row.status.clone(),
                    mm(row.measured_radius),
                    known(row.radius, mm),
                    known(row.radius_error, mm),
                ]
            })
            .collect();
        let header = ["box", "frame", "status", "measured r mm", "fitted", "error"];
        let title = format!("Radii against calipers, {}", result.method);
        text += &table(&title, &header, &rows, 3, terminal);
        let absolute = known(result.radius_error_absolute.as_ref(), |s| {
            with_interval(s, mm)
        });
        let bias = known(result.radius_error.as_ref(), |s| with_interval(s, mm));
        let count = result.radius_error.as_ref().map_or(0, |s| s.count);
        let means = format!(
            "mean |error| {absolute} mm, bias {bias} mm, over {count} boxes with a sphere\n"
        );
        text += &means;
        for alignment in &result.alignments {
            text += &(consistency(alignment) + "\n");
        }
    }
    text
}

fn consistency(alignment: &Alignment) -> String {
    let names = format!(
        "{} and {}",
        one_line(&alignment.first),
        one_line(&alignment.second)
    );
    match &alignment.distance {
        Some(distance) => format!(
            "{names}: {} shared names, {} aligned within 30 mm; centres then {} mm apart on average, median {}, \
             largest {}",
            alignment.shared,
            alignment.fitted,
            mm(distance.mean),
            mm(distance.median),
            mm(distance.max)
        ),
        None => format!(
            "{names}: {} shared names, too few to align by",
            alignment.shared
        ),
    }
}

fn result(of: &SuiteResult) -> Vec<String> {
    let angle = of.angle.as_ref();
    let error = angle.map(|a| &a.error);
    vec![
        of.suite.clone(),
        of.method.clone(),
        of.apples.to_string(),
        percent(&of.answered),
        known(error, |s| degrees(s.mean)),
        known(error, |s| s.mean_interval.map(degrees).join("..")),
        known(error, |s| degrees(s.sd)),
        known(error, |s| degrees(s.median)),
        known(error, |s| degrees(s.p95)),
        known(error, |s| degrees(s.max)),
        known(angle, |a| percent(&a.within_10_deg)),
        known(angle, |a| percent(&a.within_20_deg)),
        known(angle, |a| percent(&a.at_least_50_deg)),
        known(of.center_error.as_ref(), |s| mm(s.mean)),
        known(of.radius_error.as_ref(), |s| mm(s.mean)),
        known(of.foot_error.as_ref(), |s| mm(s.mean)),
        known(of.timing_ms, |t| format!("{:.1}", t.total.mean)),
    ]
}

fn repeats(of: &SuiteResult) -> Option<Vec<String>> {
    let own = of.repeatability.as_ref()?;
    let angle = &own.angle_to_mean;
    Some(vec![
        of.suite.clone(),
        of.method.clone(),
        own.repeats.to_string(),
        degrees(angle.error.mean),
        degrees(angle.error.sd),
        percent(&angle.within_10_deg),
        percent(&angle.within_20_deg),
        percent(&angle.at_least_50_deg),
        mm(own.radius.mean),
        mm(own.radius.sd),
        own.center_sd.map(mm).join("/"),
        own.foot_sd.map(mm).join("/"),
    ])
}

fn reliability(of: &SuiteResult) -> Option<Vec<String>> {
    let own = of.reliability.as_ref()?;
    let sd = own.direction_sd.as_ref();
    Some(vec![
        of.suite.clone(),
        of.method.clone(),
        own.right.of.to_string(),
        format!("{:.1}", 100.0 * own.mean_confidence),
        percent(&own.right),
        format!("{:.3}", own.calibration_error),
        own.doubted_of_wrong.of.to_string(),
        own.doubted_of_wrong.count.to_string(),
        known(sd, |s| percent(&s.within_1_sd)),
        known(sd, |s| percent(&s.within_2_sd)),
    ])
}

fn lab(row: &LabRow) -> Vec<String> {
    vec![
        row.orientation.clone(),
        row.draws.to_string(),
        mm(row.paper_radius),
        known(row.radius, |s| mm(s.mean)),
        known(row.center_error.as_ref(), |s| mm(s.mean)),
        degrees(row.paper_angle_error),
        known(row.angle_error.as_ref(), |s| degrees(s.mean)),
        known(row.angle_error.as_ref(), |s| degrees(s.max)),
    ]
}

pub(super) fn known<T>(value: Option<T>, form: impl Fn(T) -> String) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), form)
}

fn degrees(radians: f64) -> String {
    format!("{:.2}", radians.to_degrees())
}

fn mm(metres: f64) -> String {
    format!("{:.2}", metres * 1000.0)
}

fn percent(share: &Proportion) -> String {
    format!("{:.1}", 100.0 * share.share)
}

fn with_interval(summary: &Summary, form: fn(f64) -> String) -> String {
    format!(
        "{} ({})",
        form(summary.mean),
        summary.mean_interval.map(form).join(" to ")
    )
}

/// A title, a header and rows; the first `words` columns are words and stand to the left.
pub(super) fn table(
    title: &str,
    header: &[&str],
    rows: &[Vec<String>],
    words: usize,
    terminal: Terminal,
) -> String {
    let widths: Vec<usize> = header
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let cells = rows.iter().map(|row| row[i].chars().count());
            cells.chain([name.chars().count()]).max().unwrap_or(0)
        })
        .collect();
    let line = |cells: &mut dyn Iterator<Item = &str>| -> String {
        let cells = cells.zip(&widths).enumerate().map(|(i, (cell, &width))| {
            let cell = one_line(cell);
            if i < words {
                format!("{cell:<width$}")
            } else {
                format!("{cell:>width$}")
            }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let mut text = terminal.paint(HEADING, title) + "\n";
    text += &(terminal.paint(FAINT, &line(&mut header.iter().copied())) + "\n");
    for row in rows {
        text += &(line(&mut row.iter().map(String::as_str)) + "\n");
    }
    text
}
