//! Which options belong to which of the things that can be measured.
//!
//! Clap's own `requires` says nothing of an option whose mode conflicts with what else is given: the mode cannot be
//! asked for then, and the option would be ignored in silence.

use super::arguments::EvaluateArguments;
use super::detection::DetectionArguments;
use super::real_arguments::RealArguments;
use super::robot::RobotArguments;
use super::segmentation::SegmentationArguments;
use crate::settings::SettingValues;
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command};

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Suites,
    Calipers,
    Detection,
    Segmentation,
    Real,
}

impl Mode {
    const ALL: [Self; 5] = [
        Self::Suites,
        Self::Calipers,
        Self::Detection,
        Self::Segmentation,
        Self::Real,
    ];

    /// The mode that a command line asks for.
    fn of(matches: &ArgMatches) -> Self {
        let asked = |id| matches.value_source(id) == Some(ValueSource::CommandLine);
        match () {
            () if asked("detection") => Self::Detection,
            () if asked("segmentation") => Self::Segmentation,
            () if asked("real") => Self::Real,
            () if asked("calipers") => Self::Calipers,
            () => Self::Suites,
        }
    }

    /// What asks for it.
    fn name(self) -> &'static str {
        match self {
            Self::Suites => "suites and frames with truth",
            Self::Calipers => "--calipers",
            Self::Detection => "--detection",
            Self::Segmentation => "--segmentation",
            Self::Real => "--real",
        }
    }

    /// The options that it takes and not every mode does.
    fn options(self) -> Vec<String> {
        let methods = || {
            let own = ["methods", "variants"].map(str::to_owned);
            own.into_iter().chain(ids::<SettingValues>())
        };
        let named =
            |names: &[&str]| -> Vec<String> { names.iter().map(ToString::to_string).collect() };
        let counted = named(&["count"]);
        match self {
            Self::Suites => methods()
                .chain(ids::<RobotArguments>())
                .chain(counted)
                .collect(),
            Self::Calipers => methods().chain(named(&["calipers"])).collect(),
            Self::Detection => ids::<DetectionArguments>().chain(counted).collect(),
            Self::Segmentation => ids::<SegmentationArguments>()
                .chain(named(&["runtime", "tiles"]))
                .chain(counted)
                .collect(),
            Self::Real => methods()
                .chain(ids::<RealArguments>())
                .chain(named(&[
                    "strokes",
                    "segmenters",
                    "runtime",
                    "tiles",
                    "apple_radii",
                ]))
                .collect(),
        }
    }
}

/// The names by which clap knows the options of a group.
fn ids<A: Args>() -> impl Iterator<Item = String> {
    let command = A::augment_args(Command::new(""));
    let ids: Vec<String> = command
        .get_arguments()
        .map(|argument| argument.get_id().to_string())
        .collect();
    ids.into_iter()
}

/// Whether every option that is given belongs to what is measured; else the message.
pub(crate) fn check_mode(matches: &ArgMatches) -> Result<(), String> {
    let mode = Mode::of(matches);
    let taken = mode.options();
    let others: Vec<(Mode, Vec<String>)> = Mode::ALL
        .into_iter()
        .filter(|other| *other != mode)
        .map(|other| (other, other.options()))
        .collect();
    let command = EvaluateArguments::augment_args(Command::new(""));
    for argument in command.get_arguments() {
        let id = argument.get_id().as_str();
        let is_given = matches.value_source(id) == Some(ValueSource::CommandLine);
        if !is_given || taken.iter().any(|own| own == id) {
            continue;
        }
        let owners: Vec<&str> = others
            .iter()
            .filter(|(_, options)| options.iter().any(|own| own == id))
            .map(|(other, _)| other.name())
            .collect();
        if !owners.is_empty() {
            return Err(format!(
                "--{} belongs to {}, not to {}; leave it out",
                argument.get_long().unwrap_or(id),
                owners.join(" and "),
                mode.name()
            ));
        }
    }
    Ok(())
}
