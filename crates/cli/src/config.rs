//! `pomona config`: the settings, explained.

use crate::settings::SettingsArguments;
use crate::terminal;
use clap::{Args, ValueEnum};
use pomona::ApproachConfig;
use pomona_settings::{Description, Settings};

const EXAMPLES: &str = "\
Examples:
  pomona config > pomona.toml                     the defaults, to be edited
  pomona pick frame --config pomona.toml --out out
  pomona config --robot > robot.toml              the defaults of a robot, for `pick --robot`
  pomona config --radius-max-mm 60                the settings of a run with these flags
  pomona config --format json-schema              for editors that check pomona.toml";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ConfigArguments {
    /// Print the settings of a robot, for `pomona pick --robot`, instead of those of picking.
    #[arg(long)]
    robot: bool,
    /// Print the settings with their values, or what settings there are.
    #[arg(long, value_enum, value_name = "NAME", default_value_t = Format::Toml)]
    format: Format,
    #[command(flatten)]
    settings: SettingsArguments,
}

/// In which form settings are printed.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    /// A file of settings with a comment on each.
    Toml,
    /// A table for each section, with defaults.
    Markdown,
    /// A JSON Schema of the file.
    JsonSchema,
}

pub(crate) fn run(arguments: &ConfigArguments) -> anyhow::Result<()> {
    let config = arguments.settings.config()?;
    let format = arguments.format;
    terminal::print(&if arguments.robot {
        let about = "A robot, for `pomona pick --robot`: its gripper, its reach, how it moves, what counts as free. \
                     Metres, radians, seconds, in the frame of the robot's base.";
        printed(about, &ApproachConfig::default(), format)?
    } else {
        printed("Settings of `pomona pick`.", &config, format)?
    })
}

fn printed<T: Settings>(about: &str, settings: &T, format: Format) -> anyhow::Result<String> {
    let description = Description::of::<T>();
    Ok(match format {
        Format::Toml => description.toml(about, settings),
        Format::Markdown => description.markdown(),
        Format::JsonSchema => serde_json::to_string_pretty(&description.json_schema(about))? + "\n",
    })
}
