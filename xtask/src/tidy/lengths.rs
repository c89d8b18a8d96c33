//! No file is longer than a reader takes in at once.

use super::{
    exceptions::LONG_FILES,
    finding::{Finding, source_at},
};
use crate::source::Source;
use std::path::Path;

const MAX_LINES: usize = 500;

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    let mut findings = too_long(sources, LONG_FILES);
    for (path, _) in LONG_FILES {
        let long = source_at(sources, Path::new(path)).is_some_and(is_long);
        if !long {
            findings.push(Finding::new(
                *path,
                "is listed as a long file and is none",
                "remove it from LONG_FILES in xtask/src/tidy/exceptions.rs",
            ));
        }
    }
    findings
}

fn too_long(sources: &[Source], allowed: &[(&str, &str)]) -> Vec<Finding> {
    let long = sources.iter().filter(|source| is_long(source));
    long.filter(|source| {
        !allowed
            .iter()
            .any(|(path, _)| source.path == Path::new(path))
    })
    .map(|source| {
        Finding::new(
            source.path.display().to_string(),
            format!(
                "{} lines, more than {MAX_LINES}",
                source.text.lines().count()
            ),
            "split it by concept; if it is one, list it with the reason in \
                 xtask/src/tidy/exceptions.rs",
        )
    })
    .collect()
}

fn is_long(source: &Source) -> bool {
    source.text.lines().count() > MAX_LINES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_file_needs_a_reason() {
        let path = "crates/x/src/lib.rs";
        let long = [Source {
            path: path.into(),
            text: "\n".repeat(MAX_LINES + 1),
        }];
        assert_eq!(too_long(&long, &[]).len(), 1);
        assert_eq!(too_long(&long, &[(path, "a table")]).len(), 0);
    }
}
