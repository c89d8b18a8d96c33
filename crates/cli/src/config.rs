use crate::settings::{SETTINGS, SettingsArguments, table};
use crate::terminal;
use clap::Args;
use pomona::{Config, ROBOT_DEFAULTS};
use std::fmt::Write;
use toml::Value;

const EXAMPLES: &str = "\
Examples:
  pomona config > pomona.toml                     the defaults, to be edited
  pomona pick frame --config pomona.toml --out out
  pomona config --robot > robot.toml              a robot's defaults, for `pick --robot`
  pomona config --radius-max-mm 60                what a run with these flags uses";

/// Columns of a comment.
const WIDTH: usize = 96;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ConfigArguments {
    /// Print the settings of a robot, for `pomona pick --robot`, in place of those of picking.
    #[arg(long)]
    robot: bool,
    #[command(flatten)]
    settings: SettingsArguments,
}

pub(crate) fn run(arguments: &ConfigArguments) -> anyhow::Result<()> {
    if arguments.robot {
        return terminal::print(ROBOT_DEFAULTS);
    }
    terminal::print(&commented(&arguments.settings.config()?)?)
}

/// The settings as TOML, each under a comment with its meaning, unit and default.
fn commented(config: &Config) -> anyhow::Result<String> {
    let (values, defaults) = (
        Value::Table(table(config)?),
        Value::Table(table(&Config::default())?),
    );
    let mut text = String::from("# Settings of `pomona pick`.\n");
    let mut section = "";
    for setting in SETTINGS {
        let (own_section, name) = setting.name.rsplit_once('.').unwrap_or(("", setting.name));
        if own_section != section {
            section = own_section;
            // Writing to a string cannot fail, here and below.
            let _ = write!(text, "\n[{section}]");
        }
        let (value, default) = (
            look_up(&values, setting.name),
            look_up(&defaults, setting.name),
        );
        let comment = format!(
            "{} Unit: {}; default {default}.",
            setting.meaning, setting.unit
        );
        let _ = write!(text, "\n{}{name} = {value}\n", wrapped(&comment));
    }
    Ok(text)
}

fn look_up<'a>(table: &'a Value, name: &str) -> &'a Value {
    name.split('.').fold(table, |value, part| &value[part])
}

/// `words` as comment lines.
fn wrapped(words: &str) -> String {
    let mut text = String::new();
    let mut line = String::from("#");
    for word in words.split_whitespace() {
        if line.len() + 1 + word.len() > WIDTH {
            text.push_str(&line);
            text.push('\n');
            line = String::from("#");
        }
        line.push(' ');
        line.push_str(word);
    }
    text + &line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_settings_read_back() {
        let mut config = Config::default();
        config.paper.radius_max_m = 0.061;
        let text = commented(&config).unwrap();
        assert_eq!(toml::from_str::<Config>(&text).unwrap(), config);
        assert!(text.lines().all(|line| line.len() <= WIDTH), "{text}");
        assert!(text.contains("default 0.05."), "{text}");
    }
}
