//! Versions stand in one table, every dependency has a user,
//! and every package obeys the one table of lints.
//!
//! The engine inherits nothing; [`standalone`](super::standalone) holds it to the same tables.

use super::{
    exceptions::UNNAMED_DEPENDENCIES,
    finding::{Finding, key_at},
    layers::ENGINE,
};
use crate::{
    source::{Source, has_word},
    workspace::{Package, Workspace},
};
use anyhow::{Context, Result};
use std::{fs, path::Path};
use toml::{Table, Value};

const MANIFEST: &str = "Cargo.toml";

pub(super) fn check(workspace: &Workspace, sources: &[Source]) -> Result<Vec<Finding>> {
    let root = Manifest::read(&workspace.root.join(MANIFEST))?;
    let mut manifests = Vec::new();
    let mut findings = Vec::new();
    for package in &workspace.packages {
        let path = workspace.relative(&package.manifest_path);
        let manifest = Manifest::read(&package.manifest_path)?;
        if package.name != ENGINE {
            findings.extend(lints_of_its_own(path, &manifest));
            findings.extend(versions_of_its_own(path, &manifest));
        }
        findings.extend(unnamed(workspace, package, path, &manifest, sources));
        manifests.push(manifest);
    }
    findings.extend(in_table_only(&root, &manifests));
    Ok(findings)
}

/// A manifest as it was written: cargo's metadata no longer tell who inherits what.
pub(super) struct Manifest {
    text: String,
    pub(super) table: Table,
}

impl Manifest {
    pub(super) fn read(path: &Path) -> Result<Self> {
        let what = || format!("cannot read {}", path.display());
        Self::parse(fs::read_to_string(path).with_context(what)?).with_context(what)
    }

    pub(super) fn parse(text: String) -> Result<Self> {
        let table = text.parse()?;
        Ok(Self { text, table })
    }

    pub(super) fn at(&self, path: &Path, key: &str) -> String {
        key_at(path, &self.text, key)
    }

    fn is_engine(&self) -> bool {
        let name = self.table.get("package").and_then(|p| p.get("name"));
        name.and_then(Value::as_str) == Some(ENGINE)
    }

    /// Names and values of all dependencies, those of single platforms included.
    pub(super) fn dependencies(&self) -> impl Iterator<Item = (&String, &Value)> {
        let targets = self.table.get("target").and_then(Value::as_table);
        let platforms = targets
            .into_iter()
            .flat_map(Table::values)
            .filter_map(Value::as_table);
        std::iter::once(&self.table)
            .chain(platforms)
            .flat_map(|table| {
                ["dependencies", "dev-dependencies", "build-dependencies"]
                    .into_iter()
                    .filter_map(|kind| table.get(kind)?.as_table())
                    .flatten()
            })
    }
}

fn inherits(value: &Value) -> bool {
    value.get("workspace").and_then(Value::as_bool) == Some(true)
}

fn lints_of_its_own(path: &Path, manifest: &Manifest) -> Option<Finding> {
    let inherited = manifest.table.get("lints").is_some_and(inherits);
    (!inherited).then(|| {
        Finding::new(
            path.display().to_string(),
            "does not obey the workspace's lints",
            "add `[lints]` with `workspace = true`",
        )
    })
}

fn versions_of_its_own(path: &Path, manifest: &Manifest) -> Vec<Finding> {
    let own = manifest
        .dependencies()
        .filter(|(_, value)| !inherits(value));
    own.map(|(name, _)| {
        Finding::new(
            manifest.at(path, name),
            format!("`{name}` has a version of its own"),
            "move it to [workspace.dependencies] and write `workspace = true` here",
        )
    })
    .collect()
}

fn in_table_only(root: &Manifest, manifests: &[Manifest]) -> Vec<Finding> {
    let table = root
        .table
        .get("workspace")
        .and_then(|w| w.get("dependencies")?.as_table());
    let names = table.into_iter().flat_map(Table::keys);
    let unused = names.filter(|name| {
        !manifests.iter().any(|m| {
            m.dependencies()
                .any(|(used, v)| used == *name && (inherits(v) || m.is_engine()))
        })
    });
    unused
        .map(|name| {
            Finding::new(
                root.at(Path::new(MANIFEST), name),
                format!("no crate uses `{name}`"),
                "remove it from [workspace.dependencies]",
            )
        })
        .collect()
}

fn unnamed(
    workspace: &Workspace,
    package: &Package,
    path: &Path,
    manifest: &Manifest,
    sources: &[Source],
) -> Vec<Finding> {
    let folder = workspace.relative(package.folder());
    let own = |source: &&Source| source.is_rust() && source.path.starts_with(folder);
    let sources: Vec<&Source> = sources.iter().filter(own).collect();
    let unnamed = package.dependencies.iter().filter(|dependency| {
        let word = dependency.identifier();
        let excused = UNNAMED_DEPENDENCIES
            .iter()
            .any(|(p, d, _)| (*p, *d) == (package.name.as_str(), dependency.name.as_str()));
        !excused
            && !sources
                .iter()
                .any(|source| source.text.lines().any(|l| has_word(l, &word)))
    });
    unnamed
        .map(|dependency| {
            Finding::new(
                manifest.at(path, dependency.rename.as_ref().unwrap_or(&dependency.name)),
                format!(
                    "no source of `{}` names `{}`",
                    package.name,
                    dependency.identifier()
                ),
                "remove the dependency; if something needs it unnamed, list it with the \
                 reason in xtask/src/tidy/exceptions.rs",
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(text: &str) -> Manifest {
        Manifest::parse(text.into()).unwrap()
    }

    #[test]
    fn a_dependency_without_a_user_is_found() {
        let root = manifest("[workspace.dependencies]\nlog = \"0.4\"\nrayon = \"1\"\n");
        let user = manifest("[dev-dependencies]\nlog.workspace = true\n");
        let found = in_table_only(&root, &[user]);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].place, "Cargo.toml:3");
    }

    #[test]
    fn versions_and_lints_are_inherited() {
        let path = Path::new("crates/x/Cargo.toml");
        let fine = manifest("[lints]\nworkspace = true\n[dependencies]\nlog.workspace = true\n");
        assert!(versions_of_its_own(path, &fine).is_empty());
        assert!(lints_of_its_own(path, &fine).is_none());

        let own = manifest("[target.'cfg(unix)'.dependencies]\nlog = \"0.4\"\n");
        assert_eq!(
            versions_of_its_own(path, &own)[0].place,
            "crates/x/Cargo.toml:2"
        );
        assert!(lints_of_its_own(path, &own).is_some());
    }
}
