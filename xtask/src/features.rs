//! Which selections of packages and features together build every package without features and with each alone.
//!
//! Packages are taken together as far as none turns features of another on: what they share is compiled once.
//! With all features the workspace is built as a whole.

use crate::workspace::{Package, Workspace};

/// Arguments for cargo, one selection each.
pub(crate) fn selections(workspace: &Workspace) -> Vec<String> {
    let mut groups: Vec<Vec<&Package>> = Vec::new();
    for package in workspace
        .packages
        .iter()
        .filter(|p| p.own_features().next().is_some())
    {
        let apart = |other: &&Package| {
            turns_on(workspace, package, other) || turns_on(workspace, other, package)
        };
        match groups.iter_mut().find(|group| !group.iter().any(apart)) {
            Some(group) => group.push(package),
            None => groups.push(vec![package]),
        }
    }
    let mut selections = Vec::new();
    for group in groups {
        selections.push(selection(&group, &[]));
        // A package's only feature is all that it has.
        let several = group.iter().filter(|p| p.own_features().count() > 1);
        let several: Vec<&Package> = several.copied().collect();
        for round in 0.. {
            let with = several
                .iter()
                .filter_map(|p| Some((*p, p.own_features().nth(round)?)));
            let (packages, features): (Vec<&Package>, Vec<String>) = with
                .map(|(package, feature)| (package, format!("{}/{feature}", package.name)))
                .unzip();
            if packages.is_empty() {
                break;
            }
            selections.push(selection(&packages, &features));
        }
    }
    selections
}

fn selection(packages: &[&Package], features: &[String]) -> String {
    let mut arguments: Vec<String> = packages
        .iter()
        .map(|package| format!("--package {}", package.name))
        .collect();
    arguments.push("--no-default-features".to_owned());
    if !features.is_empty() {
        arguments.push(format!("--features {}", features.join(",")));
    }
    arguments.join(" ")
}

/// Does building `package` without features turn features of `other` on?
fn turns_on(workspace: &Workspace, package: &Package, other: &Package) -> bool {
    package
        .dependencies
        .iter()
        .filter(|d| d.is_normal())
        .any(|dependency| {
            if dependency.name == other.name {
                let default = other
                    .features
                    .get("default")
                    .is_some_and(|features| !features.is_empty());
                return !dependency.features.is_empty()
                    || dependency.uses_default_features && default;
            }
            workspace
                .package(&dependency.name)
                .is_some_and(|between| turns_on(workspace, between, other))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(json: &str) -> Package {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn packages_share_a_selection_unless_one_turns_features_of_another_on() {
        let dependency = |name: &str, features: &str| {
            format!(
                r#"{{"name": "{name}", "rename": null, "kind": null, "optional": false,
                    "uses_default_features": false, "features": [{features}]}}"#
            )
        };
        let of = |name: &str, dependencies: &str, features: &str| {
            package(&format!(
                r#"{{"name": "{name}", "manifest_path": "/x/Cargo.toml", "dependencies": [{dependencies}],
                    "targets": [], "features": {{{features}}}}}"#
            ))
        };
        let two = r#""default": ["a"], "a": [], "b": []"#;
        let one = r#""c": []"#;
        let workspace = Workspace::of(vec![
            of("network", "", two),
            of("core", &dependency("network", ""), one),
            of("plain", "", ""),
            of(
                "program",
                &[dependency("core", ""), dependency("network", r#""a""#)].join(","),
                r#""d": []"#,
            ),
        ]);
        assert_eq!(
            selections(&workspace),
            [
                "--package network --package core --no-default-features",
                "--package network --no-default-features --features network/a",
                "--package network --no-default-features --features network/b",
                "--package program --no-default-features",
            ]
        );
    }
}
