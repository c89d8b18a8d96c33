//! `cargo xtask package`: would every library of ours be accepted by a registry, and build from what lies there?
//!
//! cargo packs the crates in the order of their dependencies and lets each one use those packed before it.

use crate::workspace::{Package, Workspace, cargo, root};
use anyhow::{Context, Result, bail, ensure};
use std::collections::BTreeSet;

/// How thoroughly.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Only look at what would be packed, and build nothing
    #[arg(long)]
    list: bool,
}

impl Args {
    /// What `cargo xtask ci` asks for.
    pub(crate) const LIST: Self = Self { list: true };
}

/// What a package must hold besides its sources.
const FILES: [&str; 4] = ["Cargo.toml", "LICENSE-APACHE", "LICENSE-MIT", "README.md"];

/// Packs, and builds what was packed unless only the list is asked for.
pub(crate) fn run(args: &Args) -> Result<()> {
    let workspace = Workspace::read()?;
    let public: Vec<&Package> = workspace
        .packages
        .iter()
        .filter(|p| p.is_public())
        .collect();
    for package in &public {
        let missing = missing(&listed(&package.name)?);
        ensure!(
            missing.is_empty(),
            "{}: its package lacks {}",
            package.name,
            missing.join(", ")
        );
    }
    if args.list {
        println!("package: {} packages hold what they must", public.len());
        return Ok(());
    }
    // The packed crates know no workspace; they are built with its profile, so that what `target` holds serves again.
    let profile = workspace.profile_file()?;
    let mut command = cargo();
    command
        .args(["package", "--workspace", "--allow-dirty", "--config"])
        .arg(profile);
    for package in workspace.packages.iter().filter(|p| !p.is_public()) {
        command.args(["--exclude", &package.name]);
    }
    let status = command.status().context("cannot start cargo")?;
    if !status.success() {
        bail!("package: see above");
    }
    println!("package: {} packages pass", public.len());
    Ok(())
}

/// The files that cargo would pack.
fn listed(package: &str) -> Result<BTreeSet<String>> {
    let output = cargo()
        .current_dir(root())
        .args(["package", "--list", "--allow-dirty", "--package", package])
        .output()
        .context("cannot start cargo")?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(
        output.status.success(),
        "cargo package --list failed:\n{errors}"
    );
    Ok(String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(Into::into)
        .collect())
}

fn missing(files: &BTreeSet<String>) -> Vec<&'static str> {
    FILES
        .into_iter()
        .filter(|file| !files.contains(*file))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_package_without_its_licences_is_told() {
        let files = ["Cargo.toml", "README.md", "src/lib.rs"].map(str::to_owned);
        assert_eq!(missing(&files.into()), ["LICENSE-APACHE", "LICENSE-MIT"]);
    }
}
