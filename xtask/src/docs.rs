//! `cargo xtask docs`: what README and docs show of the program's output is what the program prints.
//!
//! Marked regions of the Markdown files are filled with the output of a command, with a figure of a golden run or of
//! `docs/figures.toml`; pictures that a command makes are made. `--check` compares and changes nothing.

mod directive;
mod figures;
mod json;
mod outputs;
mod regions;
mod text;

use crate::{
    program::{Build, Program},
    workspace::root,
};
use anyhow::{Context, Result, bail};
use figures::Figures;
use outputs::Outputs;
use regions::{Kind, Region};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Where Markdown with regions may lie: files, and folders with all that is in them.
const PLACES: [&str; 3] = ["README.md", "docs", "crates"];

/// Whether to write.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Only compare; an error where anything differs
    #[arg(long)]
    check: bool,
    /// How the program is compiled
    #[arg(long, value_enum, default_value_t)]
    build: Build,
}

impl Args {
    /// What `cargo xtask ci` asks for.
    pub(crate) const CHECK: Self = Self {
        check: true,
        build: Build::Tested,
    };
}

/// Fills the regions, or says which are out of date.
pub(crate) fn run(args: &Args) -> Result<()> {
    let program = Program::build(args.build)?;
    let mut filler = Filler {
        figures: Figures::read(root())?,
        outputs: Outputs::new(program)?,
        pictures: Vec::new(),
    };
    let mut differences = Vec::new();
    let (mut files, mut count) = (0, 0);
    for path in markdown(root())? {
        let text = fs::read_to_string(root().join(&path))
            .with_context(|| format!("cannot read {}", path.display()))?;
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        let mut regions = 0;
        let new = regions::fill(&text, &mut |region| {
            regions += 1;
            let place = format!("{}:{}", path.display(), region.line);
            filler.fill(&folder, region).context(place)
        })
        .with_context(|| path.display().to_string())?;
        files += usize::from(regions > 0);
        count += regions;
        if new != text {
            differences.push(first_difference(&path, &text, &new));
            if !args.check {
                fs::write(root().join(&path), new)
                    .with_context(|| format!("cannot write {}", path.display()))?;
            }
        }
    }
    for (made, kept) in filler.pictures {
        let bytes = fs::read(&made).with_context(|| format!("no {}", made.display()))?;
        if fs::read(root().join(&kept)).ok().as_ref() != Some(&bytes) {
            differences.push(format!("{}: another picture", kept.display()));
            if !args.check {
                fs::write(root().join(&kept), bytes)
                    .with_context(|| format!("cannot write {}", kept.display()))?;
            }
        }
    }
    for difference in &differences {
        println!("{difference}");
    }
    if args.check && !differences.is_empty() {
        bail!(
            "docs: {} out of date; `cargo xtask docs` writes them anew",
            differences.len()
        );
    }
    println!(
        "docs: {count} regions in {files} files, {} renewed",
        differences.len()
    );
    Ok(())
}

/// What fills the regions.
struct Filler {
    figures: Figures,
    outputs: Outputs,
    /// Pictures made, and where in the repository each belongs.
    pictures: Vec<(PathBuf, PathBuf)>,
}

impl Filler {
    /// `folder`: that of the Markdown file, relative to the root.
    fn fill(&mut self, folder: &Path, region: &Region) -> Result<String> {
        match region.kind {
            Kind::Figure => self.figures.text(region.directive),
            Kind::Output => self.outputs.text(region.directive),
            Kind::Picture => {
                let made = self.outputs.file(region.directive)?;
                let kept = folder.join(linked_picture(region.body)?);
                self.pictures.push((made, kept));
                Ok(region.body.to_owned())
            }
        }
    }
}

/// The path in `![text](path)`.
fn linked_picture(body: &str) -> Result<&str> {
    let path = || {
        let (_, link) = body.split_once("](")?;
        link.split_once(')').map(|(path, _)| path)
    };
    path().context("write `![text](path)` between the two markers")
}

/// The Markdown files, relative to the root, in their order.
fn markdown(root: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut open: Vec<PathBuf> = PLACES.iter().map(PathBuf::from).collect();
    while let Some(path) = open.pop() {
        let full = root.join(&path);
        if full.is_dir() {
            let entries =
                fs::read_dir(&full).with_context(|| format!("cannot list {}", path.display()))?;
            for entry in entries {
                let name = entry?.file_name();
                if name != "target" {
                    open.push(path.join(name));
                }
            }
        } else if path.extension().is_some_and(|extension| extension == "md") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn first_difference(path: &Path, old: &str, new: &str) -> String {
    let pairs = old.lines().zip(new.lines());
    let same = pairs.take_while(|(old, new)| old == new).count();
    let line = |text: &str| text.lines().nth(same).unwrap_or("(end)").to_owned();
    format!(
        "{}:{}:\n    is     {}\n    should {}",
        path.display(),
        same + 1,
        line(old),
        line(new)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_told_by_its_line() {
        let told = first_difference(Path::new("README.md"), "a\nb\nc\n", "a\nx\nc\n");
        assert_eq!(told, "README.md:2:\n    is     b\n    should x");
        let told = first_difference(Path::new("README.md"), "a\n", "a\nb\n");
        assert!(told.contains("(end)"), "{told}");
    }

    #[test]
    fn the_picture_stands_in_the_link() {
        assert_eq!(
            linked_picture("![A tree.](images/a.png)\n").unwrap(),
            "images/a.png"
        );
        assert!(linked_picture("no picture\n").is_err());
    }
}
