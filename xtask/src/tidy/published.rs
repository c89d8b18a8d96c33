//! What goes to a registry says what it is, and brings its licences along.

use super::finding::{Finding, at};
use crate::workspace::{Package, Workspace};
use anyhow::{Context, Result};
use std::fs;

const LICENSES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];
/// A registry takes no more.
const MOST_KEYWORDS: usize = 5;

pub(super) fn check(workspace: &Workspace) -> Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for package in workspace.packages.iter().filter(|p| p.is_public()) {
        let manifest = workspace.relative(&package.manifest_path);
        findings.extend(gaps(package).into_iter().map(|(fault, remedy)| {
            Finding::new(
                at(manifest, 1),
                format!("`{}` {fault}", package.name),
                remedy,
            )
        }));
        for name in LICENSES {
            let original = fs::read(workspace.root.join(name))
                .with_context(|| format!("cannot read {name} at the root"))?;
            let path = package.folder().join(name);
            // A checkout without symbolic links holds the name of the file that is meant.
            let copy = fs::read(&path).unwrap_or_default();
            if copy != original && !copy.ends_with(name.as_bytes()) {
                findings.push(Finding::new(
                    workspace.relative(&path).display().to_string(),
                    "is not the licence at the root",
                    format!("`ln -s ../../{name}` there"),
                ));
            }
        }
    }
    Ok(findings)
}

/// What the manifest leaves out, and what to do.
fn gaps(package: &Package) -> Vec<(&'static str, &'static str)> {
    let mut gaps = Vec::new();
    if package.description.as_ref().is_none_or(String::is_empty) {
        gaps.push(("has no description", "say in one line what it is for"));
    }
    if package.keywords.is_empty() || package.keywords.len() > MOST_KEYWORDS {
        gaps.push((
            "has no keywords, or more than five",
            "name what people would search for",
        ));
    }
    if package.categories.is_empty() {
        gaps.push(("has no categories", "choose from crates.io/category_slugs"));
    }
    if package.readme.is_none() {
        gaps.push(("has no readme", "write `readme.workspace = true`"));
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_of_a_manifest_are_told() {
        let bare = r#"{"name": "x", "manifest_path": "/x/Cargo.toml", "dependencies": [], "targets": [],
            "features": {}, "description": "Apples"}"#;
        let package: Package = serde_json::from_str(bare).unwrap();
        let faults: Vec<&str> = gaps(&package).into_iter().map(|(fault, _)| fault).collect();
        assert_eq!(
            faults,
            [
                "has no keywords, or more than five",
                "has no categories",
                "has no readme"
            ]
        );
    }
}
