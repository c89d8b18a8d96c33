//! `cargo xtask book`: `docs/` as a book.

use crate::workspace::root;
use anyhow::{Context, Result, bail, ensure};
use std::{io::ErrorKind, process::Command};

/// Builds the book of `book.toml`; an error that tells the remedy where mdBook is not installed.
pub(crate) fn run() -> Result<()> {
    let built = Command::new("mdbook")
        .arg("build")
        .current_dir(root())
        .status();
    match built {
        Err(error) if error.kind() == ErrorKind::NotFound => bail!(
            "mdBook is not installed: `cargo install mdbook --locked`; the pages of docs/ can be read without it"
        ),
        built => ensure!(
            built.context("cannot start mdbook")?.success(),
            "the book does not build"
        ),
    }
    Ok(())
}
