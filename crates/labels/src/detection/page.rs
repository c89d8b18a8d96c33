use super::result::{DetectionEvaluation, DetectionResult, SizeRecall};
use crate::cells::{COLORS, difference, estimate};
use crate::error::LabelsError;
use pomona_report::html::{escape, figures, heading, page, paragraph, table};
use pomona_report::number::{UNKNOWN, or_unknown, percent, with_interval};
use pomona_report::plot::{Axis, GRAY, Marks, PlotError, Series, plot};
use pomona_statistics::Proportion;

/// A page with the tables and curves of a detection evaluation.
///
/// `sheets` are the files of pictures of each result's worst images, relative to the page, the only thing that is not
/// within it. An empty name is left out.
///
/// # Errors
///
/// [`LabelsError::Plot`] where a plot cannot be drawn.
pub fn detection_page(
    evaluation: &DetectionEvaluation,
    sheets: &[String],
) -> Result<String, LabelsError> {
    let data = &evaluation.dataset;
    let mut body = paragraph(&format!(
        "pomona {}. {}: {} images ({} of them background), {} labels, {} more that are ignored. A true \
         positive has an intersection over union of at least 0.5 unless said. Intervals are 95 %: bootstrap over \
         images ({} draws, seed {}), Wilson for shares by size.",
        evaluation.version,
        data.name,
        data.images,
        data.background_images,
        data.labels,
        data.ignored_labels,
        evaluation.resamples,
        evaluation.seed
    ));
    body += &overview(evaluation);
    body += &figures(2, &plots(evaluation)?);
    if !evaluation.differences.is_empty() {
        body += "<h2>Differences, paired on the same images</h2>\n";
        body += &differences(evaluation);
    }
    body += "<h2>Recall by size</h2>\n";
    body += &paragraph(
        "By the root of the label's area in pixels of the image. At any score: found by a detection of any score.",
    );
    for result in &evaluation.results {
        body += &heading(&result.name);
        body += &sizes(&result.by_size, evaluation.threshold);
        body += &sizes(&result.by_fine_size, evaluation.threshold);
    }
    body += "<h2>The worst images</h2>\n";
    for (number, result) in evaluation.results.iter().enumerate() {
        body += &worst(result, sheets.get(number).map_or("", String::as_str));
    }
    Ok(page("Detection", &body))
}

fn overview(evaluation: &DetectionEvaluation) -> String {
    let at = evaluation.threshold;
    let (recall, precision, false_positives) = (
        format!("recall % at {at}"),
        format!("precision % at {at}"),
        format!("false positives per image at {at}"),
    );
    let rows: Vec<Vec<String>> = evaluation
        .results
        .iter()
        .map(|result| {
            let curve = result.curve.as_ref();
            let best = curve.and_then(|curve| curve.best_f1);
            vec![
                result.name.clone(),
                runtime(result),
                estimate(result.ap50),
                estimate(result.ap50_95),
                or_unknown(curve, |c| percent(c.ap50_101)),
                or_unknown(curve, |c| percent(c.ap50_95_101)),
                estimate(result.f1),
                or_unknown(best, |b| format!("{:.3}", b.score)),
                estimate(result.recall),
                estimate(result.precision),
                format!("{:.2}", result.at_threshold.false_positives_per_image),
                or_unknown(result.at_threshold.mean_iou, |iou| format!("{iou:.3}")),
            ]
        })
        .collect();
    let text = table(
        &[
            "detector",
            "runtime",
            "AP50 %, all points",
            "AP50-95 %, all points",
            "AP50 %, 101 points",
            "AP50-95 %, 101 points",
            "best F1 %",
            "at score",
            &recall,
            &precision,
            &false_positives,
            "mean IoU of true positives",
        ],
        &rows,
    );
    text + &paragraph(
        "All points: the area under the whole curve (PASCAL VOC from 2010 on), the main figure. 101 points: COCO's \
         rule. False positives: detections that match no label; where labels are missing, some of them are apples.",
    )
}

/// The runtime of the model.
fn runtime(result: &DetectionResult) -> String {
    let report = result.detector.as_ref();
    let runtime = report.and_then(|report| report.runtime.as_ref());
    match (report, runtime) {
        (None, _) => "boxes of a file".to_owned(),
        (Some(_), Some(runtime)) => format!("{} {}", runtime.name, runtime.version),
        (Some(_), None) => UNKNOWN.to_owned(),
    }
}

fn plots(evaluation: &DetectionEvaluation) -> Result<Vec<(String, String)>, PlotError> {
    let share = |label| Axis::new(label, 0.0..1.0);
    let mut curves = Vec::new();
    let mut by_score = Vec::new();
    let mut keys = Vec::new();
    for (result, (color, color_name)) in evaluation.results.iter().zip(COLORS.iter().cycle()) {
        let Some(curve) = &result.curve else {
            continue;
        };
        keys.push(format!("{}: {color_name}", result.name));
        let line = curve.points.iter().map(|p| (p.recall, p.precision));
        curves.push(Series {
            color: *color,
            marks: Marks::Line(line.collect()),
        });
        if let Some(best) = curve.best_f1 {
            curves.push(Series {
                color: *color,
                marks: Marks::Rings(vec![(best.recall, best.precision)]),
            });
        }
        let recall = curve.points.iter().map(|p| (p.score, p.recall));
        by_score.push(Series {
            color: *color,
            marks: Marks::Line(recall.collect()),
        });
        let precision = curve.points.iter().map(|p| [(p.score, p.precision); 1]);
        by_score.push(Series {
            color: *color,
            marks: Marks::Dots(precision.flatten().collect()),
        });
    }
    by_score.push(Series {
        color: GRAY,
        marks: Marks::Segments(vec![[
            (evaluation.threshold, 0.0),
            (evaluation.threshold, 1.0),
        ]]),
    });
    let keys = keys.join(", ");
    let size = (560, 420);
    Ok(vec![
        (
            plot(size, &share("recall"), &share("precision"), &curves)?,
            format!(
                "Precision over recall at an intersection over union of 0.5; rings where F1 is best. {keys}."
            ),
        ),
        (
            plot(
                size,
                &share("lowest score that counts"),
                &share("recall (line), precision (dots)"),
                &by_score,
            )?,
            format!(
                "Recall and precision over the threshold of the score; the grey line is the one used. {keys}."
            ),
        ),
    ])
}

fn differences(evaluation: &DetectionEvaluation) -> String {
    let rows: Vec<Vec<String>> = evaluation
        .differences
        .iter()
        .map(|d| {
            let pair = format!("{} − {}", d.second, d.first);
            let figures = [&d.ap50, &d.ap50_95, &d.f1, &d.recall, &d.precision];
            std::iter::once(pair)
                .chain(figures.map(difference))
                .collect()
        })
        .collect();
    table(
        &[
            "pair",
            "AP50 %",
            "AP50-95 %",
            "best F1 %",
            "recall %",
            "precision %",
        ],
        &rows,
    )
}

fn sizes(sizes: &[SizeRecall], threshold: f64) -> String {
    let rows: Vec<Vec<String>> = sizes
        .iter()
        .map(|s| {
            let shown = |share: &Proportion| {
                if share.of == 0 {
                    UNKNOWN.to_owned()
                } else {
                    with_interval(share)
                }
            };
            vec![
                s.size.name.to_owned(),
                s.at_any_score.of.to_string(),
                shown(&s.at_threshold),
                shown(&s.at_any_score),
            ]
        })
        .collect();
    let at = format!("recall % at {threshold}");
    table(&["size", "labels", &at, "recall % at any score"], &rows)
}

fn worst(result: &DetectionResult, sheet: &str) -> String {
    let mut text = heading(&result.name);
    if result.worst.is_empty() {
        return text + &paragraph("Nothing is missed, and there is no false positive.");
    }
    if !sheet.is_empty() {
        let name = escape(sheet);
        let figure = format!(
            "<figure><img src=\"{name}\" alt=\"pictures of the images below\" style=\"width: 100%\">\
             <figcaption>Green found, yellow missed, red false positive.</figcaption></figure>\n"
        );
        text += &figure;
    }
    let rows: Vec<Vec<String>> = result
        .worst
        .iter()
        .map(|image| {
            let counts = [image.found, image.missed, image.false_positives];
            std::iter::once(image.image.clone())
                .chain(counts.map(|count| count.to_string()))
                .collect()
        })
        .collect();
    text + &table(&["image", "found", "missed", "false positives"], &rows)
}
