//! `cargo xtask msrv`: does everything build with the oldest compiler that the manifest names?
//!
//! What the dependencies state is always compared. The compiler itself is asked where it is another than the one that
//! runs everything else and is installed.

use crate::workspace::{Workspace, cargo, root};
use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::process::{Command, Stdio};

/// Checks, and says what could not be checked.
pub(crate) fn run() -> Result<()> {
    let Some(oldest) = Workspace::read()?
        .packages
        .iter()
        .find_map(|p| p.rust_version.clone())
    else {
        anyhow::bail!("no package states a rust-version");
    };
    let newer = newer_than(&oldest, &all_packages()?);
    ensure!(
        newer.is_empty(),
        "the workspace says rust-version {oldest}, and {} more: raise it, or take an older release of them",
        newer.join(", ")
    );
    let output = Command::new("rustc")
        .arg("--version")
        .current_dir(root())
        .output();
    let version = output.context("cannot start rustc")?.stdout;
    let current = String::from_utf8_lossy(&version);
    if current.starts_with(&format!("rustc {oldest}.")) {
        println!("msrv: {oldest} is the compiler that checks everything here");
        return Ok(());
    }
    let toolchain = format!("+{oldest}");
    let installed = Command::new("rustc")
        .args([&toolchain, "--version"])
        .env("RUSTUP_AUTO_INSTALL", "0")
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .status();
    if !installed.is_ok_and(|status| status.success()) {
        println!(
            "msrv: no dependency asks for more than {oldest}; the compiler itself is not installed \
             (`rustup toolchain install {oldest} --profile minimal`)"
        );
        return Ok(());
    }
    let status = Command::new("cargo")
        .current_dir(root())
        .args([
            &toolchain,
            "check",
            "--workspace",
            "--all-features",
            "--all-targets",
        ])
        .status()
        .context("cannot start cargo")?;
    ensure!(
        status.success(),
        "the workspace does not build with Rust {oldest}"
    );
    Ok(())
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Stated>,
}

/// A package, ours or another's, and what it states.
#[derive(Deserialize)]
struct Stated {
    name: String,
    rust_version: Option<String>,
}

fn all_packages() -> Result<Vec<Stated>> {
    let output = cargo()
        .args(["metadata", "--format-version=1", "--all-features"])
        .output()
        .context("cannot start cargo")?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "cargo metadata failed:\n{errors}");
    let metadata: Metadata = serde_json::from_slice(&output.stdout)?;
    Ok(metadata.packages)
}

/// The packages that state a newer compiler, with what they state.
fn newer_than(oldest: &str, packages: &[Stated]) -> Vec<String> {
    let numbers = |version: &str| -> Vec<u32> {
        let parts = version.split('.');
        parts.map(|part| part.parse().unwrap_or(0)).collect()
    };
    let newer = |package: &&Stated| {
        let stated = package.rust_version.as_deref().unwrap_or_default();
        numbers(stated) > numbers(oldest)
    };
    let said = |package: &Stated| {
        let stated = package.rust_version.as_deref().unwrap_or_default();
        format!("{} {stated}", package.name)
    };
    packages.iter().filter(newer).map(said).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_their_numbers() {
        let stated = |name: &str, version: Option<&str>| Stated {
            name: name.into(),
            rust_version: version.map(Into::into),
        };
        let packages = [
            stated("old", Some("1.9")),
            stated("same", Some("1.95")),
            stated("silent", None),
            stated("new", Some("1.100.0")),
        ];
        assert_eq!(newer_than("1.95", &packages), ["new 1.100.0"]);
    }
}
