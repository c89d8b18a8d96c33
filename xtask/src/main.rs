//! The project's own commands: `cargo xtask COMMAND`.
//!
//! `ci` is everything that a change must pass; `tidy` the rules that no compiler knows; `regress` whether any
//! result got worse; `docs` that README and docs show what the program prints; `survey` how large each crate is; `ablate`
//! what each idea is worth; `bench` how fast and how accurate we and others are. `standalone`, `package`, `deny`,
//! `msrv` and `semver` are for those who build on the libraries.
//!
//! No algorithm lives here and none is linked in: commands start the programs
//! of the workspace and read what they print.

mod ablate;
mod bench;
mod book;
mod ci;
mod deny;
mod docs;
mod features;
mod fit;
mod modules;
mod msrv;
mod package;
mod program;
mod regress;
mod semver;
mod source;
mod standalone;
mod survey;
mod tidy;
mod workspace;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// The project's own commands.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Everything that a change must pass, from formatting to the regression gate
    Ci,
    /// The rules that no compiler knows: layers, front pages, lengths, dependencies
    Tidy,
    /// Fills README and docs with what the program prints
    Docs(docs::Args),
    /// Do the dependencies' licences, sources and known faults suit us?
    Deny(deny::Args),
    /// Does everything build with the oldest compiler that the manifest names?
    Msrv,
    /// Would a registry accept every library, and does it build from what lies there?
    Package(package::Args),
    /// Builds docs/ as a book, where mdBook is installed
    Book,
    /// How large each crate is, and how its modules depend on one another
    Survey(survey::Args),
    /// How long it takes and how far off it is, ours and the peers'
    Bench(bench::Args),
    /// Golden runs and accuracy floors: did anything get worse?
    Regress(regress::Args),
    /// What each idea of the method `robust` is worth: variants with one of them off
    Ablate(ablate::Args),
    /// Fits the coefficients of the confidence again, and prints them beside those in use
    FitConfidence,
    /// The same of the probability that a branch candidate is wood
    FitWood,
    /// How well the stated uncertainties of directions and centres hold on the same scenes
    FitSpread,
    /// Does a copy of the engine's folder build without the rest of the workspace?
    Standalone(standalone::Args),
    /// Do our libraries still suit those who built against their last release?
    Semver(semver::Args),
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Ci => ci::run(),
        Command::Tidy => tidy::run(),
        Command::Docs(args) => docs::run(&args),
        Command::Deny(args) => deny::run(&args),
        Command::Msrv => msrv::run(),
        Command::Package(args) => package::run(&args),
        Command::Book => book::run(),
        Command::Survey(args) => survey::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Regress(args) => regress::run(&args),
        Command::Ablate(args) => ablate::run(&args),
        Command::FitConfidence => fit::run("confidence"),
        Command::FitWood => fit::run("wood"),
        Command::FitSpread => fit::run("spread"),
        Command::Standalone(args) => standalone::run(&args),
        Command::Semver(args) => semver::run(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
