//! The arrows between a crate's modules.

use super::{
    resolve::Target,
    tree::{Crate, Module},
};
use std::collections::BTreeMap;

/// The first module names something that the second defines.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Arrow {
    pub from: usize,
    pub to: usize,
    /// The first line of `from` that does so.
    pub line: usize,
}

/// One arrow for each pair of modules, in their order. A module without a file of its own counts as its file's.
///
/// What a library's root re-exports is no arrow: the root is the list of what there is, and whoever uses a name of that
/// list points at the module that defines it.
pub(crate) fn arrows(tree: &Crate) -> Vec<Arrow> {
    let mut lines: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (from, module) in tree.modules.iter().enumerate() {
        for (to, line) in targets(tree, from, module) {
            let (from, to) = (module.node, tree.modules[to].node);
            if to != from {
                let first = lines.entry((from, to)).or_insert(line);
                *first = line.min(*first);
            }
        }
    }
    let arrow = |((from, to), line)| Arrow { from, to, line };
    lines.into_iter().map(arrow).collect()
}

fn targets(tree: &Crate, from: usize, module: &Module) -> Vec<(usize, usize)> {
    let is_root = module.parent.is_none();
    let mut found = Vec::new();
    for import in &module.scan.imports {
        if is_root && import.is_export {
            continue;
        }
        let path = &import.path;
        let target = match import.name {
            Some(_) => tree.resolve(from, &path.segments),
            None => tree.resolve_module(from, &path.segments),
        };
        match target {
            Some(Target::Item(to)) => found.push((to, path.line)),
            // A module's bare name brings nothing in; `*` does.
            Some(Target::Module(to)) if import.name.is_none() => found.push((to, path.line)),
            _ => {}
        }
    }
    for path in &module.scan.paths {
        if let Some(Target::Item(to)) = tree.resolve(from, &path.segments) {
            found.push((to, path.line));
        }
    }
    found
}
