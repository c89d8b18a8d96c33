use crate::terminal::{FAINT, HEADING, REFUSED, Terminal, one_line};
use pomona::Warning;
use pomona::record::WarningRecord;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// What is known of a file, for people and as JSON.
pub(crate) struct Facts {
    path: String,
    kind: &'static str,
    list: Vec<Fact>,
    warnings: Vec<Warning>,
}

struct Fact {
    name: &'static str,
    value: Value,
    text: String,
}

impl Facts {
    pub(crate) fn new(path: &Path, kind: &'static str) -> Self {
        Self {
            path: path.display().to_string(),
            kind,
            list: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// Adds a fact: its value in JSON, in metres, and its text with the unit.
    pub(crate) fn add(
        &mut self,
        name: &'static str,
        value: impl Into<Value>,
        text: impl Into<String>,
    ) {
        self.list.push(Fact {
            name,
            value: value.into(),
            text: text.into(),
        });
    }

    /// Adds a fact whose text is its value.
    pub(crate) fn say(&mut self, name: &'static str, value: impl Into<Value>) {
        let value = value.into();
        let text = value
            .as_str()
            .map_or_else(|| value.to_string(), str::to_owned);
        self.add(name, value, text);
    }

    /// Adds the width and height of something made of pixels.
    pub(crate) fn size(&mut self, width: usize, height: usize) {
        self.add("size", vec![width, height], format!("{width} x {height}"));
    }

    /// Adds what the next command would say about this input.
    pub(crate) fn warn(&mut self, warnings: impl IntoIterator<Item = Warning>) {
        self.warnings.extend(warnings);
    }

    /// As lines for a person.
    pub(crate) fn text(&self, terminal: Terminal) -> String {
        let heading = terminal.paint(HEADING, &one_line(&self.path));
        let mut text = format!("{heading}: {}\n", self.kind);
        let width = self.list.iter().map(|f| f.name.len()).max().unwrap_or(0);
        for fact in &self.list {
            let name = format!("{:<width$}", fact.name.replace('_', " "));
            let name = terminal.paint(FAINT, &name);
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {name}  {}", one_line(&fact.text));
        }
        for warning in &self.warnings {
            let level = terminal.paint(REFUSED, warning.level().name());
            let _ = writeln!(text, "  {level}: {}", one_line(&warning.to_string()));
        }
        text
    }
}

impl Serialize for Facts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("path", &self.path)?;
        map.serialize_entry("kind", self.kind)?;
        for fact in &self.list {
            map.serialize_entry(fact.name, &fact.value)?;
        }
        if !self.warnings.is_empty() {
            let records = self.warnings.iter().map(WarningRecord::from);
            map.serialize_entry("warnings", &records.collect::<Vec<_>>())?;
        }
        map.end()
    }
}

/// Least and greatest value; `None` for none.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, v| {
        Some(range.map_or((v, v), |(low, high): (f64, f64)| (low.min(v), high.max(v))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::ColorChoice;
    use pomona::WarningCode;

    #[test]
    fn the_same_facts_for_people_and_programs() {
        let mut facts = Facts::new(Path::new("a.png"), "colour image");
        facts.size(4, 3);
        facts.say("depth_scale", 0.001);
        let text = facts.text(Terminal::new(ColorChoice::Never));
        assert_eq!(
            text,
            "a.png: colour image\n  size         4 x 3\n  depth scale  0.001\n"
        );
        let json = serde_json::to_string(&facts).unwrap();
        assert_eq!(
            json,
            r#"{"path":"a.png","kind":"colour image","size":[4,3],"depth_scale":0.001}"#
        );
    }

    #[test]
    fn warnings_come_last() {
        let mut facts = Facts::new(Path::new("a.json"), "camera");
        facts.say("width", 3);
        facts.warn([Warning::new(WarningCode::FrameIdAssumed, "no frame")]);
        let text = facts.text(Terminal::new(ColorChoice::Never));
        assert_eq!(
            text,
            "a.json: camera\n  width  3\n  note: no frame [frame_id_assumed]\n"
        );
        let json = serde_json::to_value(&facts).unwrap();
        assert_eq!(json["warnings"][0]["code"], "frame_id_assumed");
        assert_eq!(json["warnings"][0]["level"], "note");
    }

    #[test]
    fn a_range_of_nothing_is_none() {
        assert_eq!(range([3.0, -1.0, 2.0].into_iter()), Some((-1.0, 3.0)));
        assert_eq!(range(std::iter::empty()), None);
    }
}
