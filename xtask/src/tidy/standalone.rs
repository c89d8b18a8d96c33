//! The engine's folder stands alone: its manifest inherits nothing, and says what the workspace says.

use super::{dependencies::Manifest, finding::Finding, layers::ENGINE};
use crate::workspace::Workspace;
use anyhow::Result;
use std::path::Path;
use toml::{Table, Value};

/// What the engine's folder has of its own under the same name.
const OWN: [&str; 1] = ["readme"];

/// Keys that belong to one crate and not to the table of versions.
const OF_THE_CRATE: [&str; 1] = ["optional"];

pub(super) fn check(workspace: &Workspace) -> Result<Vec<Finding>> {
    let Some(engine) = workspace.package(ENGINE) else {
        return Ok(Vec::new());
    };
    let root = Manifest::read(&workspace.root.join("Cargo.toml"))?;
    let manifest = Manifest::read(&engine.manifest_path)?;
    let findings = disagreements(
        workspace.relative(&engine.manifest_path),
        &manifest,
        &root.table,
    );
    Ok(findings)
}

fn disagreements(path: &Path, manifest: &Manifest, root: &Table) -> Vec<Finding> {
    let workspace = root.get("workspace");
    let of_workspace = |table: &str| workspace.and_then(|w| w.get(table)).cloned();
    let mut findings = Vec::new();
    let mut disagree = |key: &str, theirs: Option<&Value>| {
        let remedy = match theirs {
            Some(theirs) => {
                format!("write `{key} = {theirs}`, so that the folder builds without the workspace")
            }
            None => "add it to [workspace.dependencies] first".to_string(),
        };
        findings.push(Finding::new(
            manifest.at(path, key),
            format!("`{key}` is not that of the workspace"),
            remedy,
        ));
    };

    if let Some(Value::Table(package)) = of_workspace("package") {
        for (key, theirs) in &package {
            let ours = manifest.table.get("package").and_then(|p| p.get(key));
            if ours != Some(theirs) && !OWN.contains(&key.as_str()) {
                disagree(key, Some(theirs));
            }
        }
    }
    let lints = of_workspace("lints");
    if manifest.table.get("lints") != lints.as_ref() {
        disagree("lints", lints.as_ref());
    }
    let versions = of_workspace("dependencies");
    for (name, ours) in manifest.dependencies() {
        let theirs = versions.as_ref().and_then(|table| table.get(name));
        if theirs.map(requirement) != Some(requirement(ours)) {
            disagree(name, theirs);
        }
    }
    findings
}

/// What a dependency asks for, a bare version written out.
fn requirement(value: &Value) -> Table {
    match value {
        Value::Table(table) => {
            let mut table = table.clone();
            table.retain(|key, _| !OF_THE_CRATE.contains(&key));
            table
        }
        version => Table::from_iter([("version".to_string(), version.clone())]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOT: &str = r#"
        [workspace.package]
        edition = "2024"
        [workspace.lints.rust]
        missing_docs = "warn"
        [workspace.dependencies]
        rayon = "1.11"
        rand_core = { version = "0.10", default-features = false }
    "#;

    fn faults(manifest: &str) -> Vec<String> {
        let manifest = Manifest::parse(manifest.into()).unwrap();
        let root: Table = ROOT.parse().unwrap();
        disagreements(Path::new("Cargo.toml"), &manifest, &root)
            .into_iter()
            .map(|finding| finding.place + ": " + &finding.fault)
            .collect()
    }

    #[test]
    fn what_is_written_out_and_agrees_is_fine() {
        let fine = r#"
            [package]
            edition = "2024"
            [lints.rust]
            missing_docs = "warn"
            [dependencies]
            rayon = { version = "1.11", optional = true }
            rand_core = { version = "0.10", default-features = false }
        "#;
        assert!(faults(fine).is_empty());
    }

    #[test]
    fn what_is_inherited_missing_or_another_is_found() {
        let wrong = "[package]\nedition.workspace = true\n\
            [dependencies]\nrayon = \"1.10\"\nlibm = \"0.2\"\n";
        assert_eq!(
            faults(wrong),
            [
                "Cargo.toml:2: `edition` is not that of the workspace",
                "Cargo.toml: `lints` is not that of the workspace",
                "Cargo.toml:5: `libm` is not that of the workspace",
                "Cargo.toml:4: `rayon` is not that of the workspace",
            ]
        );
    }
}
