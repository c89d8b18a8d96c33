use super::text_table::{known, percent, table};
use crate::terminal::Terminal;
use pomona_evaluate::{RealAgreement, RealFigures, RealReport, RealResult, UnseenFigures};
use pomona_statistics::Proportion;

/// Directions on real frames as tables of text.
pub(super) fn tables(report: &RealReport, terminal: Terminal) -> String {
    let header = [
        "method",
        "frame",
        "apples",
        "answered %",
        "right % of answers",
        "95 %",
        "foot on wood %",
        "right % of apples",
        "elsewhere",
        "refused",
    ];
    let rows = rows(report, seen);
    let mut text = table("Apples whose wood is seen", &header, &rows, 2, terminal);
    let header = [
        "method",
        "frame",
        "wood",
        "apples",
        "refused %",
        "answered %",
        "confidence >= 0.5 %",
    ];
    let rows: Vec<Vec<String>> = report.results.iter().flat_map(unseen).collect();
    text += "\n";
    text += &table(
        "Apples whose wood is not seen for certain",
        &header,
        &rows,
        3,
        terminal,
    );
    let rows: Vec<Vec<String>> = report.results.iter().filter_map(reliability).collect();
    if !rows.is_empty() {
        let header = [
            "method",
            "< 0.5",
            "0.5 to 0.7",
            "0.7 to 0.9",
            ">= 0.9",
            "mean confidence",
            "Brier",
        ];
        text += "\n";
        text += &table(
            "Right of the answers to apples whose wood is seen, by confidence",
            &header,
            &rows,
            1,
            terminal,
        );
    }
    let rows: Vec<Vec<String>> = report.results.iter().filter_map(between).collect();
    if !rows.is_empty() {
        let header = [
            "method",
            "pairs",
            "answered in both %",
            "<=20 deg % of those",
            ">50 deg % of those",
        ];
        text += "\n";
        text += &table(
            "Directions of the same apples in two frames",
            &header,
            &rows,
            1,
            terminal,
        );
    }
    let rows: Vec<Vec<String>> = report.results.iter().filter_map(perturbed).collect();
    if !rows.is_empty() {
        let header = [
            "method",
            "boxes of copies",
            "flipped %",
            "answered in both %",
            "<=20 deg % of those",
            ">50 deg % of those",
        ];
        text += "\n";
        text += &table(
            "Directions from perturbed copies of the frames",
            &header,
            &rows,
            1,
            terminal,
        );
    }
    text
}

fn between(result: &RealResult) -> Option<Vec<String>> {
    let own = result.between_frames.as_ref()?;
    let mut row = vec![result.method.clone(), own.answered_in_both.of.to_string()];
    row.extend(agreement(own));
    Some(row)
}

fn perturbed(result: &RealResult) -> Option<Vec<String>> {
    let own = result.all.perturbed.as_ref()?;
    let mut row = vec![
        result.method.clone(),
        own.flipped.of.to_string(),
        percent(&own.flipped),
    ];
    row.extend(agreement(&own.directions));
    Some(row)
}

fn agreement(of: &RealAgreement) -> [String; 3] {
    [&of.answered_in_both, &of.within_20_deg, &of.beyond_50_deg].map(percent)
}

/// A row for each method over all frames, and where there are several for each of them.
fn rows(report: &RealReport, cells: fn(&RealFigures) -> Vec<String>) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for result in &report.results {
        let of = |frame: &str, figures: &RealFigures| {
            let mut row = vec![result.method.clone(), frame.to_owned()];
            row.extend(cells(figures));
            row
        };
        rows.push(of("all", &result.all));
        if result.frames.len() > 1 {
            rows.extend(result.frames.iter().map(|f| of(&f.frame, &f.figures)));
        }
    }
    rows
}

fn seen(figures: &RealFigures) -> Vec<String> {
    let seen = &figures.seen;
    let refused = seen
        .refused
        .iter()
        .map(|(status, n)| format!("{n} {status}"));
    vec![
        seen.answered.of.to_string(),
        percent(&seen.answered),
        percent(&seen.right),
        format!(
            "{:.1}..{:.1}",
            100.0 * seen.right.low,
            100.0 * seen.right.high
        ),
        percent(&seen.on_wood),
        percent(&seen.hits),
        seen.elsewhere.to_string(),
        refused.collect::<Vec<_>>().join(", "),
    ]
}

fn unseen(result: &RealResult) -> Vec<Vec<String>> {
    let row = |wood: &str, of: &UnseenFigures| {
        (of.refused.of > 0).then(|| {
            vec![
                result.method.clone(),
                "all".to_owned(),
                wood.to_owned(),
                of.refused.of.to_string(),
                percent(&of.refused),
                percent(&of.answered),
                percent(&of.confident),
            ]
        })
    };
    let all = &result.all;
    let rows = [
        row("none", &all.none),
        row("doubtful", &all.doubtful),
        row("unlisted", &all.unlisted),
    ];
    rows.into_iter().flatten().collect()
}

fn reliability(result: &RealResult) -> Option<Vec<String>> {
    let own = result.all.reliability.as_ref()?;
    let share = |p: &Proportion| format!("{} of {}", p.count, p.of);
    let mut row = vec![result.method.clone()];
    row.extend(own.bins.iter().map(|bin| share(&bin.right)));
    row.push(known(Some(own.mean_confidence), |c| format!("{c:.2}")));
    row.push(format!("{:.3}", own.brier));
    Some(row)
}
