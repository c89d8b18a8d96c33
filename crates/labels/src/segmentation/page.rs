use super::result::{SegmentationEvaluation, SegmentationResult, TruthKind};
use crate::cells::{COLORS, difference, estimate};
use crate::error::LabelsError;
use pomona_report::html::{escape, figures, heading, page, paragraph, table};
use pomona_report::number::{percent, with_interval};
use pomona_report::plot::{Axis, GRAY, Marks, PlotError, Series, plot};

/// A page with the tables and curves of a segmentation evaluation.
///
/// `sheets` are the files of pictures of each result's worst images, relative to the page, the only thing that is not
/// within it. An empty name is left out.
///
/// # Errors
///
/// [`LabelsError::Plot`] where a plot cannot be drawn.
pub fn segmentation_page(
    evaluation: &SegmentationEvaluation,
    sheets: &[String],
) -> Result<String, LabelsError> {
    let strokes = &evaluation.strokes;
    let wood = match strokes.truth {
        TruthKind::Strokes => format!(
            "{} strokes of wood, {:.0} px long, and {:.0} px of posts and wires",
            strokes.wood, strokes.wood_length_px, strokes.post_length_px
        ),
        TruthKind::Masks => format!(
            "masks of wood, whose centre lines are {:.0} px long",
            strokes.wood_length_px
        ),
    };
    let mut body = paragraph(&format!(
        "pomona {}. {}: {} images of {} photographs, {wood}. Wood is found where a pixel within {} px of its centre line is marked, and a marked pixel is right \
         within {} px of wood. Intervals are 95 %: bootstrap over photographs ({} draws, seed {}).",
        evaluation.version,
        strokes.name,
        strokes.images,
        strokes.photographs,
        evaluation.tolerance_px,
        evaluation.tolerance_px,
        evaluation.resamples,
        evaluation.seed
    ));
    body += &overview(evaluation);
    if let Some(agreement) = &evaluation.agreement {
        body += "<h2>A second person's strokes</h2>\n";
        let rows = [
            ("all wood", &agreement.recall, &agreement.precision),
            (
                "at least 4 px wide",
                &agreement.recall_wide,
                &agreement.precision_wide,
            ),
        ];
        let rows: Vec<Vec<String>> = rows
            .iter()
            .map(|(what, recall, precision)| {
                vec![
                    (*what).to_owned(),
                    with_interval(recall),
                    with_interval(precision),
                ]
            })
            .collect();
        body += &table(&["centre lines", "recall %", "precision %"], &rows);
        body += &paragraph(&format!(
            "{} images were drawn by two people who did not see each other's strokes. Recall: of the length of the \
             strokes measured on, the share within {} px of one of the second person's; precision: the other way \
             round. This is centre line against centre line, which is stricter than the table above; to compare a \
             segmenter with a person, give that person's strokes as masks.",
            agreement.images, evaluation.tolerance_px
        ));
    }
    body += &figures(2, &plots(evaluation)?);
    if !evaluation.differences.is_empty() {
        body += "<h2>Differences, paired on the same photographs</h2>\n";
        body += &differences(evaluation);
    }
    body += "<h2>Recall by width</h2>\n";
    for result in &evaluation.results {
        body += &heading(&result.name);
        body += &widths(result);
    }
    body += "<h2>The worst images</h2>\n";
    for (number, result) in evaluation.results.iter().enumerate() {
        body += &worst(result, sheets.get(number).map_or("", String::as_str));
    }
    Ok(page("Segmentation of wood", &body))
}

fn overview(evaluation: &SegmentationEvaluation) -> String {
    let rows: Vec<Vec<String>> = evaluation
        .results
        .iter()
        .map(|result| {
            vec![
                result.name.clone(),
                estimate(result.recall_wide),
                estimate(result.recall_thin),
                estimate(result.precision),
                estimate(result.iou),
                estimate(result.posts),
                percent(result.calibration_error),
            ]
        })
        .collect();
    let text = table(
        &[
            "segmenter",
            "recall %, 4 px and wider",
            "recall %, 3 to 4 px",
            "precision %",
            "IoU %",
            "posts called wood %",
            "calibration error %",
        ],
        &rows,
    );
    text + &paragraph(&format!(
        "At a probability of at least {}. Precision counts pixels, so that a trunk weighs more than a twig; where \
         strokes are missing, some of what is wrong is wood.",
        evaluation.threshold
    ))
}

fn plots(evaluation: &SegmentationEvaluation) -> Result<Vec<(String, String)>, PlotError> {
    let share = |label| Axis::new(label, 0.0..1.0);
    let (mut curves, mut reliability, mut keys) = (Vec::new(), Vec::new(), Vec::new());
    for (result, (color, color_name)) in evaluation.results.iter().zip(COLORS.iter().cycle()) {
        keys.push(format!("{}: {color_name}", result.name));
        let line = result.curve.iter().map(|f| (f.recall_wide, f.precision));
        curves.push(Series {
            color: *color,
            marks: Marks::Line(line.collect()),
        });
        let at = result
            .curve
            .iter()
            .find(|f| f.threshold >= evaluation.threshold - 1e-9);
        curves.push(Series {
            color: *color,
            marks: Marks::Rings(
                at.map(|f| (f.recall_wide, f.precision))
                    .into_iter()
                    .collect(),
            ),
        });
        let bins = result.calibration.iter().filter(|bin| bin.pixels > 0);
        reliability.push(Series {
            color: *color,
            marks: Marks::Line(bins.map(|bin| (bin.probability, bin.share)).collect()),
        });
    }
    reliability.push(Series {
        color: GRAY,
        marks: Marks::Segments(vec![[(0.0, 0.0), (1.0, 1.0)]]),
    });
    let keys = keys.join(", ");
    let size = (560, 420);
    Ok(vec![
        (
            plot(
                size,
                &share("recall of wood at least 4 px wide"),
                &share("precision"),
                &curves,
            )?,
            format!("Precision over recall; rings at the threshold. {keys}."),
        ),
        (
            plot(
                size,
                &share("probability of wood"),
                &share("share that is wood"),
                &reliability,
            )?,
            format!(
                "Calibration, without the pixels along the edges of wood; the grey line is right. {keys}."
            ),
        ),
    ])
}

fn differences(evaluation: &SegmentationEvaluation) -> String {
    let row = |d: &super::result::SegmentationDifference| {
        let pair = format!("{} − {}", d.second, d.first);
        let figures = [&d.recall_wide, &d.precision, &d.iou];
        std::iter::once(pair)
            .chain(figures.map(difference))
            .collect()
    };
    let rows: Vec<Vec<String>> = evaluation.differences.iter().map(row).collect();
    table(
        &["pair", "recall %, 4 px and wider", "precision %", "IoU %"],
        &rows,
    )
}

fn widths(result: &SegmentationResult) -> String {
    let row = |w: &super::result::WidthRecall| {
        vec![
            w.width.name.to_owned(),
            format!("{:.0}", w.length_px),
            percent(w.recall),
        ]
    };
    let rows: Vec<Vec<String>> = result.by_width.iter().map(row).collect();
    table(&["width", "length px", "recall %"], &rows)
}

fn worst(result: &SegmentationResult, sheet: &str) -> String {
    let mut text = heading(&result.name);
    if result.worst.is_empty() {
        return text + &paragraph("Nothing is missed, and nothing is marked falsely.");
    }
    if !sheet.is_empty() {
        let name = escape(sheet);
        let figure = format!(
            "<figure><img src=\"{name}\" alt=\"pictures of the images below\" style=\"width: 100%\">\
             <figcaption>Green: marked and right; red: marked and wrong; yellow: wood that is missed; grey: \
             it does not count.</figcaption>\
             </figure>\n"
        );
        text += &figure;
    }
    let row = |image: &super::result::WorstSegmentation| {
        vec![
            image.image.clone(),
            format!("{:.0}", image.missed_px),
            image.false_pixels.to_string(),
        ]
    };
    let rows: Vec<Vec<String>> = result.worst.iter().map(row).collect();
    text + &table(&["image", "missed px", "false pixels"], &rows)
}
