//! `cargo xtask tidy`: the rules that no compiler knows.

mod dependencies;
mod exceptions;
mod front_pages;
mod layers;
mod lengths;
mod names;
mod standalone;
mod words;

use crate::{
    source::{self, Source},
    workspace::{self, Workspace},
};
use anyhow::{Result, bail};
use std::{fmt, path::Path};

/// A place where a rule is broken.
struct Finding {
    /// `file` or `file:line`, relative to the workspace's root.
    place: String,
    /// What is wrong there.
    fault: String,
    /// What to do about it.
    remedy: String,
}

impl Finding {
    fn new(place: impl Into<String>, fault: impl Into<String>, remedy: impl Into<String>) -> Self {
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

/// Prints what is wrong, if anything.
pub(crate) fn run() -> Result<()> {
    let findings = findings()?;
    for finding in &findings {
        eprintln!("{finding}");
    }
    match findings.len() {
        0 => println!("tidy: nothing to report"),
        1 => bail!("tidy: 1 finding"),
        n => bail!("tidy: {n} findings"),
    }
    Ok(())
}

fn findings() -> Result<Vec<Finding>> {
    let workspace = Workspace::read()?;
    let sources = source::read_all(workspace::root())?;
    let mut findings = layers::check(&workspace);
    findings.extend(dependencies::check(&workspace, &sources)?);
    findings.extend(front_pages::check(&workspace, &sources));
    findings.extend(lengths::check(&sources));
    findings.extend(names::check(&sources));
    findings.extend(standalone::check(&workspace)?);
    findings.extend(words::check(&sources));
    Ok(findings)
}

/// `file:line`
fn at(path: &Path, line: usize) -> String {
    format!("{}:{line}", path.display())
}

/// The line of a manifest that begins with this key.
fn key_at(path: &Path, text: &str, key: &str) -> String {
    let begins = |line: &str| {
        let rest = line.trim_start().strip_prefix(key);
        rest.is_some_and(|rest| rest.starts_with(['.', ' ', '=']))
    };
    let line = text.lines().position(begins);
    line.map_or_else(|| path.display().to_string(), |line| at(path, line + 1))
}

fn source_at<'a>(sources: &'a [Source], path: &Path) -> Option<&'a Source> {
    sources.iter().find(|source| source.path == path)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_workspace_is_tidy() {
        let findings = super::findings().unwrap();
        let lines: Vec<String> = findings.iter().map(ToString::to_string).collect();
        assert!(lines.is_empty(), "\n{}\n", lines.join("\n"));
    }
}
