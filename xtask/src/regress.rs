//! `cargo xtask regress`: did any result get worse?
//!
//! Runs the program over the suites of `xtask/regress.toml`, reads what it writes, and holds it against the
//! limits there and the golden runs in `fixtures/golden`.

mod lab;
mod real;
mod side;
mod table;

use crate::{
    program::{Build, Program},
    workspace::root,
};
use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::time::Instant;
use xtask_gate::{Finding, Golden, Limits, RealLimits, SuiteLimits, Verdict, failures, judge};

const LIMITS: &str = "xtask/regress.toml";
const GOLDEN: &str = "fixtures/golden";
const OUT: &str = "target/regress";

/// What to run.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Every suite, also those that take longer
    #[arg(long)]
    full: bool,
    /// Only this suite
    #[arg(long, value_name = "NAME")]
    suite: Option<String>,
    /// Take this run's values as the golden ones; limits and truth stay as they are
    #[arg(long)]
    bless: bool,
    /// How the program is compiled
    #[arg(long, value_enum, default_value_t)]
    build: Build,
    /// Show every field, not only those that moved
    #[arg(long)]
    all: bool,
}

impl Args {
    /// What `cargo xtask ci` asks for.
    pub(crate) const TESTED: Self = Self {
        full: false,
        suite: None,
        bless: false,
        build: Build::Tested,
        all: false,
    };
}

/// Runs the suites and says what moved; an error where something is worse than it may be.
pub(crate) fn run(args: &Args) -> Result<()> {
    let limits = Limits::read(&root().join(LIMITS))?;
    let chosen: Vec<&SuiteLimits> = limits
        .suites
        .iter()
        .filter(|suite| match &args.suite {
            Some(name) => suite.name == *name,
            None => args.full || !suite.full,
        })
        .collect();
    let real: Vec<&RealLimits> = limits
        .real
        .iter()
        .filter(|run| args.suite.as_ref().is_none_or(|name| run.name == *name))
        .collect();
    if chosen.is_empty() && real.is_empty() {
        let suites = limits.suites.iter().map(|suite| suite.name.as_str());
        let real = limits.real.iter().map(|run| run.name.as_str());
        let names: Vec<_> = suites.chain(real).collect();
        bail!("no such suite in {LIMITS}; there are {}", names.join(", "));
    }
    let program = Program::build(args.build)?;
    let golden_folder = root().join(GOLDEN);
    let mut findings: Vec<Finding> = Vec::new();
    for runs in together(&chosen) {
        let start = Instant::now();
        let evaluation = evaluate(&program, &runs)?;
        let ids: Vec<String> = runs.iter().map(|suite| suite.id()).collect();
        let seconds = start.elapsed().as_secs_f64();
        println!("{}: {seconds:.1} s", ids.join(", "));
        for suite in runs {
            let result = result(&evaluation, suite)?;
            if args.bless {
                Golden::of(result, suite)?.write(&golden_folder, suite)?;
            }
            let golden = Golden::read(&golden_folder, suite)?;
            findings.extend(judge(result, suite, golden.as_ref()));
            let tables = lab::tables(result);
            if !tables.is_empty() {
                println!("\n{}, {tables}", suite.id());
            }
        }
        let beside = side::table(&evaluation);
        if !beside.is_empty() {
            println!("\n{beside}");
        }
    }
    for run in real {
        findings.extend(real::findings(&program, run, Path::new(OUT))?);
    }
    println!("\n{}", table::of(&findings, args.all));
    let failed = failures(&findings).count();
    let better = findings
        .iter()
        .filter(|f| f.verdict == Verdict::Better)
        .count();
    if better > 0 {
        println!("{better} better than golden: `cargo xtask regress --bless` keeps what was won");
    }
    ensure!(
        failed == 0,
        "regress: {failed} of {} fields are worse than they may be; if that is meant, say why in {LIMITS} \
         or bless the goldens",
        findings.len()
    );
    println!(
        "regress: {} fields, none worse than it may be",
        findings.len()
    );
    Ok(())
}

/// Runs that ask for the same scenes and seed, whatever the method: each scene is made once.
fn together<'a>(chosen: &[&'a SuiteLimits]) -> Vec<Vec<&'a SuiteLimits>> {
    let mut groups: Vec<Vec<&SuiteLimits>> = Vec::new();
    let of = |suite: &SuiteLimits| (suite.name.clone(), suite.count, suite.seed);
    for &suite in chosen {
        match groups.iter_mut().find(|group| of(group[0]) == of(suite)) {
            Some(group) => group.push(suite),
            None => groups.push(vec![suite]),
        }
    }
    groups
}

/// Runs the program over one suite under the methods of `runs`, and reads what it wrote.
fn evaluate(program: &Program, runs: &[&SuiteLimits]) -> Result<Value> {
    let Some(suite) = runs.first() else {
        bail!("nothing to run");
    };
    let ids: Vec<String> = runs.iter().map(|run| run.id()).collect();
    let id = ids.join("+");
    let out: PathBuf = Path::new(OUT).join(&id);
    let mut command = program.command();
    command
        .args(["evaluate", &suite.name])
        .args(["--seed", &suite.seed.to_string()])
        .arg("--out")
        .arg(&out);
    for run in runs {
        command.args(["--method", &run.method]);
    }
    if let Some(count) = suite.count {
        command.args(["--count", &count.to_string()]);
    }
    let run = command.output().context("cannot start the program")?;
    let errors = String::from_utf8_lossy(&run.stderr);
    ensure!(run.status.success(), "{id}: {}", errors.trim_end());
    let path = root().join(out).join("evaluation.json");
    let what = || path.display().to_string();
    serde_json::from_str(&std::fs::read_to_string(&path).with_context(what)?).with_context(what)
}

/// The entry of a run.
fn result<'a>(evaluation: &'a Value, suite: &SuiteLimits) -> Result<&'a Value> {
    let own = |entry: &&Value| {
        entry.get("suite").and_then(Value::as_str) == Some(&suite.name)
            && entry.get("method").and_then(Value::as_str) == Some(&suite.method)
    };
    let results = evaluation.get("results").and_then(Value::as_array);
    let result = results.into_iter().flatten().find(own);
    result.with_context(|| format!("no result of {}", suite.id()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_run_that_is_asked_for_has_its_golden() {
        let limits = Limits::read(&root().join(LIMITS)).unwrap();
        for suite in &limits.suites {
            let golden = Golden::read(&root().join(GOLDEN), suite).unwrap();
            assert!(
                golden.is_some(),
                "{}: cargo xtask regress --full --bless",
                suite.id()
            );
        }
    }

    #[test]
    fn the_targets_of_the_lab_stand() {
        let limits = Limits::read(&root().join(LIMITS)).unwrap();
        let lab = limits
            .suites
            .iter()
            .find(|s| s.name == "lab150" && s.method == "paper")
            .unwrap();
        for (field, ceiling) in [
            ("angle_mean_deg", 6.0),
            ("angle_max_deg", 18.0),
            ("center_mean_mm", 2.2),
        ] {
            assert!(
                lab.fields[field].ceiling.is_some_and(|c| c <= ceiling),
                "{field}"
            );
        }
        assert!(!lab.full);
    }
}
