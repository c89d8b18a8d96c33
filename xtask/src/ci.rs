//! `cargo xtask ci`: everything that a change must pass.

use crate::{
    deny, docs, features, msrv, package, regress, semver, standalone, tidy,
    workspace::{Workspace, cargo},
};
use anyhow::{Context, Result, bail, ensure};
use std::time::Instant;

/// One thing that must go well.
struct Step {
    name: String,
    action: Action,
}

enum Action {
    /// Arguments for cargo, and one variable of its environment.
    Cargo {
        arguments: Vec<String>,
        variable: Option<(&'static str, &'static str)>,
    },
    /// One of our own commands.
    Own {
        arguments: &'static str,
        run: fn() -> Result<()>,
    },
}

/// Runs every step, cheap ones first, and stops at the first that fails.
pub(crate) fn run() -> Result<()> {
    let begin = Instant::now();
    let mut durations = Vec::new();
    for step in steps(&Workspace::read()?) {
        let start = Instant::now();
        println!("── {}: {}", step.name, step.action.command_line());
        let outcome = step.action.run();
        let seconds = start.elapsed().as_secs_f64();
        if let Err(error) = outcome {
            bail!(
                "step `{}` failed after {seconds:.1} s: {error:#}\nto run it again: {}",
                step.name,
                step.action.command_line()
            );
        }
        println!("── {}: {seconds:.1} s\n", step.name);
        durations.push((step.name, seconds));
    }
    for (name, seconds) in durations {
        println!("{seconds:7.1} s  {name}");
    }
    println!("{:7.1} s  all passed", begin.elapsed().as_secs_f64());
    Ok(())
}

fn steps(workspace: &Workspace) -> Vec<Step> {
    let mut steps = vec![
        Step::cargo("fmt", "fmt --all --check"),
        Step::own("tidy", "tidy", tidy::run),
        Step::own("msrv", "msrv", msrv::run),
        Step::cargo(
            "clippy",
            "clippy --workspace --all-features --all-targets -- -D warnings",
        ),
    ];
    steps.extend(features::selections(workspace).iter().map(|selection| {
        let arguments = format!("clippy {selection} -- -D warnings");
        Step::cargo("features", &arguments)
    }));
    steps.push(Step::cargo(
        "test",
        "test --workspace --all-features --tests",
    ));
    steps.push(Step::cargo(
        "doctests",
        "test --workspace --all-features --doc",
    ));
    let mut doc = Step::cargo("doc", "doc --workspace --all-features --no-deps");
    if let Action::Cargo { variable, .. } = &mut doc.action {
        *variable = Some(("RUSTDOCFLAGS", "-D warnings"));
    }
    steps.push(doc);
    steps.push(Step::own("standalone", "standalone", || {
        standalone::run(&standalone::Args::default())
    }));
    steps.push(Step::own("package", "package --list", || {
        package::run(&package::Args::LIST)
    }));
    steps.push(Step::own("deny", "deny", || {
        deny::run(&deny::Args::default())
    }));
    steps.push(Step::own("semver", "semver", || {
        semver::run(&semver::Args::default())
    }));
    // Both run the program as the tests have built it.
    steps.push(Step::own("regress", "regress --build tested", || {
        regress::run(&regress::Args::TESTED)
    }));
    steps.push(Step::own("docs", "docs --check --build tested", || {
        docs::run(&docs::Args::CHECK)
    }));
    steps
}

impl Step {
    fn cargo(name: &str, arguments: &str) -> Self {
        let arguments = arguments.split(' ').map(Into::into).collect();
        Self {
            name: name.into(),
            action: Action::Cargo {
                arguments,
                variable: None,
            },
        }
    }

    fn own(name: &str, arguments: &'static str, run: fn() -> Result<()>) -> Self {
        Self {
            name: name.into(),
            action: Action::Own { arguments, run },
        }
    }
}

impl Action {
    fn run(&self) -> Result<()> {
        match self {
            Self::Cargo {
                arguments,
                variable,
            } => {
                let mut command = cargo();
                command.args(arguments).envs(*variable);
                let status = command.status().context("cannot start cargo")?;
                ensure!(status.success(), "{status}");
                Ok(())
            }
            Self::Own { run, .. } => run(),
        }
    }

    /// What to type to run it again.
    fn command_line(&self) -> String {
        match self {
            Self::Cargo {
                arguments,
                variable,
            } => {
                let variable = variable.map(|(key, value)| format!("{key}=\"{value}\" "));
                format!(
                    "{}cargo {}",
                    variable.unwrap_or_default(),
                    arguments.join(" ")
                )
            }
            Self::Own { arguments, .. } => format!("cargo xtask {arguments}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failing_step_tells_how_to_run_it_again() {
        let workspace = Workspace::of(Vec::new());
        let lines: Vec<String> = steps(&workspace)
            .iter()
            .map(|step| step.action.command_line())
            .collect();
        assert_eq!(lines[0], "cargo fmt --all --check");
        assert!(
            lines.contains(
                &"RUSTDOCFLAGS=\"-D warnings\" cargo doc --workspace --all-features --no-deps"
                    .to_owned()
            )
        );
        let last = &lines[lines.len() - 2..];
        assert_eq!(last[0], "cargo xtask regress --build tested");
        assert_eq!(last[1], "cargo xtask docs --check --build tested");
    }
}
