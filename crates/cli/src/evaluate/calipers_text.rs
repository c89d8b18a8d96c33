use super::text_table::{known, mm, table, with_interval};
use crate::terminal::{Terminal, one_line};
use pomona_evaluate::{Alignment, CaliperReport};

/// Radii against calipers as tables of text.
pub(super) fn tables(report: &CaliperReport, terminal: Terminal) -> String {
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
