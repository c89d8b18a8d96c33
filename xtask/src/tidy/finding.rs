//! What a rule has to say, and where.

use crate::source::Source;
use std::{fmt, path::Path};

/// A place where a rule is broken.
pub(super) struct Finding {
    /// `file` or `file:line`, relative to the workspace's root.
    pub(super) place: String,
    /// What is wrong there.
    pub(super) fault: String,
    /// What to do about it.
    pub(super) remedy: String,
}

impl Finding {
    pub(super) fn new(
        place: impl Into<String>,
        fault: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            place: place.into(),
            fault: fault.into(),
            remedy: remedy.into(),
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}\n    {}", self.place, self.fault, self.remedy)
    }
}

/// `file:line`
pub(super) fn at(path: &Path, line: usize) -> String {
    format!("{}:{line}", path.display())
}

/// The line of a manifest that begins with this key.
pub(super) fn key_at(path: &Path, text: &str, key: &str) -> String {
    let begins = |line: &str| {
        let rest = line.trim_start().strip_prefix(key);
        rest.is_some_and(|rest| rest.starts_with(['.', ' ', '=']))
    };
    let line = text.lines().position(begins);
    line.map_or_else(|| path.display().to_string(), |line| at(path, line + 1))
}

pub(super) fn source_at<'a>(sources: &'a [Source], path: &Path) -> Option<&'a Source> {
    sources.iter().find(|source| source.path == path)
}
