//! The checks that the macro's code calls.

use crate::{ConfigError, Rule, Value};

/// The path of `name` in the section `prefix`, which may be empty.
pub fn path(prefix: &str, name: &str) -> String {
    if prefix.is_empty() {
        name.to_owned()
    } else {
        format!("{prefix}.{name}")
    }
}

/// Checks one setting by its own rule.
///
/// # Errors
///
/// [`ConfigError::Value`].
pub fn rule(prefix: &str, name: &str, value: &impl Value, rule: Rule) -> Result<(), ConfigError> {
    let numbers = value.numbers();
    let ok = numbers.is_none_or(|numbers| rule.allows(&numbers));
    require(ok, prefix, name, value, || rule.to_string())
}

/// Checks that `larger` of `numbers` holds, coordinate by coordinate, for one setting and another.
///
/// # Errors
///
/// [`ConfigError::Value`] for the first one.
pub fn order<T: Value>(
    prefix: &str,
    (name, value): (&str, &T),
    (operator, holds): (&str, fn(f64, f64) -> bool),
    (other_name, other): (&str, &T),
) -> Result<(), ConfigError> {
    let (Some(a), Some(b)) = (value.numbers(), other.numbers()) else {
        return Ok(());
    };
    let ok = a.iter().zip(&b).all(|(&a, &b)| holds(a, b));
    require(ok, prefix, name, value, || {
        let other_path = path(prefix, other_name);
        format!(
            "{} {other_path} = {}",
            operator_words(operator),
            text(other)
        )
    })
}

/// An error unless `ok`.
///
/// # Errors
///
/// [`ConfigError::Value`].
pub fn require(
    ok: bool,
    prefix: &str,
    name: &str,
    value: &impl Value,
    rule: impl FnOnce() -> String,
) -> Result<(), ConfigError> {
    if ok {
        return Ok(());
    }
    Err(ConfigError::Value {
        name: path(prefix, name),
        value: text(value),
        rule: rule(),
    })
}

/// An operator in words that follow 'it must be'.
pub fn operator_words(operator: &str) -> &'static str {
    match operator {
        ">" => "over",
        ">=" => "at least",
        "<" => "under",
        _ => "at most",
    }
}

fn text(value: &impl Value) -> String {
    value
        .to_toml()
        .map_or_else(|| "(left out)".to_owned(), |v| v.to_string())
}
