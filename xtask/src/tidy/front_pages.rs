//! Every crate opens with a front page; a library's has an example that runs,
//! and its root file holds nothing but the page, the modules and the re-exports.

use super::finding::{Finding, at, source_at};
use crate::{source::Source, workspace::Workspace};

/// What begins an item that is logic.
const LOGIC: [&str; 8] = [
    "fn ",
    "struct ",
    "enum ",
    "impl ",
    "impl<",
    "trait ",
    "const ",
    "macro_rules! ",
];

pub(super) fn check(workspace: &Workspace, sources: &[Source]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &workspace.packages {
        let (library, binary) = (package.root_file("lib"), package.root_file("bin"));
        let Some(path) = library.or(binary) else {
            continue;
        };
        let Some(source) = source_at(sources, workspace.relative(path)) else {
            continue;
        };
        findings.extend(no_page(source));
        if library.is_some() {
            findings.extend(no_example(source));
            findings.extend(logic(source));
        }
    }
    findings
}

fn no_page(source: &Source) -> Option<Finding> {
    let begins = source.text.starts_with("//! ");
    (!begins).then(|| {
        Finding::new(
            at(&source.path, 1),
            "no front page",
            "begin with `//!` and say in one sentence what the crate is for",
        )
    })
}

fn no_example(source: &Source) -> Option<Finding> {
    let mut inside = false;
    for (_, line) in source.lines() {
        let Some(fence) = line.strip_prefix("//! ```") else {
            continue;
        };
        let runs = fence
            .split(',')
            .all(|tag| matches!(tag, "" | "rust" | "no_run"));
        if !inside && runs {
            return None;
        }
        inside = !inside;
    }
    Some(Finding::new(
        at(&source.path, 1),
        "the front page has no example",
        "show the crate's main job in a Rust code block, which then runs as a doctest",
    ))
}

fn logic(source: &Source) -> Option<Finding> {
    let (number, _) = source.lines().find(|(_, line)| {
        let item = line
            .trim_start()
            .trim_start_matches("pub(crate) ")
            .trim_start_matches("pub ");
        LOGIC.iter().any(|start| item.starts_with(start))
    })?;
    Some(Finding::new(
        at(&source.path, number),
        "logic in the crate's root file",
        "move it to a module of its own and re-export it",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Source {
        Source {
            path: "crates/x/src/lib.rs".into(),
            text: text.into(),
        }
    }

    #[test]
    fn an_example_is_rust() {
        assert!(no_example(&source("//! Spheres.\n//! ```\n//! let x = 1;\n//! ```\n")).is_none());
        assert!(no_example(&source("//! Spheres.\n//! ```text\n//! a\n//! ```\n")).is_some());
        assert!(no_example(&source("//! Spheres.\n")).is_some());
    }

    #[test]
    fn a_page_comes_first() {
        assert!(no_page(&source("//! Spheres.\n")).is_none());
        assert!(no_page(&source("mod sphere;\n")).is_some());
    }

    #[test]
    fn logic_is_told_from_examples_and_exports() {
        let fine = "//! fn f() {}\nmod sphere;\npub use sphere::{Sphere, fit};\n";
        assert!(logic(&source(fine)).is_none());
        let found = logic(&source("//! Page.\n\npub struct Sphere;\n")).unwrap();
        assert_eq!(found.place, "crates/x/src/lib.rs:3");
    }
}
