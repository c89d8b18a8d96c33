//! `cargo xtask ci`: everything that a change must pass.

use crate::{
    docs, regress, standalone, tidy,
    workspace::{Package, Workspace, cargo},
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

/// What only a build with features shows, by the package that has them: lints and tests that the workspace's own leave
/// out. Of the command line only the tests that need the feature run a second time.
const FEATURE_TESTS: [(&str, &str); 3] = [
    (
        "pomona-cli",
        "clippy --package pomona-messages --package pomona-cli --features mcap --all-targets -- -D warnings",
    ),
    (
        "pomona-messages",
        "test --package pomona-messages --features mcap --lib --test messages recording",
    ),
    (
        "pomona-cli",
        "test --package pomona-cli --features mcap --test cli mcap",
    ),
];

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
        Step::cargo("clippy", "clippy --workspace --all-targets -- -D warnings"),
    ];
    steps.extend(workspace.packages.iter().flat_map(feature_builds));
    steps.push(Step::cargo("test", "test --workspace"));
    let has = |package: &str| workspace.packages.iter().any(|p| p.name == package);
    let tested = FEATURE_TESTS.iter().filter(|(package, _)| has(package));
    steps.extend(tested.map(|(_, arguments)| Step::cargo("features", arguments)));
    let mut doc = Step::cargo("doc", "doc --workspace --no-deps");
    if let Action::Cargo { variable, .. } = &mut doc.action {
        *variable = Some(("RUSTDOCFLAGS", "-D warnings"));
    }
    steps.push(doc);
    steps.push(Step::own("standalone", "standalone", || {
        standalone::run(&standalone::Args::default())
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

/// A package with features is built alone without any, with each, and with all.
fn feature_builds(package: &Package) -> Vec<Step> {
    let features: Vec<&String> = package
        .features
        .keys()
        .filter(|f| *f != "default")
        .collect();
    if features.is_empty() {
        return Vec::new();
    }
    let mut choices = vec!["--no-default-features".to_string()];
    choices.extend(
        features
            .iter()
            .map(|f| format!("--no-default-features --features {f}")),
    );
    if features.len() > 1 {
        choices.push("--all-features".into());
    }
    let name = &package.name;
    let step = |choice| Step::cargo("features", &format!("check --package {name} {choice}"));
    choices.into_iter().map(step).collect()
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
        assert_eq!(
            lines[4],
            "RUSTDOCFLAGS=\"-D warnings\" cargo doc --workspace --no-deps"
        );
        assert_eq!(lines[5], "cargo xtask standalone");
        assert_eq!(lines[6], "cargo xtask regress --build tested");
        assert_eq!(lines[7], "cargo xtask docs --check --build tested");
    }

    #[test]
    fn tests_of_features_run_where_their_package_is() {
        let metadata = r#"{"name": "pomona-messages", "manifest_path": "/x/Cargo.toml", "dependencies": [],
            "targets": [], "features": {}}"#;
        let workspace = Workspace::of(vec![serde_json::from_str(metadata).unwrap()]);
        let lines: Vec<String> = steps(&workspace)
            .iter()
            .map(|step| step.action.command_line())
            .collect();
        let after = lines
            .iter()
            .position(|l| l == "cargo test --workspace")
            .unwrap();
        assert_eq!(
            lines[after + 1],
            "cargo test --package pomona-messages --features mcap --lib --test messages recording"
        );
        assert!(!lines.iter().any(|l| l.contains("pomona-cli")));
    }

    #[test]
    fn features_are_built_one_by_one() {
        let metadata = r#"{"name": "x", "manifest_path": "/x/Cargo.toml", "dependencies": [],
            "targets": [], "features": {"default": ["a"], "a": [], "b": []}}"#;
        let package: Package = serde_json::from_str(metadata).unwrap();
        let lines: Vec<String> = feature_builds(&package)
            .iter()
            .map(|step| step.action.command_line())
            .collect();
        assert_eq!(
            lines,
            [
                "cargo check --package x --no-default-features",
                "cargo check --package x --no-default-features --features a",
                "cargo check --package x --no-default-features --features b",
                "cargo check --package x --all-features",
            ]
        );
    }
}
