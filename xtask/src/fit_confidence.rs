//! `cargo xtask fit-confidence`: the coefficients of the confidence, fitted again to scenes.
//!
//! They are printed beside those in use and change nothing: whoever takes them over writes them into
//! `crates/pomona/src/robust/confidence.rs` and blesses the goldens.

use crate::workspace::cargo;
use anyhow::{Context, Result, ensure};

/// Runs the program that fits them.
pub(crate) fn run() -> Result<()> {
    let mut command = cargo();
    command.args([
        "run",
        "--release",
        "--quiet",
        "--package",
        "pomona-evaluate",
    ]);
    command.args(["--example", "fit_confidence"]);
    let status = command.status().context("cannot start cargo")?;
    ensure!(status.success(), "{status}");
    Ok(())
}
