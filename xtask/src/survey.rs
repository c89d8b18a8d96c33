//! `cargo xtask survey`: how large each crate is, and how its modules hang together.

use crate::{
    modules::{Crate, arrows, circles, on_circles},
    source::{self, Source},
    workspace::{Package, Workspace},
};
use anyhow::{Context, Result};
use std::path::PathBuf;

/// What to look at.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Another checkout of the repository
    #[arg(long, value_name = "FOLDER")]
    root: Option<PathBuf>,
    /// Name every arrow that lies on a circle
    #[arg(long)]
    circles: bool,
}

/// The columns of the table.
const HEADER: &str = "| crate | files | lines | public items | exports | `allow` | modules | arrows | back up | circles |\n\
                      |---|---|---|---|---|---|---|---|---|---|";

/// One row. Tests, benches and examples count among files, lines and `allow`, not in the other columns.
#[derive(Default)]
struct Row {
    files: usize,
    lines: usize,
    /// Items declared `pub`, methods included, fields not.
    public_items: usize,
    /// Names that the library's root re-exports.
    exports: usize,
    allows: usize,
    modules: usize,
    arrows: usize,
    /// Arrows whose target depends, by whatever way, on their source.
    back_up: usize,
    circles: usize,
}

/// Prints the table, in Markdown.
pub(crate) fn run(args: &Args) -> Result<()> {
    let root = match &args.root {
        Some(root) => root
            .canonicalize()
            .with_context(|| root.display().to_string())?,
        None => crate::workspace::root().to_path_buf(),
    };
    let workspace = Workspace::read_at(&root)?;
    let sources = source::read_all(&root)?;
    println!("{HEADER}");
    let mut total = Row::default();
    for package in &workspace.packages {
        let row = row(&workspace, package, &sources, args.circles)?;
        println!("{}", row.line(&format!("`{}`", package.name)));
        total.add(&row);
    }
    println!("{}", total.line("all"));
    Ok(())
}

fn row(workspace: &Workspace, package: &Package, sources: &[Source], named: bool) -> Result<Row> {
    let folder = workspace.relative(package.folder());
    let mut row = Row::default();
    for source in sources
        .iter()
        .filter(|s| s.is_rust() && s.path.starts_with(folder))
    {
        row.files += 1;
        row.lines += source.text.lines().count();
        let is_allow = |line: &str| line.contains("#[allow(") || line.contains("#![allow(");
        row.allows += source.text.lines().filter(|line| is_allow(line)).count();
    }
    for root in package.roots() {
        let tree = Crate::of(workspace.relative(root), sources)?;
        let arrows = arrows(&tree);
        let back_up = on_circles(&arrows);
        for arrow in back_up.iter().filter(|_| named) {
            let (from, to) = (tree.name(arrow.from), tree.name(arrow.to));
            let file = tree.modules[arrow.from].file.display();
            eprintln!("{}: {from} → {to} ({file}:{})", package.name, arrow.line);
        }
        row.public_items += tree.public_items();
        row.exports += tree.exports();
        row.modules += tree.modules.len();
        row.arrows += arrows.len();
        row.back_up += back_up.len();
        row.circles += circles(&arrows).len();
    }
    Ok(row)
}

impl Row {
    fn cells(&self) -> [usize; 9] {
        [
            self.files,
            self.lines,
            self.public_items,
            self.exports,
            self.allows,
            self.modules,
            self.arrows,
            self.back_up,
            self.circles,
        ]
    }

    fn line(&self, name: &str) -> String {
        let cells = self.cells().map(|cell| cell.to_string());
        format!("| {name} | {} |", cells.join(" | "))
    }

    fn add(&mut self, other: &Self) {
        self.files += other.files;
        self.lines += other.lines;
        self.public_items += other.public_items;
        self.exports += other.exports;
        self.allows += other.allows;
        self.modules += other.modules;
        self.arrows += other.arrows;
        self.back_up += other.back_up;
        self.circles += other.circles;
    }
}
