//! `cargo xtask tidy`: the rules that no compiler knows.

mod circles;
mod dependencies;
mod exceptions;
mod finding;
mod front_pages;
mod layers;
mod lengths;
mod names;
mod published;
mod standalone;
mod words;

use crate::{
    source,
    workspace::{self, Workspace},
};
use anyhow::{Result, bail};
use finding::Finding;

/// Prints what is wrong, if anything.
pub(crate) fn run() -> Result<()> {
    let findings = findings()?;
    for finding in &findings {
        eprintln!("{finding}");
    }
    match findings.len() {
        0 => println!("tidy: nothing to report"),
        1 => bail!("tidy: 1 finding"),
        n => bail!("tidy: {n} findings"),
    }
    Ok(())
}

fn findings() -> Result<Vec<Finding>> {
    let workspace = Workspace::read()?;
    let sources = source::read_all(workspace::root())?;
    let mut findings = layers::check(&workspace);
    findings.extend(circles::check(&workspace, &sources)?);
    findings.extend(dependencies::check(&workspace, &sources)?);
    findings.extend(front_pages::check(&workspace, &sources));
    findings.extend(lengths::check(&sources));
    findings.extend(names::check(&sources));
    findings.extend(published::check(&workspace)?);
    findings.extend(standalone::check(&workspace)?);
    findings.extend(words::check(&sources));
    Ok(findings)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_workspace_is_tidy() {
        let findings = super::findings().unwrap();
        let lines: Vec<String> = findings.iter().map(ToString::to_string).collect();
        assert!(lines.is_empty(), "\n{}\n", lines.join("\n"));
    }
}
