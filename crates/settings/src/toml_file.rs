//! Settings as a commented TOML file.

use crate::{Description, Kind, Setting, Settings};
use std::fmt::Write;
use toml::{Table, Value};

/// Columns of a comment.
const WIDTH: usize = 96;

impl Description {
    /// `settings` as TOML, each under a comment with its meaning, unit, default and rules. Reading it gives the same
    /// settings. What is left out stands there as a comment.
    /// `about` stands at the head.
    pub fn toml<T: Settings>(&self, about: &str, settings: &T) -> String {
        // Settings are numbers, words, flags and lists of numbers, in tables: nothing that TOML has no form for.
        let values = Table::try_from(settings).unwrap_or_default();
        let mut text = wrapped(about) + "\n";
        let mut section = "";
        for setting in &self.settings {
            let (own_section, name) = setting.section_and_name();
            if own_section != section {
                section = own_section;
                let meaning = self.sections.iter().find(|s| s.path == section);
                let meaning = meaning.map_or("", |s| &s.meaning);
                let gap = if text.ends_with("\n\n") { "" } else { "\n" };
                // Writing to a string cannot fail, here and below.
                let _ = write!(text, "{gap}{}[{section}]\n\n", wrapped(meaning));
            }
            let comment = wrapped(&explained(setting));
            let line = match (look_up(&values, &setting.path), &setting.example) {
                (Some(value), _) => format!("{name} = {value}"),
                (None, Some(example)) => format!("# {name} = {example}"),
                (None, None) => format!("# {name} ="),
            };
            let _ = writeln!(text, "{comment}{line}");
        }
        text
    }
}

fn look_up<'t>(table: &'t Table, path: &str) -> Option<&'t Value> {
    match path.split_once('.') {
        Some((section, rest)) => look_up(table.get(section)?.as_table()?, rest),
        None => table.get(path),
    }
}

/// What stands above a setting.
fn explained(setting: &Setting) -> String {
    let mut text = setting.meaning.clone();
    if let Kind::Choice(choices) = setting.kind {
        for choice in choices {
            let _ = write!(text, " {}: {}", choice.name, choice.meaning());
        }
    }
    let _ = write!(text, " Unit: {}; ", setting.unit);
    let _ = match &setting.default {
        Some(default) => write!(text, "default {default}"),
        None => write!(text, "may be left out"),
    };
    if let Some(rules) = setting.rules() {
        let _ = write!(text, "; {rules}");
    }
    text.push('.');
    text
}

/// `words` as comment lines.
fn wrapped(words: &str) -> String {
    let mut text = String::new();
    let mut line = String::from("#");
    for word in words.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > WIDTH {
            text.push_str(&line);
            text.push('\n');
            line = String::from("#");
        }
        line.push(' ');
        line.push_str(word);
    }
    text + &line + "\n"
}
