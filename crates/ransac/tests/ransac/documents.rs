//! What the pages beside the code say is what the code says.

use std::path::{Path, PathBuf};
use std::{fs, io};

const SETTINGS: &str = include_str!("../../docs/settings.md");
const GUIDE: &str = include_str!("../../docs/own-estimator.md");
const QUOTED: &str = include_str!("../../examples/circle_2d.rs");
const FRONT_PAGE: &str = include_str!("../../src/lib.rs");

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Whether the settings name this, and not as a part of a longer name.
fn named(name: &str) -> bool {
    SETTINGS.match_indices(name).any(|(at, _)| {
        let before = SETTINGS[..at].chars().next_back();
        let after = SETTINGS[at + name.len()..].chars().next();
        !before.is_some_and(is_word) && !after.is_some_and(is_word)
    })
}

#[test]
fn every_public_type_is_in_the_settings() {
    let exports = FRONT_PAGE.split("pub use ").skip(1);
    let names: Vec<&str> = exports
        .filter_map(|rest| rest.split_once(';')?.0.split_once("::"))
        .flat_map(|(_, names)| names.split(|c| !is_word(c)))
        .filter(|name| !name.is_empty())
        .collect();
    assert!(names.len() > 50, "the exports are read wrongly: {names:?}");
    let missing: Vec<&&str> = names.iter().filter(|name| !named(name)).collect();
    assert!(missing.is_empty(), "docs/settings.md lacks {missing:?}");
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            sources(&path, found)?;
        } else {
            found.push(path);
        }
    }
    Ok(())
}

/// Functions that take settings: they give what they belong to, or a part that holds it.
#[test]
fn every_builder_is_in_the_settings() {
    let mut paths = Vec::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    sources(&folder, &mut paths).unwrap();
    let mut builders = 0;
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or("");
        for function in code.split("pub fn ").skip(1) {
            let signature = function.split('{').next().unwrap_or("");
            let name = signature.split(|c| !is_word(c)).next().unwrap_or("");
            let result = signature.split_once("->").map_or("", |(_, result)| result);
            let builds = ["Self", "Result<Self", "Ransac<", "Local<"]
                .iter()
                .any(|start| result.trim_start().starts_with(start));
            // What gives something back for the caller's use is no setting.
            if builds && !["scaled"].contains(&name) {
                builders += 1;
                assert!(
                    named(name),
                    "docs/settings.md lacks `{name}` of {}",
                    path.display()
                );
            }
        }
    }
    assert!(builders > 30, "the sources are read wrongly: {builders}");
}

/// Every block of Rust in the guide stands in the example word for word, indentation aside.
#[test]
fn the_guide_quotes_the_example() {
    let lines = |text: &str| -> Vec<String> {
        let trimmed = text.lines().map(|line| line.trim().to_owned());
        trimmed.filter(|line| !line.is_empty()).collect()
    };
    let example = lines(QUOTED);
    let blocks: Vec<&str> = GUIDE
        .split("```rust,ignore\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .collect();
    assert!(blocks.len() > 8, "the guide is read wrongly");
    for block in blocks {
        // Blocks may leave things out between paragraphs, not within.
        for paragraph in block.split("\n\n") {
            let quoted = lines(paragraph);
            let found = example
                .windows(quoted.len())
                .any(|window| window == quoted.as_slice());
            assert!(found, "not in examples/circle_2d.rs:\n{paragraph}");
        }
    }
}
