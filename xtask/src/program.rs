//! The program `pomona`, built and ready to be started.

use crate::workspace::{Workspace, cargo, root};
use anyhow::{Context, Result, ensure};
use std::{env::consts::EXE_SUFFIX, path::PathBuf, process::Command};

/// How the program is compiled.
#[derive(Clone, Copy, Default, clap::ValueEnum)]
pub(crate) enum Build {
    /// As users get it
    #[default]
    Release,
    /// As the tests build it, with assertions; what they have compiled serves again
    Tested,
}

/// The built program.
pub(crate) struct Program {
    path: PathBuf,
}

impl Program {
    pub(crate) fn build(build: Build) -> Result<Self> {
        let (arguments, folder): (&[&str], _) = match build {
            Build::Release => (
                &["build", "--package", "pomona-cli", "--release"],
                "release",
            ),
            // The tests of the command line bring the program along, with the same features as theirs.
            Build::Tested => (
                &[
                    "test",
                    "--workspace",
                    "--all-features",
                    "--tests",
                    "--no-run",
                ],
                "debug",
            ),
        };
        let status = cargo()
            .args(arguments)
            .arg("--quiet")
            .status()
            .context("cannot start cargo")?;
        ensure!(status.success(), "the program does not build");
        let folder = Workspace::read()?.target_directory.join(folder);
        Ok(Self {
            path: folder.join(format!("pomona{EXE_SUFFIX}")),
        })
    }

    /// The program, to be started in the workspace's root.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(&self.path);
        command.current_dir(root());
        command
    }
}
