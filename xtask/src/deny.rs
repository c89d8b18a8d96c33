//! `cargo xtask deny`: do the dependencies' licences, sources and known faults suit us?
//!
//! The rules stand in `deny.toml`; `cargo-deny` reads them.

use crate::workspace::cargo;
use anyhow::{Context, Result, ensure};
use std::process::Stdio;

/// What to check.
#[derive(clap::Args, Default)]
pub(crate) struct Args {
    /// Also look the dependencies up in the database of advisories, which is fetched from the network
    #[arg(long)]
    advisories: bool,
}

/// Checks, where cargo-deny is installed, and says so where it is not.
pub(crate) fn run(args: &Args) -> Result<()> {
    let installed = cargo()
        .args(["deny", "--version"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .context("cannot start cargo")?;
    if !installed.success() {
        ensure!(
            !args.advisories,
            "cargo-deny is not installed: `cargo install cargo-deny --locked`"
        );
        println!(
            "deny: cargo-deny is not installed, so licences were not checked; \
             `cargo install cargo-deny --locked` gets it, and the build server has it"
        );
        return Ok(());
    }
    let mut command = cargo();
    command.args(["deny", "--log-level", "error"]);
    if !args.advisories {
        command.arg("--offline");
    }
    command.args(["check", "bans", "licenses", "sources"]);
    if args.advisories {
        command.arg("advisories");
    }
    let status = command.status().context("cannot start cargo-deny")?;
    ensure!(
        status.success(),
        "deny: see above; the rules stand in deny.toml"
    );
    Ok(())
}
