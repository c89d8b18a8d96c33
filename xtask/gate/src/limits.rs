use crate::field::Field;
use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// What `xtask/regress.toml` holds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The runs, in the order in which they are made.
    #[serde(rename = "suite")]
    pub suites: Vec<SuiteLimits>,
}

/// One run: a suite under a method, and what is asked of it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SuiteLimits {
    /// Name of the suite.
    pub name: String,
    /// Name of the method.
    pub method: String,
    /// Only so many cases, from the first.
    pub count: Option<usize>,
    /// Seed of the method.
    #[serde(default)]
    pub seed: u64,
    /// Run only by `--full`.
    #[serde(default)]
    pub full: bool,
    /// The fields that count, by their names in [`super::FIELDS`].
    pub fields: BTreeMap<String, FieldLimits>,
}

/// What is asked of one field, in the unit of its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldLimits {
    /// It may not be less.
    pub floor: Option<f64>,
    /// It may not be more.
    pub ceiling: Option<f64>,
    /// It may not be worse than the golden value by more than this.
    pub tolerance: Option<f64>,
}

impl Limits {
    /// Reads and checks the file.
    ///
    /// # Errors
    ///
    /// Where it cannot be read, and as [`Limits::parse`].
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .with_context(|| format!("cannot read {}", path.display()))?;
        Self::parse(&text).with_context(|| path.display().to_string())
    }

    /// Reads the text of such a file and checks it.
    ///
    /// # Errors
    ///
    /// Where it is not TOML of this form, names a field that there is not, or limits one in no way or by nonsense.
    pub fn parse(text: &str) -> Result<Self> {
        let limits: Self = toml::from_str(text)?;
        for (i, suite) in limits.suites.iter().enumerate() {
            let id = suite.id();
            let twice = limits.suites[i + 1..].iter().any(|other| other.id() == id);
            ensure!(!twice, "{id} is given twice");
            ensure!(!suite.fields.is_empty(), "{id}: no field is limited");
            for (name, field) in &suite.fields {
                ensure!(
                    Field::named(name).is_some(),
                    "{id}: there is no field `{name}`"
                );
                let all = [field.floor, field.ceiling, field.tolerance];
                ensure!(
                    all.iter().any(Option::is_some),
                    "{id}: `{name}` is not limited"
                );
                ensure!(
                    all.iter().flatten().all(|v| v.is_finite()),
                    "{id}: `{name}` is not a number"
                );
                ensure!(
                    field.tolerance.is_none_or(|t| t >= 0.0),
                    "{id}: `{name}` has a negative tolerance"
                );
                let empty = field
                    .floor
                    .zip(field.ceiling)
                    .is_some_and(|(low, high)| low > high);
                ensure!(!empty, "{id}: `{name}` has its floor above its ceiling");
            }
        }
        Ok(limits)
    }
}

impl SuiteLimits {
    /// Suite and method, as one word.
    pub fn id(&self) -> String {
        format!("{}.{}", self.name, self.method)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_is_refused_by_name() {
        for (fields, part) in [
            ("angle_men_deg = { ceiling = 1 }", "angle_men_deg"),
            ("angle_mean_deg = {}", "not limited"),
            ("angle_mean_deg = { ceiling = nan }", "not a number"),
            ("angle_mean_deg = { tolerance = -1 }", "negative"),
            (
                "angle_mean_deg = { floor = 2, ceiling = 1 }",
                "above its ceiling",
            ),
            ("angle_mean_deg = { roof = 2 }", "roof"),
            ("", "no field"),
        ] {
            let text =
                format!("[[suite]]\nname = \"a\"\nmethod = \"m\"\n[suite.fields]\n{fields}\n");
            let message = format!("{:#}", Limits::parse(&text).unwrap_err());
            assert!(message.contains(part), "{fields}: {message}");
        }
    }
}
