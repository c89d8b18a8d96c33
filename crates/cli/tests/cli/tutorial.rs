//! `docs/tutorial.md`, followed step by step: its files are written, its commands run, and what it says they print
//! and write is compared with what they do.
//!
//! A comment before a fenced block says what the block is: `<!-- file: NAME -->`, `<!-- step -->`,
//! `<!-- prints -->` or `<!-- writes -->`. In what is printed, `…` stands for anything.

use crate::binary::{Run, run};
use std::fs;
use std::path::Path;
use std::process::Command;

const TUTORIAL: &str = include_str!("../../../../docs/tutorial.md");
const FRAME: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../fixtures/frames/orchard-demo"
);

/// A fenced block.
#[derive(Debug, PartialEq)]
struct Block<'a> {
    /// What the comment before it says; empty where there is none.
    marker: &'a str,
    /// What follows the fence.
    language: &'a str,
    lines: Vec<&'a str>,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut blocks = Vec::new();
    let mut lines = page.lines();
    let mut marker = "";
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let lines = lines.by_ref().take_while(|line| *line != "```").collect();
            blocks.push(Block {
                marker,
                language,
                lines,
            });
        }
        let comment = line.strip_prefix("<!-- ");
        marker = comment
            .and_then(|c| c.strip_suffix(" -->"))
            .unwrap_or_default();
    }
    blocks
}

/// Runs `pomona ARGUMENTS [> FILE]` in `folder`.
fn command(line: &str, folder: &Path) -> Run {
    let (line, file) = line
        .split_once(" > ")
        .map_or((line, None), |(line, file)| (line, Some(file)));
    let mut words = line.split_whitespace();
    assert_eq!(words.next(), Some("pomona"), "{line}");
    let mut command = Command::new(env!("CARGO_BIN_EXE_pomona"));
    let run = run(command.args(words).current_dir(folder)).succeeded();
    if let Some(file) = file {
        fs::write(folder.join(file), &run.out).unwrap();
    }
    run
}

/// Whether `line` is what `pattern` says, but for the amount of white space and what its `…` stand for.
fn matches(pattern: &str, line: &str) -> bool {
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (pattern, line) = (words(pattern), words(line));
    let mut parts = pattern.split('…');
    let first = parts.next().unwrap_or_default();
    let Some(mut rest) = line.strip_prefix(first) else {
        return false;
    };
    let mut last = None;
    for part in parts {
        let Some(at) = rest.find(part) else {
            return false;
        };
        rest = &rest[at + part.len()..];
        last = Some(part);
    }
    rest.is_empty() || last == Some("")
}

#[test]
fn every_step_of_the_tutorial_does_what_the_page_says() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("my-frame")).unwrap();
    for image in ["color.png", "depth.png"] {
        fs::copy(
            Path::new(FRAME).join(image),
            folder.join("my-frame").join(image),
        )
        .unwrap();
    }
    let mut printed = String::new();
    let mut steps = 0;
    for block in blocks(TUTORIAL) {
        if let Some(name) = block.marker.strip_prefix("file: ") {
            fs::write(folder.join(name), block.lines.join("\n") + "\n").unwrap();
        } else if block.marker == "step" {
            let runs = block.lines.iter().map(|line| command(line, folder).out);
            printed = runs.collect();
            steps += 1;
        } else if block.marker == "prints" {
            for line in block.lines {
                let found = printed.lines().any(|out| matches(line, out));
                assert!(found, "the tutorial says\n{line}\nof\n{printed}");
            }
        } else if block.marker == "writes" {
            for name in block.lines {
                assert!(folder.join(name).is_file(), "{name} was not written");
            }
        } else {
            let unmarked = block.lines.iter().any(|line| line.starts_with("pomona "));
            assert!(!unmarked, "a command that nothing runs: {block:?}");
        }
    }
    assert!(steps >= 10, "{steps} steps are marked");
}

#[test]
fn blocks_come_with_their_markers() {
    let page = "text\n<!-- step -->\n```sh\na\nb\n```\n\n<!-- other -->\n\n```\nc\n```\n";
    let expected = [
        Block {
            marker: "step",
            language: "sh",
            lines: vec!["a", "b"],
        },
        Block {
            marker: "",
            language: "",
            lines: vec!["c"],
        },
    ];
    assert_eq!(blocks(page), expected);
}

#[test]
fn an_ellipsis_stands_for_anything_and_space_for_space() {
    for (pattern, line, expected) in [
        ("a b", " a   b ", true),
        ("a b", "a b c", false),
        ("a … c", "a b b c", true),
        ("a …", "a b c", true),
        ("a … c", "a b", false),
        ("b …", "a b", false),
    ] {
        assert_eq!(matches(pattern, line), expected, "{pattern} of {line}");
    }
}
