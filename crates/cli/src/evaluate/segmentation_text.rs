use super::text_table::{known, table};
use crate::summary::plural;
use crate::terminal::Terminal;
use pomona_labels::{Estimate, SegmentationEvaluation, SegmentationResult, TruthKind};

/// A segmentation evaluation as tables of text.
pub(super) fn tables(evaluation: &SegmentationEvaluation, terminal: Terminal) -> String {
    let strokes = &evaluation.strokes;
    let title = format!(
        "Wood in {}: {} of {}, {}; within {} px, at a probability of {}",
        strokes.name,
        plural(strokes.images, "image"),
        plural(strokes.photographs, "photograph"),
        match strokes.truth {
            TruthKind::Masks => "masks".to_owned(),
            _ => plural(strokes.wood, "stroke"),
        },
        evaluation.tolerance_px,
        evaluation.threshold
    );
    let header = [
        "segmenter",
        "recall % from 4 px",
        "95 %",
        "3-4 px",
        "95 %",
        "precision %",
        "95 %",
        "IoU %",
        "posts %",
        "95 %",
        "calibration %",
    ];
    let rows: Vec<Vec<String>> = evaluation.results.iter().map(row).collect();
    let mut text = table(&title, &header, &rows, 1, terminal);
    let widths = evaluation.results.iter().map(|result| {
        let of_width = result
            .by_width
            .iter()
            .map(|w| format!("{:.1}", 100.0 * w.recall));
        std::iter::once(result.name.clone())
            .chain(of_width)
            .collect()
    });
    let widths: Vec<Vec<String>> = widths.collect();
    if let Some(first) = evaluation.results.first() {
        let names = first.by_width.iter().map(|w| w.width.name);
        let header: Vec<&str> = std::iter::once("recall %").chain(names).collect();
        text += &("\n".to_owned() + &table("By width", &header, &widths, 1, terminal));
    }
    if let Some(agreement) = &evaluation.agreement {
        let share = |p: &pomona_statistics::Proportion| format!("{:.1}", 100.0 * p.share);
        let rows = [
            vec![
                "all".to_owned(),
                share(&agreement.recall),
                share(&agreement.precision),
            ],
            vec![
                "from 4 px".to_owned(),
                share(&agreement.recall_wide),
                share(&agreement.precision_wide),
            ],
        ];
        let title = format!(
            "A second person's strokes of {}",
            plural(agreement.images, "image")
        );
        text += &("\n".to_owned()
            + &table(
                &title,
                &["wood", "recall %", "precision %"],
                &rows,
                1,
                terminal,
            ));
    }
    if !evaluation.differences.is_empty() {
        let rows = evaluation.differences.iter().map(|d| {
            let mut row = vec![format!("{} - {}", d.second, d.first)];
            for e in [&d.recall_wide, &d.precision, &d.iou] {
                row.push(format!("{:+.1}", 100.0 * e.value));
                row.push(interval(e));
            }
            row
        });
        let rows: Vec<Vec<String>> = rows.collect();
        let header = [
            "pair",
            "recall %",
            "95 %",
            "precision %",
            "95 %",
            "IoU %",
            "95 %",
        ];
        let title = "Differences, paired on the same photographs";
        text += &("\n".to_owned() + &table(title, &header, &rows, 1, terminal));
    }
    text
}

fn row(result: &SegmentationResult) -> Vec<String> {
    let value = |e: Option<Estimate>| known(e, |e| format!("{:.1}", 100.0 * e.value));
    let range = |e: Option<Estimate>| known(e, |e| interval(&e));
    vec![
        result.name.clone(),
        value(result.recall_wide),
        range(result.recall_wide),
        value(result.recall_thin),
        range(result.recall_thin),
        value(result.precision),
        range(result.precision),
        value(result.iou),
        value(result.posts),
        range(result.posts),
        format!("{:.1}", 100.0 * result.calibration_error),
    ]
}

fn interval(estimate: &Estimate) -> String {
    format!(
        "{:.1} to {:.1}",
        100.0 * estimate.low,
        100.0 * estimate.high
    )
}
