//! Settings as Markdown tables.

use crate::{Description, Kind, Setting};
use std::fmt::Write;

const HEAD: &str = "| setting | default | unit | allowed | meaning |\n|---|---|---|---|---|\n";

impl Description {
    /// The settings as Markdown: a table for those without a section, and a heading with a table for each section.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        let top: Vec<&Setting> = self.in_section("").collect();
        if !top.is_empty() {
            text.push_str(&table(top.into_iter()));
        }
        for section in &self.sections {
            let gap = if text.is_empty() { "" } else { "\n" };
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "{gap}### `[{}]`\n\n{}\n\n",
                section.path, section.meaning
            );
            text.push_str(&table(self.in_section(&section.path)));
        }
        text
    }

    fn in_section<'s>(&'s self, section: &'s str) -> impl Iterator<Item = &'s Setting> {
        let inside = move |s: &&Setting| s.section_and_name().0 == section;
        self.settings.iter().filter(inside)
    }
}

fn table<'s>(settings: impl Iterator<Item = &'s Setting>) -> String {
    settings.fold(HEAD.to_owned(), |mut text, setting| {
        let default = setting.default.as_ref();
        let default = default.map_or_else(|| "left out".to_owned(), |d| format!("`{d}`"));
        let allowed = match setting.kind {
            Kind::Flag => "`true`, `false`".to_owned(),
            Kind::Choice(choices) => {
                let names: Vec<String> = choices.iter().map(|c| format!("`{}`", c.name)).collect();
                names.join(", ")
            }
            Kind::Count | Kind::Number | Kind::Numbers(_) => setting.rules().unwrap_or_default(),
        };
        let (_, name) = setting.section_and_name();
        let cells = [
            format!("`{name}`"),
            default,
            setting.unit.to_owned(),
            allowed,
            setting.meaning.clone(),
        ];
        let cells = cells.map(|cell| cell.replace('|', "\\|"));
        let _ = writeln!(text, "| {} |", cells.join(" | "));
        text
    })
}
