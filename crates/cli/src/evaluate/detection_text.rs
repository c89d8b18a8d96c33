use super::text_table::{UNKNOWN, known, table};
use crate::terminal::Terminal;
use pomona_labels::{DetectionEvaluation, DetectionResult, Estimate, SizeRecall};
use pomona_statistics::Proportion;

/// A detection evaluation as tables of text.
pub(super) fn tables(evaluation: &DetectionEvaluation, terminal: Terminal) -> String {
    let data = &evaluation.dataset;
    let header = [
        "detector",
        "runtime",
        "AP50 %",
        "95 %",
        "AP50-95 %",
        "95 %",
        "AP50 COCO",
        "AP50-95 COCO",
        "best F1 %",
        "at score",
        "recall %",
        "precision %",
        "FP/image",
        "mean IoU",
    ];
    let title = format!(
        "Detection in {}: {} images, {} labels ({} ignored); AP by all points, beside it by COCO's 101; recall, \
         precision, false positives (FP) and IoU at score {}",
        data.name, data.images, data.labels, data.ignored_labels, evaluation.threshold
    );
    let rows: Vec<Vec<String>> = evaluation.results.iter().map(result).collect();
    let mut text = table(&title, &header, &rows, 2, terminal);
    for (title, of) in [
        (
            "COCO's sizes",
            of_coco as fn(&DetectionResult) -> &[SizeRecall],
        ),
        ("finer sizes", of_fine),
    ] {
        text += &("\n".to_owned() + &sizes(evaluation, title, of, terminal));
    }
    if !evaluation.differences.is_empty() {
        let header = [
            "pair",
            "AP50 %",
            "95 %",
            "AP50-95 %",
            "95 %",
            "best F1 %",
            "95 %",
            "recall %",
            "95 %",
        ];
        let rows: Vec<Vec<String>> = evaluation
            .differences
            .iter()
            .map(|d| {
                let mut row = vec![format!("{} - {}", d.second, d.first)];
                for e in [&d.ap50, &d.ap50_95, &d.f1, &d.recall] {
                    row.push(format!("{:+.1}", 100.0 * e.value));
                    row.push(interval(e));
                }
                row
            })
            .collect();
        let pairs = table(
            "Differences, paired on the same images",
            &header,
            &rows,
            1,
            terminal,
        );
        text += &("\n".to_owned() + &pairs);
    }
    text
}

fn of_coco(result: &DetectionResult) -> &[SizeRecall] {
    &result.by_size
}

fn of_fine(result: &DetectionResult) -> &[SizeRecall] {
    &result.by_fine_size
}

fn result(of: &DetectionResult) -> Vec<String> {
    let runtime = of
        .detector
        .as_ref()
        .and_then(|report| report.runtime.as_ref());
    let curve = of.curve.as_ref();
    let best = curve.and_then(|curve| curve.best_f1);
    vec![
        of.name.clone(),
        match (&of.detector, runtime) {
            (None, _) => "file".to_owned(),
            (Some(_), Some(runtime)) => format!("{} {}", runtime.name, runtime.version),
            (Some(_), None) => UNKNOWN.to_owned(),
        },
        known(of.ap50, |e| percent(e.value)),
        known(of.ap50.as_ref(), interval),
        known(of.ap50_95, |e| percent(e.value)),
        known(of.ap50_95.as_ref(), interval),
        known(curve, |c| percent(c.ap50_101)),
        known(curve, |c| percent(c.ap50_95_101)),
        known(of.f1, |e| percent(e.value)),
        known(best, |b| format!("{:.3}", b.score)),
        known(of.recall, |e| percent(e.value)),
        known(of.precision, |e| percent(e.value)),
        format!("{:.2}", of.at_threshold.false_positives_per_image),
        known(of.at_threshold.mean_iou, |iou| format!("{iou:.3}")),
    ]
}

/// Recall by size: a row for each detector, a column for each size.
fn sizes(
    evaluation: &DetectionEvaluation,
    title: &str,
    of: fn(&DetectionResult) -> &[SizeRecall],
    terminal: Terminal,
) -> String {
    let Some(first) = evaluation.results.first() else {
        return String::new();
    };
    let labels = |s: &SizeRecall| format!("{} ({})", s.size.name, s.at_any_score.of);
    let header: Vec<String> = std::iter::once("detector".to_owned())
        .chain(of(first).iter().map(labels))
        .collect();
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let recall = |share: &Proportion| match share.of {
        0 => UNKNOWN.to_owned(),
        _ => percent(share.share),
    };
    let rows: Vec<Vec<String>> = evaluation
        .results
        .iter()
        .map(|result| {
            let cells = of(result).iter();
            let cells =
                cells.map(|s| format!("{} / {}", recall(&s.at_threshold), recall(&s.at_any_score)));
            std::iter::once(result.name.clone()).chain(cells).collect()
        })
        .collect();
    let title = format!(
        "Recall % by {title} (labels), at score {} / at any score",
        evaluation.threshold
    );
    table(&title, &header, &rows, 1, terminal)
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

fn interval(e: &Estimate) -> String {
    format!("{:.1}..{:.1}", 100.0 * e.low, 100.0 * e.high)
}
