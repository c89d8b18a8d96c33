use crate::real::{RealAgreement, RealFigures, RealReport, RealResult, UnseenFigures};
use pomona_report::html::{escape, heading, page, paragraph, table};
use pomona_report::number::{degrees, or_unknown, percent, with_interval};
use pomona_statistics::Proportion;

/// What the pictures show.
const CAPTION: &str = "Apples whose wood is seen: wrong answers first, the most confident first. Yellow: wood as drawn, \
    and the points of it nearest to the apple; pale blue: other strokes. Sphere and line to the foot: green right, pink \
    elsewhere, orange refused.";

/// A page of directions on real frames. `pictures` are the files of each result's pictures, relative to the page, the only
/// thing that is not in it; none where there are none.
pub fn real_page(report: &RealReport, pictures: &[Vec<String>]) -> String {
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
    body += &against_wood(&report.results);
    body += &against_themselves(&report.results);
    for (number, result) in report.results.iter().enumerate() {
        let title = format!(
            "<h2>Method {}, apple by apple</h2>\n",
            escape(&result.method)
        );
        body += &title;
        let own = pictures.get(number).into_iter().flatten();
        body += &own.map(|name| figure(name)).collect::<String>();
        body += &apples(result);
    }
    page("Directions on real frames", &body)
}

fn figure(file: &str) -> String {
    format!(
        "<figure><img src=\"{}\" alt=\"apples whose wood is seen\" style=\"width: 100%\">\
         <figcaption>{CAPTION}</figcaption></figure>\n",
        escape(file)
    )
}

/// A heading, a paragraph and a table; nothing without rows.
fn section(title: &str, text: &str, header: &[&str], rows: &[Vec<String>]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let text = if text.is_empty() {
        String::new()
    } else {
        paragraph(text)
    };
    heading(title) + &text + &table(header, rows)
}

fn against_wood(results: &[RealResult]) -> String {
    let seen: Vec<Vec<String>> = results.iter().flat_map(seen_rows).collect();
    let unseen: Vec<Vec<String>> = results.iter().flat_map(unseen_rows).collect();
    let reliability: Vec<Vec<String>> = results.iter().flat_map(reliability_rows).collect();
    section(
        "Apples whose wood is seen",
        "",
        &[
            "method",
            "frame",
            "apples",
            "answered %",
            "right, % of answers",
            "foot on the wood, % of answers",
            "right, % of apples",
            "elsewhere",
            "refused",
        ],
        &seen,
    ) + &section(
        "Apples whose wood is not seen for certain",
        "",
        &[
            "method",
            "wood",
            "apples",
            "refused %",
            "answered %",
            "confidence ≥ 0.5, %",
        ],
        &unseen,
    ) + &section(
        "Confidence of the answers to apples whose wood is seen",
        "",
        &["method", "confidence", "answers", "right", "right %"],
        &reliability,
    )
}

fn against_themselves(results: &[RealResult]) -> String {
    let between: Vec<Vec<String>> = results.iter().filter_map(between_rows).collect();
    let perturbed: Vec<Vec<String>> = results.iter().flat_map(perturbed_rows).collect();
    section(
        "Directions of the same apples in two frames",
        "Boxes of one name are one apple; the frames are aligned by the centres of the method's own spheres.",
        &[
            "method",
            "pairs",
            "answered in both %",
            "within 20°, % of those",
            "beyond 50°, % of those",
        ],
        &between,
    ) + &section(
        "Directions from perturbed copies of a frame",
        "Boxes moved and scaled by up to 5 %, noise added to depth at the level that the frame has, colour as it is, \
         15 % darker or 15 % brighter; beside the answers from the frame. Answers to one apple's copies depend on each \
         other, so intervals are far too narrow.",
        &[
            "method",
            "frame",
            "boxes of copies",
            "answered in one only %",
            "answered in both %",
            "within 20°, % of those",
            "beyond 50°, % of those",
        ],
        &perturbed,
    )
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
            with_interval(&seen.on_wood),
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

fn agreement(of: &RealAgreement) -> [String; 3] {
    [&of.answered_in_both, &of.within_20_deg, &of.beyond_50_deg].map(with_interval)
}

fn between_rows(result: &RealResult) -> Option<Vec<String>> {
    let own = result.between_frames.as_ref()?;
    let mut row = vec![result.method.clone(), own.answered_in_both.of.to_string()];
    row.extend(agreement(own));
    Some(row)
}

fn perturbed_rows(result: &RealResult) -> Vec<Vec<String>> {
    let row = |frame: &str, figures: &RealFigures| {
        let own = figures.perturbed.as_ref()?;
        let mut row = vec![
            result.method.clone(),
            frame.to_owned(),
            own.flipped.of.to_string(),
            with_interval(&own.flipped),
        ];
        row.extend(agreement(&own.directions));
        Some(row)
    };
    let frames = result.frames.iter().map(|f| row(&f.frame, &f.figures));
    [row("all", &result.all)]
        .into_iter()
        .chain(frames)
        .flatten()
        .collect()
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
    table(
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
