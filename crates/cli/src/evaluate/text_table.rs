//! Tables of text, and figures as their cells show them.

use crate::terminal::{FAINT, HEADING, Terminal, one_line};
use pomona_statistics::{Proportion, Summary};

/// Shown in place of an unknown value.
pub(super) const UNKNOWN: &str = "-";

pub(super) fn known<T>(value: Option<T>, form: impl Fn(T) -> String) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), form)
}

pub(super) fn degrees(radians: f64) -> String {
    format!("{:.2}", radians.to_degrees())
}

pub(super) fn mm(metres: f64) -> String {
    format!("{:.2}", metres * 1000.0)
}

pub(super) fn percent(share: &Proportion) -> String {
    format!("{:.1}", 100.0 * share.share)
}

pub(super) fn with_interval(summary: &Summary, form: fn(f64) -> String) -> String {
    format!(
        "{} ({})",
        form(summary.mean),
        summary.mean_interval.map(form).join(" to ")
    )
}

/// A title, a header and rows; the first `words` columns are words and stand to the left.
pub(super) fn table(
    title: &str,
    header: &[&str],
    rows: &[Vec<String>],
    words: usize,
    terminal: Terminal,
) -> String {
    let widths: Vec<usize> = header
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let cells = rows.iter().map(|row| row[i].chars().count());
            cells.chain([name.chars().count()]).max().unwrap_or(0)
        })
        .collect();
    let line = |cells: &mut dyn Iterator<Item = &str>| -> String {
        let cells = cells.zip(&widths).enumerate().map(|(i, (cell, &width))| {
            let cell = one_line(cell);
            if i < words {
                format!("{cell:<width$}")
            } else {
                format!("{cell:>width$}")
            }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let mut text = terminal.paint(HEADING, title) + "\n";
    text += &(terminal.paint(FAINT, &line(&mut header.iter().copied())) + "\n");
    for row in rows {
        text += &(line(&mut row.iter().map(String::as_str)) + "\n");
    }
    text
}
