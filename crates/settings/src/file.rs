use crate::names::unknown;
use crate::{ConfigError, Description, Settings, check};
use std::path::Path;
use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

/// Reads settings from a TOML file and checks them. What the file leaves out keeps its default.
///
/// # Errors
///
/// [`ConfigError::Read`] where the file cannot be read, else as [`parse`].
pub fn read<T: Settings>(path: impl AsRef<Path>) -> Result<T, ConfigError> {
    let name = path.as_ref().display().to_string();
    let text = std::fs::read_to_string(path.as_ref()).map_err(|source| ConfigError::Read {
        path: name.clone(),
        source,
    })?;
    parse(&text, &name)
}

/// Settings from a TOML text, checked; `name` stands for it in messages.
///
/// # Errors
///
/// [`ConfigError::Parse`] where the text is not TOML, and [`ConfigError::InFile`] around [`ConfigError::Unknown`] for a
/// name that no setting has, [`ConfigError::Type`] for a value of another kind than its setting, and
/// [`ConfigError::Value`] for one that breaks a rule.
pub fn parse<T: Settings>(text: &str, name: &str) -> Result<T, ConfigError> {
    let fault = |source| ConfigError::Parse {
        path: name.to_owned(),
        source: Box::new(source),
    };
    let places = DeTable::parse(text).map_err(fault)?;
    let table: Table = text.parse().map_err(fault)?;
    let mut walk = Walk {
        text,
        description: Description::of::<T>(),
        lines: Vec::new(),
    };
    let walked = walk.table("", places.get_ref(), &table);
    let settings = walked.and_then(|()| {
        let settings: T = table.try_into().map_err(fault)?;
        settings.check("")?;
        Ok(settings)
    });
    settings.map_err(|source| walk.in_file(name, source))
}

/// A walk through a file that finds the lines of its settings.
struct Walk<'t> {
    text: &'t str,
    description: Description,
    /// Each name of the file with its line, from 1.
    lines: Vec<(String, usize)>,
}

impl Walk<'_> {
    /// Checks names and types.
    fn table(
        &mut self,
        prefix: &str,
        places: &DeTable<'_>,
        values: &Table,
    ) -> Result<(), ConfigError> {
        for (key, place) in places {
            let path = check::path(prefix, key.get_ref());
            let line = self.text[..key.span().start].matches('\n').count() + 1;
            self.lines.push((path.clone(), line));
            let value = values.get(key.get_ref().as_ref());
            if let (Some(setting), Some(value)) = (self.description.setting(&path), value) {
                setting.accept(value)?;
                continue;
            }
            let section = self.description.sections.iter().any(|s| s.path == path);
            match (place.get_ref(), value) {
                (DeValue::Table(places), Some(Value::Table(values))) if section => {
                    self.table(&path, places, values)?;
                }
                _ => return Err(unknown(&path, &self.description)),
            }
        }
        Ok(())
    }

    /// The error with its file, and the line of the setting that it names.
    fn in_file(&self, name: &str, source: ConfigError) -> ConfigError {
        let (ConfigError::Unknown { name: setting, .. }
        | ConfigError::Type { name: setting, .. }
        | ConfigError::Value { name: setting, .. }) = &source
        else {
            return source;
        };
        let line = self.lines.iter().find(|(path, _)| path == setting);
        let line = line.map_or_else(String::new, |(_, line)| format!(", line {line}"));
        ConfigError::InFile {
            place: format!("'{name}'{line}"),
            source: Box::new(source),
        }
    }
}
