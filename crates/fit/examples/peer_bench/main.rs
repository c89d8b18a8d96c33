//! Our side of `cargo xtask bench --peers`: makes the clouds that all engines fit, and fits them with ours.
//!
//! ```text
//! peer_bench export FOLDER SUITE=COUNT...   clouds and their truth from the first scenes of suites
//! peer_bench serve                          answers fitting jobs, as xtask/peers/README.md says
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
        [command] if command == "serve" => {
            for line in std::io::stdin().lines() {
                println!("{}", job::answer(&line?)?);
            }
            Ok(())
        }
        _ => Err("give `export FOLDER SUITE=COUNT...` or `serve`".into()),
    }
}
