//! Printed text as it is shown: parts of it, without times.

use anyhow::{Result, ensure};

/// Stands for what is left out.
const LEFT_OUT: &str = "…";
/// Header of a last column that no two runs print alike.
const TIMES: &str = "time ms";

/// The lines that are asked for, with `…` between the parts.
pub(super) fn chosen(text: &str, ranges: &[(usize, usize)]) -> Result<String> {
    if ranges.is_empty() {
        return Ok(text.to_owned());
    }
    let lines: Vec<&str> = text.lines().collect();
    let mut shown = String::new();
    let mut next = 1;
    for &(first, last) in ranges {
        ensure!(
            next <= first && first <= lines.len() && first <= last,
            "there are {} lines, not {first} and more, or the parts overlap",
            lines.len()
        );
        if first > next {
            shown.extend([LEFT_OUT, "\n"]);
        }
        let last = last.min(lines.len());
        for line in &lines[first - 1..last] {
            shown.extend([*line, "\n"]);
        }
        next = last + 1;
    }
    if next <= lines.len() {
        shown.extend([LEFT_OUT, "\n"]);
    }
    Ok(shown)
}

/// The numbers of a column of times replaced by `…`.
pub(super) fn without_times(text: &str) -> String {
    let mut in_table = false;
    let mut masked = String::new();
    for line in text.lines() {
        let number = line.rsplit(' ').next().unwrap_or_default();
        if in_table && number.parse::<f64>().is_ok() {
            let kept = &line[..line.len() - number.len()];
            let gap = " ".repeat(number.chars().count() - 1);
            masked.extend([kept, &gap, LEFT_OUT, "\n"]);
        } else {
            in_table = line.ends_with(TIMES) || in_table && line == LEFT_OUT;
            masked.extend([line, "\n"]);
        }
    }
    masked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_shown_and_gaps_marked() {
        let text = "a\nb\nc\nd\ne\n";
        assert_eq!(chosen(text, &[(1, 2), (4, 4)]).unwrap(), "a\nb\n…\nd\n…\n");
        assert_eq!(chosen(text, &[(2, usize::MAX)]).unwrap(), "…\nb\nc\nd\ne\n");
        assert_eq!(chosen(text, &[]).unwrap(), text);
        for wrong in [vec![(6, 7)], vec![(2, 3), (3, 4)], vec![(3, 2)]] {
            assert!(chosen(text, &wrong).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn times_are_masked_in_their_column_alone() {
        let text = "id  time ms\n 0     10.6\n 1      2.5\n…\n 3      0.0\n\n3 apples, 0.5\n 2\n";
        assert_eq!(
            without_times(text),
            "id  time ms\n 0        …\n 1        …\n…\n 3        …\n\n3 apples, 0.5\n 2\n"
        );
    }
}
