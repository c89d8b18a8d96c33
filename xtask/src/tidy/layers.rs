//! Arrows between the crates point down only.

use super::finding::{Finding, key_at};
use crate::workspace::{Dependency, Package, Workspace};
use std::fs;

/// The layers from the bottom up. A crate may depend on crates of lower layers.
const LAYERS: &[&[&str]] = &[
    &[
        "pomona-ransac",
        "pomona-geometry",
        "pomona-schema",
        "pomona-settings",
        "pomona-files",
        "pomona-statistics",
    ],
    &[
        "pomona-cloud",
        "pomona-fit",
        "pomona-report",
        "pomona-transforms",
    ],
    &["pomona-approach", "pomona-calibrate", "pomona-network"],
    &["pomona-detect", "pomona-segment"],
    &["pomona", "pomona-scenes", "pomona-view"],
    &["pomona-fusion", "pomona-messages"],
    &["pomona-labels"],
    &["pomona-evaluate"],
    &["pomona-cli"],
];

/// Arrows that point down and are wrong all the same: from, to, and why.
const FORBIDDEN: &[(&str, &str, &str)] = &[
    (
        "pomona-cloud",
        "pomona-ransac",
        "clouds do not know what is being looked for",
    ),
    (
        "pomona-detect",
        "pomona-transforms",
        "the detector knows no robots",
    ),
    ("pomona-detect", "pomona-fit", "the detector knows no depth"),
    (
        "pomona-network",
        "pomona-fit",
        "a network knows pixels alone",
    ),
    (
        "pomona-network",
        "pomona-transforms",
        "a network knows pixels alone",
    ),
    ("pomona-view", "pomona-fit", "pictures know no algorithms"),
    (
        "pomona-view",
        "pomona-ransac",
        "pictures know no algorithms",
    ),
    (
        "pomona-cli",
        "pomona-fit",
        "the command line knows no algorithms",
    ),
    (
        "pomona-cli",
        "pomona-ransac",
        "the command line knows no algorithms",
    ),
];

/// The engine is for strangers: it brings nothing along but these,
/// and whoever holds its folder alone can build and test it.
pub(super) const ENGINE: &str = "pomona-ransac";
const ENGINE_NEEDS: [&str; 1] = ["rand_core"];
const ENGINE_MAY_WANT: [&str; 1] = ["rayon"];

/// The packages of these commands, which know the programs and no library.
const COMMANDS: [&str; 2] = ["xtask", GATE];
/// The regression gate, which tests of libraries hold against methods that are spoilt on purpose.
const GATE: &str = "xtask-gate";
/// What the commands may depend on: the gate, and the arithmetic of medians and intervals.
const COMMANDS_MAY_USE: [&str; 2] = [GATE, "pomona-statistics"];

pub(super) fn check(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &workspace.packages {
        for dependency in &package.dependencies {
            let fault = if workspace.package(&dependency.name).is_some() {
                arrow_between_ours(package, dependency)
            } else {
                arrow_out_of_engine(package, dependency)
            };
            findings.extend(fault.map(|(fault, remedy)| {
                Finding::new(place(workspace, package, &dependency.name), fault, remedy)
            }));
        }
        if layer(&package.name).is_none() && !COMMANDS.contains(&package.name.as_str()) {
            findings.push(Finding::new(
                workspace
                    .relative(&package.manifest_path)
                    .display()
                    .to_string(),
                format!("`{}` is in no layer", package.name),
                "give it its place in LAYERS in xtask/src/tidy/layers.rs",
            ));
        }
    }
    findings.extend(cycle(workspace).map(|names| {
        let package = workspace
            .package(&names[0])
            .expect("a cycle is made of packages");
        Finding::new(
            place(workspace, package, names.get(1).unwrap_or(&names[0])),
            format!("a cycle through dev-dependencies: {}", names.join(" → ")),
            "move the test to the uppermost of these crates",
        )
    }));
    findings
}

fn layer(name: &str) -> Option<usize> {
    LAYERS.iter().position(|names| names.contains(&name))
}

fn arrow_between_ours(package: &Package, dependency: &Dependency) -> Option<(String, String)> {
    let (from, to) = (package.name.as_str(), dependency.name.as_str());
    if COMMANDS.contains(&from) {
        if COMMANDS_MAY_USE.contains(&to) {
            return None;
        }
        let remedy = "run the program and read what it prints";
        return Some((format!("`{from}` depends on `{to}`"), remedy.into()));
    }
    if from == ENGINE {
        let remedy = "what needs both belongs above it, for instance in pomona-fit";
        return Some((format!("`{from}` depends on `{to}`"), remedy.into()));
    }
    if !dependency.is_normal() {
        return None;
    }
    if let Some((.., why)) = FORBIDDEN.iter().find(|(a, b, _)| (*a, *b) == (from, to)) {
        let remedy = format!("{why}: hand it what it needs as plain values");
        return Some((format!("`{from}` depends on `{to}`"), remedy));
    }
    let (upper, lower) = (layer(from)?, layer(to)?);
    (lower >= upper).then(|| {
        let remedy = "arrows point down only: move what is needed to a lower crate, \
                      or let a higher one join the two";
        (
            format!("`{from}` depends on `{to}`, which is not below it"),
            remedy.into(),
        )
    })
}

fn arrow_out_of_engine(package: &Package, dependency: &Dependency) -> Option<(String, String)> {
    let name = dependency.name.as_str();
    let allowed = ENGINE_NEEDS.contains(&name)
        || (ENGINE_MAY_WANT.contains(&name) && dependency.optional)
        || !dependency.is_normal();
    (package.name == ENGINE && !allowed).then(|| {
        let remedy = format!(
            "it may depend on {} and, optionally, on {}",
            ENGINE_NEEDS.join(", "),
            ENGINE_MAY_WANT.join(", ")
        );
        (format!("`{ENGINE}` depends on `{name}`"), remedy)
    })
}

/// Names along a cycle of dependencies of any kind, the first one twice.
fn cycle(workspace: &Workspace) -> Option<Vec<String>> {
    let mut done = Vec::new();
    workspace.packages.iter().find_map(|package| {
        let mut path = Vec::new();
        search(workspace, &package.name, &mut path, &mut done)
    })
}

fn search<'a>(
    workspace: &'a Workspace,
    name: &'a str,
    path: &mut Vec<&'a str>,
    done: &mut Vec<&'a str>,
) -> Option<Vec<String>> {
    if let Some(start) = path.iter().position(|seen| *seen == name) {
        let round = path[start..].iter().chain([&name]);
        return Some(round.map(ToString::to_string).collect());
    }
    let package = workspace.package(name).filter(|_| !done.contains(&name))?;
    path.push(name);
    for dependency in &package.dependencies {
        if let Some(found) = search(workspace, &dependency.name, path, done) {
            return Some(found);
        }
    }
    path.pop();
    done.push(name);
    None
}

/// The line of the manifest that names the dependency.
fn place(workspace: &Workspace, package: &Package, dependency: &str) -> String {
    let manifest = workspace.relative(&package.manifest_path);
    let text = fs::read_to_string(&package.manifest_path).unwrap_or_default();
    key_at(manifest, &text, dependency)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn package(name: &str, dependencies: &[(&str, Option<&str>)]) -> Package {
        let dependencies = dependencies.iter().map(|(name, kind)| Dependency {
            name: (*name).into(),
            rename: None,
            kind: kind.map(Into::into),
            optional: false,
            uses_default_features: true,
            features: Vec::new(),
        });
        Package {
            name: name.into(),
            manifest_path: format!("/nowhere/{name}/Cargo.toml").into(),
            dependencies: dependencies.collect(),
            targets: Vec::new(),
            features: BTreeMap::new(),
            publish: None,
            rust_version: None,
            description: None,
            keywords: Vec::new(),
            categories: Vec::new(),
            readme: None,
        }
    }

    fn faults(packages: Vec<Package>) -> Vec<String> {
        let workspace = Workspace::of(packages);
        check(&workspace)
            .into_iter()
            .map(|finding| finding.fault)
            .collect()
    }

    #[test]
    fn arrows_down_are_fine() {
        let fit = package("pomona-fit", &[("pomona-ransac", None), ("faer", None)]);
        assert!(faults(vec![package("pomona-ransac", &[]), fit]).is_empty());
    }

    #[test]
    fn arrows_up_and_sideways_are_not() {
        let scenes = package("pomona-scenes", &[("pomona", None)]);
        let cloud = package("pomona-cloud", &[("pomona-scenes", None)]);
        let found = faults(vec![package("pomona", &[]), scenes, cloud]);
        assert_eq!(
            found,
            [
                "`pomona-scenes` depends on `pomona`, which is not below it",
                "`pomona-cloud` depends on `pomona-scenes`, which is not below it",
            ]
        );
    }

    #[test]
    fn tests_may_look_up_but_not_in_circles() {
        let dev = Some("dev");
        let fit = package("pomona-fit", &[("pomona-scenes", dev)]);
        let scenes = package("pomona-scenes", &[("pomona-cloud", None)]);
        assert!(faults(vec![fit, scenes, package("pomona-cloud", &[])]).is_empty());

        let cloud = package("pomona-cloud", &[("pomona-scenes", dev)]);
        let scenes = package("pomona-scenes", &[("pomona-cloud", None)]);
        let found = faults(vec![cloud, scenes]);
        assert_eq!(
            found,
            ["a cycle through dev-dependencies: pomona-cloud → pomona-scenes → pomona-cloud"]
        );
    }

    #[test]
    fn the_engine_brings_little_along() {
        let engine = package("pomona-ransac", &[("rayon", None)]);
        assert_eq!(faults(vec![engine]), ["`pomona-ransac` depends on `rayon`"]);
        let mut engine = package("pomona-ransac", &[("rayon", None), ("rand_core", None)]);
        engine.dependencies[0].optional = true;
        assert!(faults(vec![engine]).is_empty());
        let engine = package("pomona-ransac", &[("pomona-geometry", Some("dev"))]);
        let found = faults(vec![engine, package("pomona-geometry", &[])]);
        assert_eq!(found, ["`pomona-ransac` depends on `pomona-geometry`"]);
    }

    #[test]
    fn what_must_not_be_known_and_who_has_no_place() {
        let view = package("pomona-view", &[("pomona-fit", None)]);
        let found = faults(vec![
            view,
            package("pomona-fit", &[]),
            package("pomona-new", &[]),
        ]);
        assert_eq!(
            found,
            [
                "`pomona-view` depends on `pomona-fit`",
                "`pomona-new` is in no layer"
            ]
        );
        let xtask = package("xtask", &[("pomona-cloud", Some("dev"))]);
        let found = faults(vec![xtask, package("pomona-cloud", &[])]);
        assert_eq!(found, ["`xtask` depends on `pomona-cloud`"]);
        let xtask = package("xtask", &[("xtask-gate", None)]);
        let gate = package("xtask-gate", &[("pomona-cloud", None)]);
        let found = faults(vec![xtask, gate, package("pomona-cloud", &[])]);
        assert_eq!(found, ["`xtask-gate` depends on `pomona-cloud`"]);
    }
}
