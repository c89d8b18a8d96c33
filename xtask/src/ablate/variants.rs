use crate::workspace::root;
use anyhow::{Context, Result, ensure};
use serde::Deserialize;

/// The file that says which variants there are.
pub(super) const VARIANTS: &str = "xtask/ablation.toml";
/// The method whose ideas are switched off.
pub(super) const METHOD: &str = "robust";

/// What `xtask/ablation.toml` holds.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Ablation {
    /// Suites that are run where none is asked for.
    pub suites: Vec<String>,
    /// The variants, in the order of the table.
    #[serde(rename = "variant")]
    pub variants: Vec<Variant>,
}

/// Settings that switch one idea off.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Variant {
    /// Name in the table.
    pub name: String,
    /// What is off.
    pub off: String,
    /// Settings of the method that differ from their defaults.
    pub robust: toml::Table,
}

impl Ablation {
    pub(super) fn read() -> Result<Self> {
        let path = root().join(VARIANTS);
        let text = std::fs::read_to_string(&path).with_context(|| VARIANTS)?;
        let ablation: Self = toml::from_str(&text).with_context(|| VARIANTS)?;
        for (i, variant) in ablation.variants.iter().enumerate() {
            let name = &variant.name;
            let plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
            ensure!(
                !name.is_empty() && name.chars().all(plain),
                "{VARIANTS}: `{name}` is to be of letters, digits and hyphens"
            );
            let twice = ablation.variants[i + 1..].iter().any(|v| v.name == *name);
            ensure!(
                !twice && name != METHOD,
                "{VARIANTS}: `{name}` is given twice"
            );
            ensure!(
                !variant.robust.is_empty(),
                "{VARIANTS}: `{name}` changes nothing"
            );
        }
        Ok(ablation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variants_are_sound() {
        let ablation = Ablation::read().unwrap();
        assert!(!ablation.suites.is_empty());
        assert!(ablation.variants.len() >= 10);
    }
}
