//! `cargo xtask semver`: does the engine's interface still suit those who built against its last release?
//!
//! A release is a tag `pomona-ransac-vX.Y.Z`. The comparison is that of `cargo-semver-checks`, which
//! reads what rustdoc knows of both versions.

use crate::workspace::{cargo, root};
use anyhow::{Context, Result, bail, ensure};
use std::process::{Command, Stdio};

const ENGINE: &str = "pomona-ransac";

/// What to compare with.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// This tag, or any other revision, in place of the newest release
    #[arg(long, value_name = "TAG")]
    against: Option<String>,
}

/// Compares, and says what would break; an error where the version number does not own up to it.
pub(crate) fn run(args: &Args) -> Result<()> {
    let release = match &args.against {
        Some(tag) => {
            ensure!(
                git(&[
                    "rev-parse",
                    "--verify",
                    "--quiet",
                    &format!("{tag}^{{commit}}")
                ])
                .is_ok(),
                "there is no tag or revision `{tag}`"
            );
            Some(tag.clone())
        }
        None => newest(&git(&["tag", "--list"])?),
    };
    let Some(release) = release else {
        println!("semver: no tag {ENGINE}-v* yet, nothing to compare");
        return Ok(());
    };
    let installed = cargo()
        .args(["semver-checks", "--version"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .context("cannot start cargo")?;
    if !installed.success() {
        bail!(
            "cargo-semver-checks is not installed, so {ENGINE} was not compared with {release}\n    \
             get it by `cargo install cargo-semver-checks --locked`, which takes some minutes, \
             and run this again"
        );
    }
    println!("semver: {ENGINE} as it is against {release}");
    let status = cargo()
        .args(["semver-checks", "check-release", "--all-features"])
        .args(["--package", ENGINE, "--baseline-rev", &release])
        .status()
        .context("cannot start cargo")?;
    ensure!(
        status.success(),
        "{ENGINE} breaks those who built against {release}, or could not be compared: see above"
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

/// The tag of the highest version of the engine; a pre-release counts for no release.
fn newest(tags: &str) -> Option<String> {
    let version = |tag: &str| -> Option<[u64; 3]> {
        let rest = tag.strip_prefix(ENGINE)?.strip_prefix("-v")?;
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
        let tags = "pomona-ransac-v0.9.0\npomona-ransac-v0.10.1\nv7.0.0\npomona-fit-v3.0.0\n\
            pomona-ransac-v1.0.0-rc.1\npomona-ransac-vnext\n";
        assert_eq!(newest(tags).as_deref(), Some("pomona-ransac-v0.10.1"));
        assert_eq!(newest("v1.0.0\n"), None);
        assert_eq!(newest(""), None);
    }
}
