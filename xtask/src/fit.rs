//! `cargo xtask fit-wood` and `cargo xtask fit-confidence`: the coefficients of the models of the method `robust`, fitted
//! again to scenes.
//!
//! They are printed beside those in use and change nothing: whoever takes them over writes them into
//! `crates/pomona/src/robust/likeness.rs` or `confidence.rs` beside it and blesses the goldens. The confidence depends on
//! the probability of wood, and is fitted after it. `cargo xtask fit-spread` shows on the same scenes how well the stated
//! uncertainties hold; their factors stand in `crates/pomona/src/robust.rs`.

use crate::workspace::cargo;
use anyhow::{Context, Result, ensure};

/// Runs the program that fits `model`: `wood`, `confidence` or `spread`.
pub(crate) fn run(model: &str) -> Result<()> {
    let mut command = cargo();
    command.args([
        "run",
        "--release",
        "--quiet",
        "--package",
        "pomona-evaluate",
    ]);
    command.args(["--example", "fit", "--", model]);
    let status = command.status().context("cannot start cargo")?;
    ensure!(status.success(), "{status}");
    Ok(())
}
