//! `cargo xtask bench`: how long it takes and how far off it is, ours and, on demand, the peers'.

mod calibration;
mod clouds;
mod comparison;
mod engine;
mod interval;
mod networks;
mod own;
mod peers;
mod table;

use crate::workspace::{Workspace, cargo, root};
use anyhow::{Context, Result, ensure};
use clouds::{Mode, Primitive};
use comparison::{Comparison, Contest};
use networks::Networks;
use std::path::Path;
use std::process::Command;

/// What to measure.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Also ask the peers that are installed to fit the same clouds, in turns with ours
    #[arg(long, group = "contest")]
    peers: bool,
    /// Only calibrate so many seeded trials of each case, 200 by default, beside OpenCV's solvers where these are
    /// installed
    #[arg(long, group = "contest", value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "200", value_parser = clap::value_parser!(u32).range(1..))]
    calibration: Option<u32>,
    /// Only run the detectors' networks in both runtimes, so many rounds in turns, 30 by default
    #[arg(long, group = "contest", value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "30", value_parser = clap::value_parser!(u32).range(1..))]
    detection: Option<u32>,
    /// Only run the built-in segmenter in both runtimes, so many rounds in turns, 30 by default
    #[arg(long, group = "contest", value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "30", value_parser = clap::value_parser!(u32).range(1..))]
    segmentation: Option<u32>,
    /// Get those peers first that a package registry holds
    #[arg(long, requires = "contest")]
    install: bool,
    /// Leave out our own benchmarks and go straight to the peers
    #[arg(long, requires = "peers")]
    only_peers: bool,
    /// Scenes of each suite that the peers fit
    #[arg(long, default_value_t = 15, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    scenes: u32,
    /// How often each engine fits each cloud, each time with another seed
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    rounds: u32,
    /// Only our benchmarks whose name holds this
    filter: Option<String>,
}

/// The suites that all engines fit.
const SUITES: [&str; 3] = ["lab15", "repeat474", "orchard"];

/// Runs and prints it all.
pub(crate) fn run(args: &Args) -> Result<()> {
    let workspace = Workspace::read()?;
    if let Some(rounds) = args.detection {
        return networks::run(&workspace, Networks::Detection, rounds);
    }
    if let Some(rounds) = args.segmentation {
        return networks::run(&workspace, Networks::Segmentation, rounds);
    }
    if !args.only_peers && args.calibration.is_none() {
        own::run(&workspace, args.filter.as_deref())?;
    }
    if args.peers {
        compare(&workspace, args)?;
    }
    if args.peers || args.calibration.is_some() {
        calibration::run(&workspace, args.calibration.unwrap_or(200), args.install)?;
    }
    Ok(())
}

fn compare(workspace: &Workspace, args: &Args) -> Result<()> {
    let folder = workspace.target_directory.join("bench");
    std::fs::create_dir_all(&folder)
        .with_context(|| format!("cannot make {}", folder.display()))?;
    let ours = build_ours(workspace)?;
    let clouds = export(&ours, &folder.join("clouds"), args.scenes)?;
    let mut contest = Contest::new(peers::all(&ours, &folder, args.install));
    contest.run(&clouds, args.rounds)?;

    let mut summary = Vec::new();
    for suite in SUITES {
        for primitive in [Primitive::Sphere, Primitive::Line] {
            for mode in [Mode::Full, Mode::Adaptive] {
                let comparison = Comparison::new(&contest, &clouds, suite, primitive, mode);
                println!("{}", table::of(&comparison));
                summary.push(comparison.to_json());
            }
        }
    }
    for (name, reason) in contest.absent() {
        println!("absent: {name} ({reason})");
    }
    let path = folder.join("peers.json");
    std::fs::write(&path, serde_json::to_string_pretty(&summary)?)
        .with_context(|| format!("cannot write {}", path.display()))?;
    println!("all of it: {}", workspace.relative(&path).display());
    Ok(())
}

/// Our side of the contest; see `crates/fit/examples/peer_bench`.
fn build_ours(workspace: &Workspace) -> Result<std::path::PathBuf> {
    let built = cargo()
        .args([
            "build",
            "--release",
            "--quiet",
            "--package",
            "pomona-fit",
            "--example",
            "peer_bench",
        ])
        .status()
        .context("cannot start cargo")?;
    ensure!(built.success(), "our own program does not build");
    Ok(workspace
        .target_directory
        .join("release/examples/peer_bench"))
}

fn export(ours: &Path, folder: &Path, scenes: u32) -> Result<Vec<clouds::Cloud>> {
    let choices = SUITES.map(|suite| format!("{suite}={scenes}"));
    let mut command = Command::new(ours);
    command
        .current_dir(root())
        .arg("export")
        .arg(folder)
        .args(choices);
    let status = command
        .status()
        .with_context(|| format!("cannot start {}", ours.display()))?;
    ensure!(status.success(), "the clouds could not be made");
    clouds::read(folder)
}
