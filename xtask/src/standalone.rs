//! `cargo xtask standalone`: whoever holds the engine's folder alone can build, test and benchmark it.
//!
//! The folder is copied to a place where no workspace is above it, and cargo is asked there. The
//! copy's dependencies are built as the workspace builds them, so that what `target` holds serves again.

use crate::workspace::{Workspace, cargo};
use anyhow::{Context, Result, ensure};
use std::{
    env, fs,
    hash::{DefaultHasher, Hash, Hasher},
    io::ErrorKind,
    path::{Path, PathBuf},
};

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
    let place = Place::new(&workspace.root)?;
    copy(engine.folder(), &place.0)?;
    // The versions that are tested here; cargo drops those that the engine does not use.
    let lock = workspace.root.join("Cargo.lock");
    fs::copy(&lock, place.0.join("Cargo.lock"))
        .with_context(|| format!("cannot copy {}", lock.display()))?;

    // The profile of the workspace, which the copy has not.
    let profile = workspace.profile_file()?;
    let mut commands = vec!["check --all-targets --all-features"];
    if args.test {
        commands.extend(["test --all-features", "bench --all-features -- --test"]);
    }
    for arguments in commands {
        println!("in a copy of {ENGINE}: cargo {arguments}");
        let mut command = cargo();
        command
            .current_dir(&place.0)
            .env("CARGO_TARGET_DIR", &workspace.target_directory)
            .arg("--config")
            .arg(&profile);
        let status = command
            .args(arguments.split(' '))
            .status()
            .context("cannot start cargo")?;
        ensure!(
            status.success(),
            "a copy of {} does not stand alone: `cargo {arguments}` failed there",
            workspace.relative(engine.folder()).display()
        );
    }
    Ok(())
}

/// A folder for the copy, gone when this is dropped.
///
/// It has the same name each time, because cargo builds anew what lies somewhere else, and another name
/// for each workspace.
struct Place(PathBuf);

impl Place {
    fn new(root: &Path) -> Result<Self> {
        let mut hasher = DefaultHasher::new();
        root.hash(&mut hasher);
        let path = env::temp_dir().join(format!("pomona-standalone-{:x}", hasher.finish()));
        match fs::remove_dir_all(&path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(error).with_context(|| format!("cannot clear {}", path.display()))
            }
            _ => Ok(Self(path)),
        }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        // Nothing depends on it: the next run clears it again.
        let _ = fs::remove_dir_all(&self.0);
    }
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
