//! The modules of a crate form no circle.

use super::{
    exceptions::CRATES_WITH_CIRCLES,
    finding::{Finding, at},
};
use crate::{
    modules::{Arrow, Crate, arrows, circles},
    source::Source,
    workspace::Workspace,
};
use anyhow::Result;

const REMEDY: &str = "move what both need into a module below both, or hand it over as a value";

pub(super) fn check(workspace: &Workspace, sources: &[Source]) -> Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for package in &workspace.packages {
        let mut own = Vec::new();
        for root in package.roots() {
            let tree = Crate::of(workspace.relative(root), sources)?;
            own.extend(
                circles(&arrows(&tree))
                    .iter()
                    .map(|circle| finding(&tree, circle)),
            );
        }
        match (
            own.is_empty(),
            CRATES_WITH_CIRCLES.contains(&package.name.as_str()),
        ) {
            (_, false) => findings.extend(own),
            (false, true) => {}
            (true, true) => findings.push(Finding::new(
                workspace
                    .relative(&package.manifest_path)
                    .display()
                    .to_string(),
                format!(
                    "`{}` is listed as a crate with circles and has none",
                    package.name
                ),
                "remove it from CRATES_WITH_CIRCLES in xtask/src/tidy/exceptions.rs",
            )),
        }
    }
    Ok(findings)
}

fn finding(tree: &Crate, circle: &[&Arrow]) -> Finding {
    let place = |arrow: &Arrow| at(&tree.modules[arrow.from].file, arrow.line);
    let steps: Vec<String> = circle
        .iter()
        .map(|arrow| {
            let (from, to) = (tree.name(arrow.from), tree.name(arrow.to));
            format!("`{from}` → `{to}` ({})", place(arrow))
        })
        .collect();
    let first = circle
        .first()
        .map_or_else(String::new, |arrow| place(arrow));
    Finding::new(
        first,
        format!("modules in a circle: {}", steps.join(", ")),
        REMEDY,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_told_with_the_places_of_its_arrows() {
        let source = |path: &str, text: &str| Source {
            path: path.into(),
            text: text.into(),
        };
        let sources = [
            source(
                "x/src/lib.rs",
                "mod apple;\nmod branch;\npub use apple::Apple;\n",
            ),
            source(
                "x/src/apple.rs",
                "use crate::branch::Branch;\n\npub struct Apple;\n",
            ),
            source(
                "x/src/branch.rs",
                "\nuse crate::{Apple};\npub struct Branch;\n",
            ),
        ];
        let tree = Crate::of("x/src/lib.rs".as_ref(), &sources).unwrap();
        let arrows = arrows(&tree);
        let circles = circles(&arrows);
        assert_eq!(circles.len(), 1);
        assert_eq!(
            finding(&tree, &circles[0]).to_string(),
            "x/src/apple.rs:1: modules in a circle: `apple` → `branch` (x/src/apple.rs:1), \
             `branch` → `apple` (x/src/branch.rs:2)\n    \
             move what both need into a module below both, or hand it over as a value"
        );
    }
}
