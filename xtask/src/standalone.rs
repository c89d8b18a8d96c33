//! `cargo xtask standalone`: whoever holds the engine's folder alone can build, test and benchmark it.
//!
//! The folder is copied to a place where no workspace is above it, and cargo is asked there. What
//! it builds stays in `target/standalone`, so that the next time takes seconds.

use crate::workspace::{Workspace, cargo};
use anyhow::{Context, Result, ensure};
use std::{fs, path::Path};

const ENGINE: &str = "pomona-ransac";

/// How thoroughly.
#[derive(clap::Args, Default)]
pub(crate) struct Args {
    /// Also run its tests, examples and benchmarks there, these once each
    #[arg(long)]
    test: bool,
}

/// Copies the folder and builds it; an error where it does not stand alone.
pub(crate) fn run(args: &Args) -> Result<()> {
    let workspace = Workspace::read()?;
    let engine = workspace
        .package(ENGINE)
        .with_context(|| format!("there is no {ENGINE}"))?;
    let place = tempfile::Builder::new()
        .prefix("pomona-standalone-")
        .tempdir()
        .context("cannot make a folder for temporary files")?;
    copy(engine.folder(), place.path())?;
    // The versions that are tested here; cargo drops those that the engine does not use.
    let lock = workspace.root.join("Cargo.lock");
    fs::copy(&lock, place.path().join("Cargo.lock"))
        .with_context(|| format!("cannot copy {}", lock.display()))?;

    let mut commands = vec!["check --all-targets --all-features"];
    if args.test {
        commands.extend(["test --all-features", "bench --all-features -- --test"]);
    }
    for command in commands {
        println!("in a copy of {ENGINE}: cargo {command}");
        let status = cargo()
            .current_dir(place.path())
            .env(
                "CARGO_TARGET_DIR",
                workspace.target_directory.join("standalone"),
            )
            .args(command.split(' '))
            .status()
            .context("cannot start cargo")?;
        ensure!(
            status.success(),
            "a copy of {} does not stand alone: `cargo {command}` failed there",
            workspace.relative(engine.folder()).display()
        );
    }
    Ok(())
}

/// Copies what the folder holds, build outputs left out.
fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("cannot make {}", to.display()))?;
    let entries = fs::read_dir(from).with_context(|| format!("cannot list {}", from.display()))?;
    for entry in entries {
        let entry = entry?;
        let (source, name) = (entry.path(), entry.file_name());
        if source.is_dir() {
            if name != "target" {
                copy(&source, &to.join(name))?;
            }
        } else {
            fs::copy(&source, to.join(name))
                .with_context(|| format!("cannot copy {}", source.display()))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_is_whole_but_for_build_outputs() {
        let (from, to) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        for file in ["Cargo.toml", "src/lib.rs", "target/debug/x"] {
            let path = from.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, file).unwrap();
        }
        copy(from.path(), to.path()).unwrap();
        let read = |file| fs::read_to_string(to.path().join(file)).ok();
        assert_eq!(read("src/lib.rs").as_deref(), Some("src/lib.rs"));
        assert_eq!(read("Cargo.toml").as_deref(), Some("Cargo.toml"));
        assert!(!to.path().join("target").exists());
    }
}
