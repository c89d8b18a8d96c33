use crate::terminal::Terminal;
use crate::{
    calibrate, completions, config, convert, detect, evaluate, inspect, pick, scenes, segment,
};
use clap::error::ErrorKind;
use clap::{
    ArgAction, ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand, value_parser,
};

const EXAMPLES: &str = "\
Examples:
  pomona scenes demo --out scenes                 write a synthetic frame
  pomona pick scenes/orchard-demo --out out       the picking directions of its apples
  pomona pick frames/* --out out --json           several frames, as JSON
  pomona detect photos --out boxes                the boxes of apples in colour images
  pomona inspect frames/a out/picks.json          the content of files
  pomona convert frames/a cloud.ply               a frame as a point cloud

Bad input ends with exit code 2 and a message that names the file; no half-written file remains.";

/// Heading of the options that every command takes.
const EVERYWHERE: &str = "Global options";

/// Computes the picking direction of each apple in an RGB-D frame.
#[derive(Debug, Parser)]
#[command(name = "pomona", version, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Log to standard error: -v for progress, -vv for details.
    #[arg(short, long, action = ArgAction::Count, global = true, help_heading = EVERYWHERE)]
    verbose: u8,
    /// Number of threads; the answers do not depend on it. Default: the number of processors.
    #[arg(long, value_name = "N", global = true, help_heading = EVERYWHERE, value_parser = value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// When to use colours; `auto` respects `NO_COLOR`.
    #[arg(long, value_name = "WHEN", global = true, help_heading = EVERYWHERE, value_enum, default_value_t)]
    pub(crate) color: ColorChoice,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Compute the picking direction of each apple.
    Pick(Box<pick::PickArguments>),
    /// Detect apples in colour images.
    Detect(detect::DetectArguments),
    /// Segment colour images: wood, fruit and posts, pixel by pixel.
    Segment(segment::SegmentArguments),
    /// Write synthetic frames with ground truth.
    Scenes(scenes::ScenesArguments),
    /// Measure methods against ground truth, fitted radii against calipers, or detectors and segmenters against labels.
    Evaluate(Box<evaluate::EvaluateArguments>),
    /// Calibrate the camera to the robot from samples of points or poses.
    Calibrate(calibrate::CalibrateArguments),
    /// Convert between cloud formats, or a frame to a cloud.
    Convert(convert::ConvertArguments),
    /// Describe frames, clouds, images and results.
    Inspect(inspect::InspectArguments),
    /// Print the settings as commented TOML.
    Config(config::ConfigArguments),
    /// Print completions for a shell.
    Completions(completions::CompletionsArguments),
}

/// The command whose options depend on what it measures.
const EVALUATE: &str = "evaluate";

impl Arguments {
    /// The command line; ends the program with a message where it makes no sense.
    pub(crate) fn read() -> Self {
        let mut command = Self::command();
        let matches = command.get_matches_mut();
        let own = matches.subcommand_matches(EVALUATE);
        if let Some(problem) = own.and_then(|own| evaluate::check_mode(own).err()) {
            let place = match command.find_subcommand_mut(EVALUATE) {
                Some(evaluate) => evaluate,
                None => &mut command,
            };
            place.error(ErrorKind::ArgumentConflict, problem).exit();
        }
        Self::from_arg_matches(&matches).unwrap_or_else(|error| error.format(&mut command).exit())
    }

    pub(crate) fn run(&self, terminal: Terminal) -> anyhow::Result<()> {
        self.start_log(terminal);
        if let Some(threads) = self.threads {
            rayon::ThreadPoolBuilder::new()
                .num_threads(usize::from(threads))
                .build_global()
                .map_err(|e| anyhow::anyhow!("--threads {threads}: {e}; ask for fewer"))?;
        }
        match &self.command {
            Command::Pick(arguments) => pick::run(arguments, terminal),
            Command::Detect(arguments) => detect::run(arguments, terminal),
            Command::Segment(arguments) => segment::run(arguments, terminal),
            Command::Scenes(arguments) => scenes::run(arguments),
            Command::Evaluate(arguments) => evaluate::run(arguments, terminal),
            Command::Calibrate(arguments) => calibrate::run(arguments, terminal),
            Command::Convert(arguments) => convert::run(arguments, terminal),
            Command::Inspect(arguments) => inspect::run(arguments, terminal),
            Command::Config(arguments) => config::run(arguments),
            Command::Completions(arguments) => completions::run(arguments, Self::command()),
        }
    }

    fn start_log(&self, terminal: Terminal) {
        let level = match self.verbose {
            0 => log::LevelFilter::Warn,
            1 => log::LevelFilter::Info,
            2 => log::LevelFilter::Debug,
            _ => log::LevelFilter::Trace,
        };
        let style = if terminal.colors_messages() {
            env_logger::WriteStyle::Always
        } else {
            env_logger::WriteStyle::Never
        };
        env_logger::Builder::new()
            .filter_level(level)
            .write_style(style)
            .format_target(false)
            .init();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn every_command_has_examples() {
        for command in Arguments::command().get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string);
            let name = command.get_name();
            assert!(help.is_some_and(|h| h.contains("Example")), "{name}");
        }
    }
}
