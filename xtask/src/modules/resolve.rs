//! Which module defines what a path names.

use super::tree::Crate;

/// What a path leads to within the crate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
    Module(usize),
    /// Something that this module defines.
    Item(usize),
}

/// Names that are being looked up, so that re-exports in a ring come to an end.
type Pending = Vec<(usize, String, bool)>;

impl Crate {
    /// What the path leads to when the module `from` writes it; nothing where it leads out of the crate.
    pub(super) fn resolve(&self, from: usize, segments: &[String]) -> Option<Target> {
        self.follow(from, segments, false, &mut Vec::new())
    }

    /// The module that a path names, for `use path::*`.
    pub(super) fn resolve_module(&self, from: usize, segments: &[String]) -> Option<Target> {
        self.follow(from, segments, true, &mut Vec::new())
    }

    /// `as_module`: of a module and a function of the same name, the module is meant.
    fn follow(
        &self,
        from: usize,
        segments: &[String],
        as_module: bool,
        pending: &mut Pending,
    ) -> Option<Target> {
        let (first, mut rest) = segments.split_first()?;
        let mut at = match first.as_str() {
            "crate" => 0,
            "self" => from,
            "super" => self.modules[from].parent?,
            name => {
                let leads_on = as_module || !rest.is_empty();
                match self.look_up(from, name, leads_on, pending)? {
                    Target::Module(module) => module,
                    item @ Target::Item(_) => return Some(item),
                }
            }
        };
        while let Some((name, more)) = rest.split_first() {
            if name == "super" {
                at = self.modules[at].parent?;
            } else {
                let leads_on = as_module || !more.is_empty();
                match self.look_up(at, name, leads_on, pending) {
                    Some(Target::Module(module)) => at = module,
                    Some(item @ Target::Item(_)) => return Some(item),
                    // What a macro defined there, if the name is not brought in from elsewhere.
                    None => {
                        let imports = &self.modules[at].scan.imports;
                        let foreign = imports.iter().any(|i| i.name.as_ref() == Some(name));
                        return (!foreign).then_some(Target::Item(at));
                    }
                }
            }
            rest = more;
        }
        Some(Target::Module(at))
    }

    fn look_up(
        &self,
        module: usize,
        name: &str,
        as_module: bool,
        pending: &mut Pending,
    ) -> Option<Target> {
        let key = (module, name.to_owned(), as_module);
        if pending.contains(&key) {
            return None;
        }
        pending.push(key);
        let found = self.candidates(module, name, as_module, pending);
        pending.pop();
        let preferred = |target: &&Target| matches!(target, Target::Module(_)) == as_module;
        found.iter().find(preferred).or(found.first()).copied()
    }

    /// Everything that has this name in the module; a name brought in by `*` only where there is no other.
    fn candidates(
        &self,
        module: usize,
        name: &str,
        as_module: bool,
        pending: &mut Pending,
    ) -> Vec<Target> {
        let here = &self.modules[module];
        let child = here.children.iter().find(|(child, _)| child == name);
        let mut found: Vec<Target> = child
            .map(|(_, id)| Target::Module(*id))
            .into_iter()
            .collect();
        if here.scan.items.iter().any(|item| item == name) {
            found.push(Target::Item(module));
        }
        for import in &here.scan.imports {
            if import.name.as_deref() == Some(name) {
                let segments = &import.path.segments;
                found.extend(self.follow(module, segments, as_module, pending));
            }
        }
        if found.is_empty() {
            for import in here.scan.imports.iter().filter(|i| i.name.is_none()) {
                let source = self.follow(module, &import.path.segments, true, pending);
                if let Some(Target::Module(source)) = source {
                    found.extend(self.look_up(source, name, as_module, pending));
                }
            }
        }
        found
    }
}
