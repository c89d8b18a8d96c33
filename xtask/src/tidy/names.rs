//! A file is named after what it holds.

use super::finding::Finding;
use crate::source::Source;

/// Names that say nothing.
const VAGUE: [&str; 8] = [
    "common",
    "helper",
    "helpers",
    "misc",
    "stuff",
    "util",
    "utilities",
    "utils",
];

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    sources
        .iter()
        .filter_map(|source| {
            let path = source.path.with_extension("");
            let vague = path
                .iter()
                .find(|part| VAGUE.iter().any(|name| part == name))?;
            Some(Finding::new(
                source.path.display().to_string(),
                format!("`{}` does not say what is in it", vague.display()),
                "name the file and its folders after the one concept that they hold",
            ))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vague_files_and_folders_are_found() {
        let source = |path: &str| Source {
            path: path.into(),
            text: String::new(),
        };
        assert_eq!(check(&[source("crates/x/src/utils.rs")]).len(), 1);
        assert_eq!(check(&[source("crates/x/tests/common/cloud.rs")]).len(), 1);
        assert_eq!(check(&[source("crates/x/src/uncommon.rs")]).len(), 0);
    }
}
