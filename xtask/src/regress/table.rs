use xtask_gate::{Finding, Verdict};

/// The fields that moved, or all of them, as lines of text.
pub(super) fn of(findings: &[Finding], all: bool) -> String {
    let shown: Vec<&Finding> = findings
        .iter()
        .filter(|finding| all || finding.verdict != Verdict::Same)
        .collect();
    let header = [
        "run",
        "field",
        "golden",
        "now",
        "moved",
        "tolerance",
        "limits",
        "verdict",
    ];
    let mut rows = vec![header.map(str::to_owned)];
    rows.extend(shown.iter().map(|finding| row(finding)));
    let mut text = if shown.is_empty() {
        String::from("nothing moved\n")
    } else {
        aligned(&rows)
    };
    let quiet = findings.len() - shown.len();
    if quiet > 0 {
        let line = format!("{quiet} fields stayed within their tolerance\n");
        text += &line;
    }
    text
}

fn row(finding: &Finding) -> [String; 8] {
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.3}"));
    let moved = finding
        .golden
        .zip(finding.now)
        .map(|(golden, now)| now - golden);
    let limits = finding.limits;
    let range = match (limits.floor, limits.ceiling) {
        (None, None) => "-".to_owned(),
        (Some(floor), None) => format!("≥ {floor}"),
        (None, Some(ceiling)) => format!("≤ {ceiling}"),
        (Some(floor), Some(ceiling)) => format!("{floor} to {ceiling}"),
    };
    [
        finding.run.clone(),
        finding.field.clone(),
        number(finding.golden),
        number(finding.now),
        moved.map_or_else(|| "-".to_owned(), |m| format!("{m:+.3}")),
        number(limits.tolerance),
        range,
        finding.verdict.words().to_owned(),
    ]
}

/// Columns in line: the first two to the left, numbers to the right, the verdict to the left.
pub(super) fn aligned<const N: usize>(rows: &[[String; N]]) -> String {
    let width = |column: usize| {
        rows.iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: [usize; N] = std::array::from_fn(width);
    let is_word = |column: usize| {
        let cells = rows.iter().skip(1).map(|row| row[column].as_str());
        cells
            .clone()
            .any(|cell| cell.starts_with(|c: char| c.is_alphabetic()))
    };
    let words: [bool; N] = std::array::from_fn(is_word);
    let mut text = String::new();
    for row in rows {
        let cells: Vec<String> = (0..N)
            .map(|i| {
                let gap = " ".repeat(widths[i] - row[i].chars().count());
                if words[i] {
                    format!("{}{gap}", row[i])
                } else {
                    format!("{gap}{}", row[i])
                }
            })
            .collect();
        text += cells.join("  ").trim_end();
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use xtask_gate::FieldLimits;

    fn finding(verdict: Verdict) -> Finding {
        Finding {
            run: "lab15.paper".into(),
            field: "angle_mean_deg".into(),
            golden: Some(5.0),
            now: Some(5.6),
            limits: FieldLimits {
                floor: None,
                ceiling: Some(6.0),
                tolerance: Some(0.2),
            },
            verdict,
        }
    }

    #[test]
    fn what_moved_is_shown_with_what_was_allowed() {
        let text = of(&[finding(Verdict::Worse), finding(Verdict::Same)], false);
        for part in [
            "5.000",
            "5.600",
            "+0.600",
            "0.200",
            "≤ 6",
            "WORSE",
            "1 fields stayed",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(of(&[finding(Verdict::Same)], false).starts_with("nothing moved"));
    }
}
