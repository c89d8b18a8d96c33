//! All settings of a run in one table, and how the command line sets them.

mod listing;

pub(crate) use listing::SETTINGS;

use anyhow::anyhow;
use clap::Args;
use clap::builder::PossibleValuesParser;
use pomona::{Config, Method};
use std::path::PathBuf;
use toml::{Table, Value};

/// Flags that choose settings; later ones of this list win over earlier ones.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Settings")]
pub(crate) struct SettingsArguments {
    /// Settings from a TOML file; what it leaves out keeps its default (see `pomona config`).
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// The method.
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Method::ALL.map(Method::name)))]
    method: Option<String>,
    /// Any setting, such as `paper.shell_outer=2.5`; may be repeated.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Smallest radius of an apple, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    radius_min_mm: Option<f64>,
    /// Largest radius of an apple, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    radius_max_mm: Option<f64>,
    /// Spheres that the method `paper` tries for each apple.
    #[arg(long, value_name = "N")]
    sphere_iterations: Option<u64>,
    /// Lines that the method `paper` tries for each apple.
    #[arg(long, value_name = "N")]
    line_iterations: Option<u64>,
}

impl SettingsArguments {
    /// The settings that file and flags ask for, checked.
    pub(crate) fn config(&self) -> anyhow::Result<Config> {
        let mut config = match &self.config {
            Some(path) => Config::read(path)?,
            None => Config::default(),
        };
        if let Some(method) = &self.method {
            config = with(&config, "--method", "method", Value::String(method.clone()))?;
        }
        for assignment in &self.set {
            let (name, value) = assignment.split_once('=').ok_or_else(|| {
                anyhow!(
                    "--set {assignment}: no value; write NAME=VALUE, such as paper.shell_outer=2.5"
                )
            })?;
            // What is no TOML value is a word without its quotes.
            let value = value.trim();
            let value = value
                .parse()
                .unwrap_or_else(|_| Value::String(value.to_owned()));
            config = with(&config, &format!("--set {assignment}"), name.trim(), value)?;
        }
        for (flag, name, mm) in [
            ("--radius-min-mm", "paper.radius_min_m", self.radius_min_mm),
            ("--radius-max-mm", "paper.radius_max_m", self.radius_max_mm),
            ("--radius-min-mm", "robust.radius_min_m", self.radius_min_mm),
            ("--radius-max-mm", "robust.radius_max_m", self.radius_max_mm),
        ] {
            if let Some(mm) = mm {
                config = with(&config, flag, name, Value::Float(mm / 1000.0))?;
            }
        }
        for (flag, name, count) in [
            (
                "--sphere-iterations",
                "paper.sphere_iterations",
                self.sphere_iterations,
            ),
            (
                "--line-iterations",
                "paper.line_iterations",
                self.line_iterations,
            ),
        ] {
            if let Some(count) = count {
                let count = i64::try_from(count).unwrap_or(i64::MAX);
                config = with(&config, flag, name, Value::Integer(count))?;
            }
        }
        config.validate()?;
        Ok(config)
    }
}

/// `config` with one setting changed by the flag `said`.
fn with(config: &Config, said: &str, name: &str, value: Value) -> anyhow::Result<Config> {
    let unknown = || {
        let known: Vec<_> = SETTINGS.iter().map(|s| s.name).collect();
        anyhow!(
            "{said}: no setting is called `{name}`; there are {}",
            known.join(", ")
        )
    };
    let mut table = table(config)?;
    let (sections, last) = name
        .rsplit_once('.')
        .map_or((None, name), |(s, l)| (Some(s), l));
    let mut section = &mut table;
    for part in sections.into_iter().flat_map(|s| s.split('.')) {
        let inner = section.get_mut(part).and_then(Value::as_table_mut);
        section = inner.ok_or_else(unknown)?;
    }
    match section.get_mut(last) {
        Some(old) if !old.is_table() => *old = value,
        _ => return Err(unknown()),
    }
    table
        .try_into()
        .map_err(|e: toml::de::Error| anyhow!("{said}: {}; see `pomona config`", e.message()))
}

/// The settings as a TOML table.
pub(crate) fn table(config: &Config) -> anyhow::Result<Table> {
    Ok(Table::try_from(config)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(prefix: &str, table: &Table, into: &mut Vec<String>) {
        for (name, value) in table {
            match value.as_table() {
                Some(inner) => names(&format!("{prefix}{name}."), inner, into),
                None => into.push(format!("{prefix}{name}")),
            }
        }
    }

    #[test]
    fn every_setting_is_explained_once() {
        let mut expected = Vec::new();
        names("", &table(&Config::default()).unwrap(), &mut expected);
        let mut listed: Vec<_> = SETTINGS.iter().map(|s| s.name.to_owned()).collect();
        expected.sort();
        listed.sort();
        assert_eq!(listed, expected);
    }

    #[test]
    fn every_setting_can_be_set_by_its_name() {
        let defaults = table(&Config::default()).unwrap();
        for s in SETTINGS {
            let mut value = &Value::Table(defaults.clone());
            for part in s.name.split('.') {
                value = &value[part];
            }
            let set = vec![format!("{} = {value}", s.name)];
            let arguments = SettingsArguments {
                set,
                ..Default::default()
            };
            assert_eq!(arguments.config().unwrap(), Config::default(), "{}", s.name);
        }
    }

    #[test]
    fn flags_reach_their_settings() {
        let arguments = SettingsArguments {
            set: vec!["paper.shell_outer=2".into()],
            radius_min_mm: Some(25.0),
            radius_max_mm: Some(60.0),
            sphere_iterations: Some(7),
            line_iterations: Some(8),
            method: Some("paper".into()),
            config: None,
        };
        let Config { paper, robust, .. } = arguments.config().unwrap();
        assert_eq!((robust.radius_min_m, robust.radius_max_m), (0.025, 0.06));
        assert_eq!((paper.radius_min_m, paper.radius_max_m), (0.025, 0.06));
        assert_eq!((paper.sphere_iterations, paper.line_iterations), (7, 8));
        assert_eq!(paper.shell_outer, 2.0);
    }

    #[test]
    fn what_cannot_be_set_is_refused() {
        for (text, part) in [
            ("paper.shell_outer", "NAME=VALUE"),
            ("paper.sphell=1", "paper.shell_inner"),
            ("paper=1", "no setting is called `paper`"),
            ("shell_outer=2", "paper.shell_outer"),
            ("paper.shell_outer=wide", "--set paper.shell_outer=wide"),
            ("paper.shell_outer=0.5", "shell_inner"),
            ("paper.sphere_iterations=-4", "paper.sphere_iterations=-4"),
            ("method=magic", "magic"),
        ] {
            let arguments = SettingsArguments {
                set: vec![text.into()],
                ..Default::default()
            };
            let message = arguments.config().unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
