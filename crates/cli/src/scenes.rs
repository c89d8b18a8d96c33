use crate::progress;
use crate::summary::plural;
use crate::terminal;
use anyhow::bail;
use clap::Args;
use pomona_scenes::{Case, Suite};
use std::fmt::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  pomona scenes --list                        the available suites
  pomona scenes lab15 --list                  the scenes of one suite
  pomona scenes demo --out scenes             one frame of a tree: scenes/orchard-demo
  pomona scenes lab15 --out scenes --seed 3   another noise draw

Each scene is a frame folder with truth.json beside the images. A scene with the same name is replaced; a folder \
with any other file is refused.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ScenesArguments {
    /// Name of the suite.
    #[arg(value_name = "SUITE", required_unless_present = "list")]
    suite: Option<String>,
    /// Where to write the frame folders.
    #[arg(short, long, value_name = "DIR", required_unless_present = "list")]
    out: Option<PathBuf>,
    /// Added to the seed of each scene.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Only the first N scenes.
    #[arg(long, value_name = "N")]
    count: Option<usize>,
    /// List the suites, or the scenes of SUITE, and write nothing.
    #[arg(long)]
    list: bool,
}

pub(crate) fn run(arguments: &ScenesArguments) -> anyhow::Result<()> {
    let Some(name) = &arguments.suite else {
        return terminal::print(&suite_list());
    };
    let suite = Suite::named(name)?;
    let cases: Vec<Case> = suite
        .cases()
        .take(arguments.count.unwrap_or(usize::MAX))
        .map(|case| reseeded(case, arguments.seed))
        .collect();
    if arguments.list {
        return terminal::print(
            &cases
                .iter()
                .map(|c| c.name.clone() + "\n")
                .collect::<String>(),
        );
    }
    let Some(out) = &arguments.out else {
        bail!("no folder to write to; name one by --out DIR");
    };
    let bar = progress::bar(cases.len());
    for case in &cases {
        bar.set_message(case.name.clone());
        let start = std::time::Instant::now();
        case.scene().write(out.join(&case.name))?;
        log::info!("{}: made and written in {:.0?}", case.name, start.elapsed());
        bar.inc(1);
    }
    bar.finish_and_clear();
    terminal::print(&format!(
        "{} written to {}\n",
        plural(cases.len(), "scene"),
        out.display()
    ))
}

/// The suites and their sizes, in columns.
fn suite_list() -> String {
    let width = Suite::ALL.iter().map(|s| s.name().len()).max().unwrap_or(0);
    let mut list = String::new();
    for suite in Suite::ALL {
        let scenes = plural(suite.len(), "scene");
        // Writing to a string cannot fail.
        let _ = writeln!(list, "{:<width$}  {scenes}", suite.name());
    }
    list
}

/// The case with another seed, which its name shows, so that several draws fit in one folder.
fn reseeded(mut case: Case, more: u64) -> Case {
    if more > 0 {
        let seed = case.seed.wrapping_add(more);
        let old = format!("-s{}", case.seed);
        let stem = case.name.strip_suffix(&old).unwrap_or(&case.name);
        case.name = format!("{stem}-s{seed}");
        case.seed = seed;
    }
    case
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_the_list_are_apart() {
        for line in suite_list().lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            assert!(Suite::named(words[0]).is_ok(), "{line}");
            assert!(words[1].parse::<usize>().is_ok(), "{line}");
        }
    }

    #[test]
    fn a_seed_shows_in_the_name() {
        let case = Suite::ALL[0].cases().next().unwrap();
        assert_eq!(reseeded(case.clone(), 0), case);
        let other = reseeded(case.clone(), 5);
        assert_eq!(other.seed, case.seed + 5);
        assert!(
            other.name.ends_with(&format!("-s{}", other.seed)),
            "{}",
            other.name
        );
        assert!(!other.name.contains("-s0-"), "{}", other.name);
    }
}
