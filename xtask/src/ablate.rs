//! `cargo xtask ablate`: what each idea of the method `robust` is worth.
//!
//! Runs the program once over each suite, the method as it is beside variants of its settings that each switch one
//! idea off (`xtask/ablation.toml`), and prints Markdown.

mod table;
mod variants;

use crate::{
    program::{Build, Program},
    workspace::root,
};
use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;
use std::path::{Path, PathBuf};
use variants::{Ablation, METHOD, VARIANTS, Variant};

const OUT: &str = "target/ablate";

/// What to run.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A suite, or SUITE@N for its scenes from the seed N on; may be repeated. Default: those of xtask/ablation.toml
    #[arg(long = "suite", value_name = "NAME")]
    suites: Vec<String>,
    /// Only so many scenes of each suite
    #[arg(long, value_name = "N")]
    count: Option<usize>,
    /// Only this variant; may be repeated
    #[arg(long = "variant", value_name = "NAME")]
    variants: Vec<String>,
}

/// Runs the variants and prints a table for each suite.
pub(crate) fn run(args: &Args) -> Result<()> {
    let ablation = Ablation::read()?;
    let names: Vec<&str> = ablation.variants.iter().map(|v| v.name.as_str()).collect();
    if let Some(unknown) = args.variants.iter().find(|v| !names.contains(&v.as_str())) {
        bail!(
            "no variant `{unknown}` in {VARIANTS}; there are {}",
            names.join(", ")
        );
    }
    let chosen: Vec<&Variant> = ablation
        .variants
        .iter()
        .filter(|v| args.variants.is_empty() || args.variants.contains(&v.name))
        .collect();
    let files = write(&chosen)?;
    let program = Program::build(Build::Release)?;
    let suites = if args.suites.is_empty() {
        &ablation.suites
    } else {
        &args.suites
    };
    for suite in suites {
        let evaluation = evaluate(&program, suite, args.count, &files)?;
        println!("{}", table::of(suite, &evaluation, &chosen)?);
    }
    Ok(())
}

/// Writes each variant as a file of settings, of its name.
fn write(variants: &[&Variant]) -> Result<Vec<PathBuf>> {
    let folder = root().join(OUT).join("settings");
    let what = || folder.display().to_string();
    std::fs::create_dir_all(&folder).with_context(what)?;
    let write = |variant: &&Variant| {
        let mut settings = toml::Table::new();
        settings.insert("method".to_owned(), METHOD.into());
        settings.insert(METHOD.to_owned(), variant.robust.clone().into());
        let path = folder.join(format!("{}.toml", variant.name));
        std::fs::write(&path, toml::to_string(&settings)?).with_context(what)?;
        Ok(path)
    };
    variants.iter().map(write).collect()
}

fn evaluate(
    program: &Program,
    suite: &str,
    count: Option<usize>,
    variants: &[PathBuf],
) -> Result<Value> {
    let out = Path::new(OUT).join(suite);
    let mut command = program.command();
    command
        .args(["evaluate", suite, "--method", METHOD, "--out"])
        .arg(&out);
    for variant in variants {
        command.arg("--variant").arg(variant);
    }
    if let Some(count) = count {
        command.args(["--count", &count.to_string()]);
    }
    let run = command.output().context("cannot start the program")?;
    let errors = String::from_utf8_lossy(&run.stderr);
    ensure!(run.status.success(), "{suite}: {}", errors.trim_end());
    let path = root().join(out).join("evaluation.json");
    let what = || path.display().to_string();
    serde_json::from_str(&std::fs::read_to_string(&path).with_context(what)?).with_context(what)
}
