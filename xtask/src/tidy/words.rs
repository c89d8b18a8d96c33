//! Nothing unfinished is left in the sources.

use super::finding::{Finding, at};
use crate::source::{Source, has_word};

/// The words, each in two parts so that this file does not hold them.
const UNFINISHED: [(&str, &str); 7] = [
    ("todo", "!"),
    ("unimplemented", "!"),
    ("dbg", "!"),
    ("TO", "DO"),
    ("FIX", "ME"),
    ("XX", "X"),
    ("To be ", "written"),
];

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let words = UNFINISHED.map(|(a, b)| format!("{a}{b}"));
    let mut findings = Vec::new();
    for source in sources {
        for (number, line) in source.lines() {
            for word in words.iter().filter(|word| has_word(line, word)) {
                findings.push(Finding::new(
                    at(&source.path, number),
                    format!("`{word}`"),
                    "finish it, or take it out and open an issue",
                ));
            }
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unfinished_lines_are_found_by_number() {
        let text = format!("fn f() {{\n    {}{}()\n}}\n", "todo", "!");
        let findings = check(&[Source {
            path: "a.rs".into(),
            text,
        }]);
        assert_eq!(findings.len(), 1);
        assert_eq!(findings[0].place, "a.rs:2");
    }
}
