use super::record::DetectionsRecord;
use crate::summary::plural;
use crate::terminal::{FAINT, HEADING, Terminal, one_line};
use pomona_detect::DetectorReport;

/// What detected, in one line.
fn detector(report: &DetectorReport) -> String {
    let family = report.family.as_ref().map(|family| format!(" ({family})"));
    let class = report
        .class_name
        .as_ref()
        .map(|class| format!(", class {class}"));
    let runtime = report.runtime.as_ref().map(|runtime| {
        let library = runtime
            .library
            .as_ref()
            .map(|library| format!(" ({library})"));
        let library = library.unwrap_or_default();
        format!(", run by {} {}{library}", runtime.name, runtime.version)
    });
    let parts = [Some(report.name.clone()), family, class, runtime];
    one_line(&parts.into_iter().flatten().collect::<String>())
}

/// The record as a person reads it: what detected, and a line for each image.
pub(super) fn table(record: &DetectionsRecord, terminal: Terminal) -> String {
    let what = detector(&record.detector);
    let header = [
        "image",
        "size",
        "boxes",
        "best",
        "lowest",
        "read ms",
        "detect ms",
    ];
    let rows: Vec<[String; 7]> = record
        .images
        .iter()
        .map(|image| {
            let score = |d: Option<&super::record::DetectionRecord>| {
                d.map_or_else(|| "-".to_owned(), |d| format!("{:.2}", d.score))
            };
            [
                one_line(&image.name),
                format!("{}x{}", image.width, image.height),
                image.detections.len().to_string(),
                score(image.detections.first()),
                score(image.detections.last()),
                format!("{:.1}", image.timing_ms.read),
                format!("{:.1}", image.timing_ms.detect),
            ]
        })
        .collect();
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.chain([header[column].len()]).max().unwrap_or(0)
    };
    let widths: [usize; 7] = std::array::from_fn(width);
    let line = |cells: [&str; 7]| {
        let cells = cells.iter().zip(widths).enumerate();
        let cells = cells.map(|(i, (cell, width))| match i {
            0 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        });
        cells.collect::<Vec<_>>().join("  ") + "\n"
    };
    let mut text = terminal.paint(HEADING, &what) + "\n";
    for note in &record.detector.notes {
        text += &(one_line(note) + "\n");
    }
    text += &terminal.paint(FAINT, &line(header));
    for row in &rows {
        text += &line(row.each_ref().map(String::as_str));
    }
    let boxes: usize = record
        .images
        .iter()
        .map(|image| image.detections.len())
        .sum();
    text + &format!(
        "{} in {}\n",
        plural(boxes, "box").replace("boxs", "boxes"),
        plural(record.images.len(), "image")
    )
}
