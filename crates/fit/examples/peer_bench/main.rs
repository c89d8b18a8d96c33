//! Our side of `cargo xtask bench --peers`: makes the clouds that all engines fit, and fits them with ours.
//!
//! ```text
//! peer_bench export FOLDER SUITE=COUNT...   clouds and their truth from the first scenes of suites
//! peer_bench serve PRUNING                  answers fitting jobs, as xtask/peers/README.md says;
//!                                           PRUNING is statistical, lossless or never
//! ```

mod export;
mod job;

use std::error::Error;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    match arguments {
        [command, folder, suites @ ..] if command == "export" => {
            let suites: Result<Vec<_>, _> =
                suites.iter().map(|s| export::Choice::parse(s)).collect();
            export::export(folder.as_ref(), &suites?)
        }
        [command, pruning] if command == "serve" => {
            let pruning = job::Pruning::named(pruning)
                .ok_or("give `serve` one of statistical, lossless, never")?;
            let mut server = job::Server::new(pruning);
            for line in std::io::stdin().lines() {
                println!("{}", server.answer(&line?)?);
            }
            Ok(())
        }
        _ => Err("give `export FOLDER SUITE=COUNT...` or `serve PRUNING`".into()),
    }
}
