//! A comparison as a person reads it.

use super::{clouds::Mode, comparison::Comparison};
use std::fmt::Write as _;

/// Ours stands first; ratios and differences are taken cloud by cloud.
pub(super) fn of(comparison: &Comparison) -> String {
    let Comparison {
        suite,
        primitive,
        mode,
        points,
        rows,
    } = comparison;
    let stop = match mode {
        Mode::Full => format!("exactly {} hypotheses", primitive.hypotheses()),
        Mode::Adaptive => {
            format!(
                "each engine's own stopping at p = 0.99, at most {} hypotheses",
                primitive.hypotheses()
            )
        }
    };
    let mut text = format!("{suite}, {}, n = {points:.0}, {stop}\n", primitive.name());
    let heading = [
        "engine",
        "clouds",
        "scored",
        "time, ms",
        "× ours",
        "",
        primitive.error_name(),
        "less ours",
        "",
    ];
    let mut lines = vec![heading.map(String::from)];
    for row in rows {
        let ours = row.name == rows[0].name;
        let unless_ours = |text: String| if ours { String::new() } else { text };
        let [low, high] = row.ratio_interval;
        let [less, more] = row.excess_interval;
        lines.push([
            row.name.into(),
            row.clouds.to_string(),
            row.hypotheses
                .map_or_else(|| "unknown".into(), |n| format!("{n:.0}")),
            format!("{:.3}", row.milliseconds),
            unless_ours(format!("{:.1}", row.ratio)),
            unless_ours(format!("[{low:.1}, {high:.1}]")),
            format!("{:.2}", row.error),
            unless_ours(format!("{:+.2}", row.excess)),
            unless_ours(format!("[{less:+.2}, {more:+.2}]")),
        ]);
    }
    let width = |column: usize| {
        lines
            .iter()
            .map(|line| line[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: [usize; 9] = std::array::from_fn(width);
    for line in &lines {
        let mut padded = format!("  {:w$}", line[0], w = widths[0]);
        for (cell, w) in line.iter().zip(widths).skip(1) {
            // Writing to a string does not fail.
            let _ = write!(padded, "  {cell:>w$}");
        }
        text += padded.trim_end();
        text.push('\n');
    }
    for row in rows {
        if !row.remark.is_empty() {
            let _ = writeln!(text, "  {}: {}", row.name, row.remark);
        }
        if row.without_model + row.crashes > 0 {
            let _ = writeln!(
                text,
                "  {}: no model in {} tries, died in {}; these are in no figure above",
                row.name, row.without_model, row.crashes
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::{clouds::Primitive, comparison::Row};
    use super::*;

    #[test]
    fn peers_stand_below_ours() {
        let row = |name, ratio| Row {
            name,
            remark: "",
            clouds: 15,
            milliseconds: 0.5 * ratio,
            ratio,
            ratio_interval: [ratio - 1.0, ratio + 1.0],
            hypotheses: Some(1000.0),
            error: 0.4,
            excess: 0.0,
            excess_interval: [-0.1, 0.1],
            without_model: 0,
            crashes: 0,
        };
        let comparison = Comparison {
            suite: "lab15".into(),
            primitive: Primitive::Sphere,
            mode: Mode::Full,
            points: 4800.0,
            rows: vec![
                row("pomona", 1.0),
                Row {
                    crashes: 2,
                    ..row("another", 12.0)
                },
            ],
        };
        let text = of(&comparison);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "lab15, sphere, n = 4800, exactly 1000 hypotheses");
        assert!(lines[3].contains("12.0  [11.0, 13.0]"), "{text}");
        assert!(lines[4].contains("died in 2"), "{text}");
    }
}
