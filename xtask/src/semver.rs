//! `cargo xtask semver`: do our libraries still suit those who built against their last release?
//!
//! A release of the engine is a tag `pomona-ransac-vX.Y.Z`; the other libraries are released together, by a tag
//! `vX.Y.Z`. The comparison is that of `cargo-semver-checks`, which reads what rustdoc knows of both versions.

use crate::workspace::{Workspace, cargo, root};
use anyhow::{Context, Result, ensure};
use std::process::{Command, Stdio};

const ENGINE: &str = "pomona-ransac";
const ENGINE_TAG: &str = "pomona-ransac-v";
const TAG: &str = "v";

/// What to compare with.
#[derive(clap::Args, Default)]
pub(crate) struct Args {
    /// This tag, or any other revision, in place of the newest release
    #[arg(long, value_name = "TAG")]
    against: Option<String>,
}

/// Compares, and says what would break; an error where a version number does not own up to it.
pub(crate) fn run(args: &Args) -> Result<()> {
    let workspace = Workspace::read()?;
    let libraries = workspace
        .packages
        .iter()
        .filter(|p| p.is_public() && p.root_file("lib").is_some());
    let (engine, others): (Vec<&str>, Vec<&str>) = libraries
        .map(|p| p.name.as_str())
        .partition(|name| *name == ENGINE);
    compare(args, ENGINE_TAG, &engine)?;
    compare(args, TAG, &others)
}

fn compare(args: &Args, prefix: &str, packages: &[&str]) -> Result<()> {
    let release = match &args.against {
        Some(tag) => {
            let commit = format!("{tag}^{{commit}}");
            let known = git(&["rev-parse", "--verify", "--quiet", &commit]);
            ensure!(known.is_ok(), "there is no tag or revision `{tag}`");
            Some(tag.clone())
        }
        None => newest(prefix, &git(&["tag", "--list"])?),
    };
    let Some(release) = release else {
        println!(
            "semver: no tag {prefix}* yet, nothing to compare {} with",
            packages.join(", ")
        );
        return Ok(());
    };
    let installed = cargo()
        .args(["semver-checks", "--version"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .context("cannot start cargo")?;
    ensure!(
        installed.success(),
        "cargo-semver-checks is not installed, so nothing was compared with {release}\n    \
         get it by `cargo install cargo-semver-checks --locked`, which takes some minutes, and run this again"
    );
    println!("semver: {} against {release}", packages.join(", "));
    let mut command = cargo();
    command.args([
        "semver-checks",
        "check-release",
        "--all-features",
        "--baseline-rev",
        &release,
    ]);
    for package in packages {
        command.args(["--package", package]);
    }
    let status = command.status().context("cannot start cargo")?;
    ensure!(
        status.success(),
        "what was built against {release} would break, or could not be compared: see above"
    );
    Ok(())
}

fn git(arguments: &[&str]) -> Result<String> {
    let output = Command::new("git")
        .current_dir(root())
        .args(arguments)
        .output()
        .context("cannot start git")?;
    let errors = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "git failed: {errors}");
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The tag of the highest version; a pre-release counts for no release.
fn newest(prefix: &str, tags: &str) -> Option<String> {
    let version = |tag: &str| -> Option<[u64; 3]> {
        let rest = tag.strip_prefix(prefix)?;
        let numbers: Vec<u64> = rest
            .split('.')
            .map(str::parse)
            .collect::<Result<_, _>>()
            .ok()?;
        numbers.try_into().ok()
    };
    tags.lines()
        .filter(|tag| version(tag).is_some())
        .max_by_key(|tag| version(tag))
        .map(Into::into)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_version_is_the_newest() {
        let tags = "pomona-ransac-v0.9.0\npomona-ransac-v0.10.1\nv7.0.0\nv12.1.0\nv13.0\npomona-fit-v3.0.0\n\
            pomona-ransac-v1.0.0-rc.1\npomona-ransac-vnext\n";
        assert_eq!(
            newest(ENGINE_TAG, tags).as_deref(),
            Some("pomona-ransac-v0.10.1")
        );
        assert_eq!(newest(TAG, tags).as_deref(), Some("v12.1.0"));
        assert_eq!(newest(ENGINE_TAG, "v1.0.0\n"), None);
        assert_eq!(newest(TAG, ""), None);
    }
}
