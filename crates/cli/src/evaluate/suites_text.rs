use super::robot_text;
use super::text_table::{degrees, known, mm, percent, table};
use crate::terminal::Terminal;
use pomona_evaluate::{Evaluation, LabRow, SuiteResult};

/// An evaluation as tables of text.
pub(super) fn tables(evaluation: &Evaluation, terminal: Terminal) -> String {
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
    text + &pairs(evaluation, terminal) + &robot_text::tables(evaluation, terminal)
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
