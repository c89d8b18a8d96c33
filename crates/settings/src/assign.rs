use crate::names::unknown;
use crate::{ConfigError, Description, Settings};
use toml::{Table, Value};

/// `settings` with the one at `path` changed. The value's kind is checked, its rules are not: several changes may only
/// make sense together.
///
/// # Errors
///
/// [`ConfigError::Unknown`] where no setting has that path, [`ConfigError::Type`] where the value is none of its kind.
#[expect(
    clippy::needless_pass_by_value,
    reason = "callers make the value for this call: `70.into()` reads well"
)]
pub fn set<T: Settings>(settings: &T, path: &str, value: Value) -> Result<T, ConfigError> {
    let description = Description::of::<T>();
    let Some(setting) = description.setting(path) else {
        return Err(unknown(path, &description));
    };
    setting.accept(&value)?;
    let wrong = |kind: String, value: &Value| ConfigError::Type {
        name: path.to_owned(),
        value: value.to_string(),
        kind,
    };
    let mut table = Table::try_from(settings).map_err(|e| wrong(e.to_string(), &value))?;
    let (section, name) = setting.section_and_name();
    let mut inner = &mut table;
    for part in section.split('.').filter(|part| !part.is_empty()) {
        let section = inner.get_mut(part).and_then(Value::as_table_mut);
        inner = section.ok_or_else(|| unknown(path, &description))?;
    }
    // One that is left out has no entry yet.
    inner.insert(name.to_owned(), value.clone());
    table
        .try_into()
        .map_err(|e: toml::de::Error| wrong(e.message().to_owned(), &value))
}

/// A value as a person writes it: TOML, or a word without its quotes.
pub fn word_or_value(text: &str) -> Value {
    let text = text.trim();
    text.parse()
        .unwrap_or_else(|_| Value::String(text.to_owned()))
}
