use crate::real::{RealFigures, RealReport, RealResult, UnseenFigures};
use pomona_report::html::{escape, heading, page, paragraph, table};
use pomona_report::number::{degrees, or_unknown, percent, with_interval};
use pomona_statistics::Proportion;

/// A self-contained page of directions on real frames.
pub fn real_page(report: &RealReport) -> String {
    let seen = match report.apple_radii {
        Some(radii) => format!(
            "An apple's wood counts as seen where wood is drawn within {radii} radii of the middle of its box."
        ),
        None => "Which apples' wood is seen, a person said.".to_owned(),
    };
    let wood = report.wood.as_ref().map_or_else(
        || "Methods were told nothing about wood in the colour image.".to_owned(),
        |name| format!("Methods were given the probability of wood of {name}."),
    );
    let mut body = paragraph(&format!(
        "Directions on real frames against strokes of wood drawn by eye, seed {}. {seen} {wood} Intervals are 95 % \
         (Wilson); apples of one frame are not independent, so they are too narrow.",
        report.seed
    ));
    let rows: Vec<Vec<String>> = report.results.iter().flat_map(seen_rows).collect();
    body += &heading("Apples whose wood is seen");
    body += &table(
        &[
            "method",
            "frame",
            "apples",
            "answered %",
            "right, % of answers",
            "right, % of apples",
            "elsewhere",
            "refused",
        ],
        &rows,
    );
    let rows: Vec<Vec<String>> = report.results.iter().flat_map(unseen_rows).collect();
    if !rows.is_empty() {
        body += &heading("Apples whose wood is not seen for certain");
        body += &table(
            &[
                "method",
                "wood",
                "apples",
                "refused %",
                "answered %",
                "confidence ≥ 0.5, %",
            ],
            &rows,
        );
    }
    let rows: Vec<Vec<String>> = report.results.iter().flat_map(reliability_rows).collect();
    if !rows.is_empty() {
        body += &heading("Confidence of the answers to apples whose wood is seen");
        body += &table(
            &["method", "confidence", "answers", "right", "right %"],
            &rows,
        );
    }
    for result in &report.results {
        body += &apples(result);
    }
    page("Directions on real frames", &body)
}

fn seen_rows(result: &RealResult) -> Vec<Vec<String>> {
    let row = |frame: &str, figures: &RealFigures| {
        let seen = &figures.seen;
        let refused = seen
            .refused
            .iter()
            .map(|(status, n)| format!("{n} {status}"));
        vec![
            result.method.clone(),
            frame.to_owned(),
            seen.answered.of.to_string(),
            with_interval(&seen.answered),
            with_interval(&seen.right),
            with_interval(&seen.hits),
            seen.elsewhere.to_string(),
            refused.collect::<Vec<_>>().join(", "),
        ]
    };
    let mut rows = vec![row("all", &result.all)];
    rows.extend(result.frames.iter().map(|f| row(&f.frame, &f.figures)));
    rows
}

fn unseen_rows(result: &RealResult) -> Vec<Vec<String>> {
    let row = |wood: &str, of: &UnseenFigures| {
        (of.refused.of > 0).then(|| {
            vec![
                result.method.clone(),
                wood.to_owned(),
                of.refused.of.to_string(),
                with_interval(&of.refused),
                with_interval(&of.answered),
                with_interval(&of.confident),
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

fn reliability_rows(result: &RealResult) -> Vec<Vec<String>> {
    let Some(own) = &result.all.reliability else {
        return Vec::new();
    };
    let row = |range: String, right: &Proportion| {
        vec![
            result.method.clone(),
            range,
            right.of.to_string(),
            right.count.to_string(),
            or_unknown((right.of > 0).then_some(right), with_interval),
        ]
    };
    let mut rows: Vec<Vec<String>> = own
        .bins
        .iter()
        .map(|bin| row(format!("from {} to {}", bin.from, bin.to), &bin.right))
        .collect();
    rows.push(vec![
        result.method.clone(),
        format!(
            "all: mean {:.2}, Brier's score {:.3}",
            own.mean_confidence, own.brier
        ),
        result.all.seen.right.of.to_string(),
        result.all.seen.right.count.to_string(),
        percent(result.all.seen.right.share),
    ]);
    rows
}

fn apples(result: &RealResult) -> String {
    let rows: Vec<Vec<String>> = result
        .apples
        .iter()
        .map(|row| {
            vec![
                row.box_name.clone(),
                row.frame.clone(),
                row.wood.name().to_owned(),
                row.verdict.name().to_owned(),
                row.status.clone(),
                or_unknown(row.confidence, |c| format!("{c:.2}")),
                or_unknown(row.image_angle, degrees),
                or_unknown(row.wood_distance_radii, |d| format!("{d:.2}")),
                or_unknown(row.foot_from_wood_radii, |d| format!("{d:.2}")),
                or_unknown(row.distance, |d| format!("{d:.3}")),
            ]
        })
        .collect();
    format!(
        "<h2>Method {}, apple by apple</h2>\n",
        escape(&result.method)
    ) + &table(
        &[
            "box",
            "frame",
            "wood",
            "verdict",
            "status",
            "confidence",
            "angle in the image °",
            "wood from centre, radii",
            "foot from wood, radii",
            "distance m",
        ],
        &rows,
    )
}
