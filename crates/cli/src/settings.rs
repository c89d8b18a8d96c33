//! The settings of a run, as the command line gives them.

use anyhow::anyhow;
use clap::Args;
use clap::builder::PossibleValuesParser;
use pomona::{Config, Method};
use pomona_settings::toml::Value;
use pomona_settings::{set, word_or_value};
use std::path::PathBuf;

/// Flags that choose settings; later ones of this list take precedence.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Settings")]
pub(crate) struct SettingsArguments {
    /// The method.
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Method::ALL.map(Method::name)))]
    method: Option<String>,
    #[command(flatten)]
    values: SettingValues,
}

impl SettingsArguments {
    /// The settings that file and flags ask for, checked.
    pub(crate) fn config(&self) -> anyhow::Result<Config> {
        let method = self.method.as_deref().and_then(Method::from_name);
        self.values.config_with(method)
    }
}

/// The same flags but for the method, for commands that run several.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "Settings")]
pub(crate) struct SettingValues {
    /// Settings from a TOML file; missing ones keep their defaults (see `pomona config`).
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Any setting, such as `paper.shell_outer=2.5`; may be repeated.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Smallest radius of a fruit, mm (`fruit.radius_min_m`).
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    radius_min_mm: Option<f64>,
    /// Largest radius of a fruit, mm (`fruit.radius_max_m`).
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    radius_max_mm: Option<f64>,
    /// Number of sphere hypotheses of the method `paper` for each apple.
    #[arg(long, value_name = "N")]
    sphere_iterations: Option<u64>,
    /// Number of line hypotheses of the method `paper` for each apple.
    #[arg(long, value_name = "N")]
    line_iterations: Option<u64>,
}

impl SettingValues {
    /// The settings that file and flags ask for, checked.
    pub(crate) fn config(&self) -> anyhow::Result<Config> {
        self.config_with(None)
    }

    /// The same with this method in place of the file's.
    fn config_with(&self, method: Option<Method>) -> anyhow::Result<Config> {
        let mut config = match &self.config {
            Some(path) => Config::read(path)?,
            None => Config::default(),
        };
        if let Some(method) = method {
            config.method = method;
        }
        for Change { flag, name, value } in self.changes()? {
            config = set(&config, &name, value).map_err(|e| anyhow!("{flag}: {e}"))?;
        }
        config.validate()?;
        Ok(config)
    }

    fn changes(&self) -> anyhow::Result<Vec<Change>> {
        let mut changes = Vec::new();
        for assignment in &self.set {
            let (name, value) = assignment.split_once('=').ok_or_else(|| {
                anyhow!(
                    "--set {assignment}: no value; write NAME=VALUE, such as paper.shell_outer=2.5"
                )
            })?;
            let flag = format!("--set {assignment}");
            changes.push(Change::new(&flag, name.trim(), word_or_value(value)));
        }
        for (flag, name, mm) in [
            ("--radius-min-mm", "fruit.radius_min_m", self.radius_min_mm),
            ("--radius-max-mm", "fruit.radius_max_m", self.radius_max_mm),
        ] {
            changes.extend(mm.map(|mm| Change::new(flag, name, (mm / 1000.0).into())));
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
            let value = count.map(|count| i64::try_from(count).unwrap_or(i64::MAX));
            changes.extend(value.map(|count| Change::new(flag, name, count.into())));
        }
        Ok(changes)
    }
}

/// One setting that a flag changes.
struct Change {
    /// As the command line says it.
    flag: String,
    name: String,
    value: Value,
}

impl Change {
    fn new(flag: &str, name: &str, value: Value) -> Self {
        Self {
            flag: flag.to_owned(),
            name: name.to_owned(),
            value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_settings::Description;

    #[test]
    fn every_setting_can_be_set_by_its_name() {
        for setting in Description::of::<Config>().settings {
            let value = setting.default.clone().or(setting.example.clone()).unwrap();
            let set = vec![format!("{} = {value}", setting.path)];
            let arguments = SettingValues {
                set,
                ..Default::default()
            };
            let config = arguments.config().unwrap();
            let unchanged = config == Config::default();
            assert_eq!(unchanged, setting.default.is_some(), "{}", setting.path);
        }
    }

    #[test]
    fn flags_reach_their_settings() {
        let arguments = SettingsArguments {
            method: Some("paper".into()),
            values: SettingValues {
                set: vec!["paper.shell_outer=2".into()],
                radius_min_mm: Some(25.0),
                radius_max_mm: Some(60.0),
                sphere_iterations: Some(7),
                line_iterations: Some(8),
                config: None,
            },
        };
        let config = arguments.config().unwrap();
        let Config { paper, fruit, .. } = config;
        assert_eq!(config.method, Method::Paper);
        assert_eq!((fruit.radius_min_m, fruit.radius_max_m), (0.025, 0.06));
        assert_eq!((paper.sphere_iterations, paper.line_iterations), (7, 8));
        assert_eq!(paper.shell_outer, 2.0);
    }

    #[test]
    fn what_cannot_be_set_is_refused() {
        for (text, part) in [
            ("paper.shell_outer", "NAME=VALUE"),
            ("paper.sphell=1", "paper.shell_inner"),
            ("paper=1", "no setting is called `paper`"),
            ("shell_outer=2", "did you mean `paper.shell_outer`?"),
            (
                "robust.radius_max_m=0.08",
                "did you mean `fruit.radius_max_m`?",
            ),
            ("paper.shell_outer=wide", "--set paper.shell_outer=wide"),
            ("paper.shell_outer=1.1", "shell_inner"),
            ("paper.sphere_iterations=-4", "paper.sphere_iterations=-4"),
            ("method=magic", "magic"),
        ] {
            let arguments = SettingValues {
                set: vec![text.into()],
                ..Default::default()
            };
            let message = arguments.config().unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
