//! A crate's modules, read from its root file on.

use super::scan::Scan;
use crate::source::Source;
use anyhow::{Context, Result, anyhow};
use proc_macro2::TokenStream;
use std::path::{Path, PathBuf};

/// The modules of a library or a program.
pub(crate) struct Crate {
    /// The root first, each module before those inside it.
    pub modules: Vec<Module>,
}

/// One module.
pub(crate) struct Module {
    /// `detection::record`; empty for the root.
    pub name: String,
    pub file: PathBuf,
    /// The module whose file it stands in: itself, if it has one of its own.
    pub(super) node: usize,
    pub(super) parent: Option<usize>,
    pub(super) children: Vec<(String, usize)>,
    pub(super) scan: Scan,
}

impl Crate {
    /// Reads the root file and every file that it declares; `read` gives a file's text, or nothing where there is
    /// no such file.
    fn read(root: &Path, read: &dyn Fn(&Path) -> Option<String>) -> Result<Self> {
        let text = read(root).with_context(|| format!("cannot read {}", root.display()))?;
        let folder = root.parent().unwrap_or(root).to_path_buf();
        let mut tree = Self {
            modules: Vec::new(),
        };
        let place = Place {
            name: String::new(),
            file: root.to_path_buf(),
            folder,
            node: None,
            parent: None,
        };
        tree.add(&place, parse(root, &text)?, read)?;
        Ok(tree)
    }

    /// Reads from files that are in memory.
    pub(crate) fn of(root: &Path, sources: &[Source]) -> Result<Self> {
        let text = |path: &Path| {
            let source = sources.iter().find(|source| source.path == path)?;
            Some(source.text.clone())
        };
        Self::read(root, &text)
    }

    /// The module as code names it.
    pub(crate) fn name(&self, module: usize) -> &str {
        match self.modules[module].name.as_str() {
            "" => "crate",
            name => name,
        }
    }

    /// Items declared `pub`, methods included, fields not.
    pub(crate) fn public_items(&self) -> usize {
        self.modules
            .iter()
            .map(|module| module.scan.public_items)
            .sum()
    }

    /// Names that the root re-exports.
    pub(crate) fn exports(&self) -> usize {
        let imports = self.modules.first().map(|root| root.scan.imports.iter());
        imports
            .into_iter()
            .flatten()
            .filter(|import| import.is_export)
            .count()
    }

    fn add(
        &mut self,
        place: &Place,
        tokens: TokenStream,
        read: &dyn Fn(&Path) -> Option<String>,
    ) -> Result<usize> {
        let id = self.modules.len();
        let mut scan = Scan::of(tokens);
        let children = std::mem::take(&mut scan.children);
        self.modules.push(Module {
            name: place.name.clone(),
            file: place.file.clone(),
            node: place.node.unwrap_or(id),
            parent: place.parent,
            children: Vec::new(),
            scan,
        });
        for child in children {
            let folder = place.folder.join(&child.name);
            let (file, tokens, node) = if let Some(body) = child.body {
                (place.file.clone(), body, Some(self.modules[id].node))
            } else {
                let mut files = [folder.with_extension("rs"), folder.join("mod.rs")].into_iter();
                let found = files.find_map(|file| read(&file).map(|text| (file, text)));
                let (file, text) = found.with_context(|| {
                    format!("{}: no file for `mod {}`", place.file.display(), child.name)
                })?;
                let tokens = parse(&file, &text)?;
                (file, tokens, None)
            };
            let separator = if place.name.is_empty() { "" } else { "::" };
            let inner = Place {
                name: format!("{}{separator}{}", place.name, child.name),
                file,
                folder,
                node,
                parent: Some(id),
            };
            let child_id = self.add(&inner, tokens, read)?;
            self.modules[id].children.push((child.name, child_id));
        }
        Ok(id)
    }
}

/// Where a module is.
struct Place {
    name: String,
    file: PathBuf,
    /// Where the files of the modules inside it lie.
    folder: PathBuf,
    /// The module whose file it stands in, if it has none of its own.
    node: Option<usize>,
    parent: Option<usize>,
}

fn parse(file: &Path, text: &str) -> Result<TokenStream> {
    text.parse()
        .map_err(|error| anyhow!("{}: {error}", file.display()))
}
