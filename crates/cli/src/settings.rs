//! All settings of a run in one table, and how the command line sets them.

use anyhow::anyhow;
use clap::Args;
use clap::builder::PossibleValuesParser;
use pomona::{Config, Method};
use std::path::PathBuf;
use toml::{Table, Value};

/// One setting, as `pomona config` explains it.
pub(crate) struct Setting {
    /// Its name, as in the file.
    pub(crate) name: &'static str,
    /// What its number counts or measures.
    pub(crate) unit: &'static str,
    /// What it is, and what more or less of it costs.
    pub(crate) meaning: &'static str,
}

const fn setting(name: &'static str, unit: &'static str, meaning: &'static str) -> Setting {
    Setting {
        name,
        unit,
        meaning,
    }
}

/// Every setting, in the order of the file.
pub(crate) const SETTINGS: &[Setting] = &[
    setting(
        "method",
        "name",
        "The method. robust: ours. paper: Gao et al. 2022, doi 10.3390/agriculture12081170.",
    ),
    setting(
        "paper.sphere_iterations",
        "count",
        "Spheres tried within the radius bounds. More: steadier, and slower in proportion. The paper's figure.",
    ),
    setting(
        "paper.sphere_band",
        "share of the radius",
        "A point within this share of the radius supports a sphere. Wider: more noise is \
         borne, and leaves pass for surface. The paper's figure is 1/5.",
    ),
    setting(
        "paper.radius_min_m",
        "metres",
        "Smallest radius of an apple. The paper states none. Too small: spheres in a dent or a leaf.",
    ),
    setting(
        "paper.radius_max_m",
        "metres",
        "Largest radius of an apple. The paper states none. Too large: spheres that take leaves for surface.",
    ),
    setting(
        "paper.sphere_min_points",
        "count",
        "Fewest points that make an apple. Fewer: small and hidden apples are answered, and less reliably.",
    ),
    setting(
        "paper.shell_inner",
        "radii",
        "The branch is looked for from this far from the centre. Nearer: the apple's own surface gets in. \
         The paper's figure.",
    ),
    setting(
        "paper.shell_outer",
        "radii",
        "And up to this far. Farther: more of the branch, and more of other things. The paper's figure.",
    ),
    setting(
        "paper.line_iterations",
        "count",
        "Lines tried at an allowed distance. More: steadier, and slower in proportion. The paper's figure.",
    ),
    setting(
        "paper.line_band_m",
        "metres",
        "A point within this distance supports a line. Wider: thick and bent branches, and leaves. \
         The paper's figure.",
    ),
    setting(
        "paper.line_distance_min",
        "radii",
        "A line passes the centre at no less than this. Less: lines through the apple itself. The paper's figure.",
    ),
    setting(
        "paper.line_distance_max",
        "radii",
        "And at no more than this. More: branches that the apple does not hang from. The paper's figure.",
    ),
    setting(
        "paper.line_min_points",
        "count",
        "Fewest points that make a branch. Fewer: thin branches are found, and chance rows of points.",
    ),
    setting(
        "robust.sensor",
        "name",
        "The depth camera: generic, paper, kinect, azure-kinect or d400. Decides from which difference on two readings disagree.",
    ),
    setting(
        "robust.noise_m",
        "metres",
        "Standard deviation of a depth reading at depth z as a + b z + c z²: [a, b, c], metres. Empty: that of sensor.",
    ),
    setting(
        "robust.radius_min_m",
        "metres",
        "Smallest radius of a sphere that is tried; a fit more than a tenth below it is refused.",
    ),
    setting(
        "robust.radius_max_m",
        "metres",
        "Largest radius of a sphere that is tried; a fit more than a tenth above it is refused.",
    ),
    setting(
        "robust.radius_mean_m",
        "metres",
        "Radius that apples are believed to have. Counts where little of one shows.",
    ),
    setting(
        "robust.radius_sd_m",
        "metres",
        "Standard deviation of that belief. Smaller: hidden apples are steadier, odd sizes worse.",
    ),
    setting(
        "robust.box_radius_sd_m",
        "metres",
        "Standard deviation, metres, of a radius read off the smaller side of a box; 0 (default): boxes do not say how large apples are. For drawn boxes and smeared depth 0.001, for boxes of what shows of hidden apples 0.",
    ),
    setting(
        "robust.rim_share",
        "share",
        "Share of a box's width and height on each side whose readings are left out. For time-of-flight cameras, which smear an apple's rim backwards, 0.15.",
    ),
    setting(
        "robust.flattening_mean",
        "share",
        "Share by which apples are believed to be lower than wide.",
    ),
    setting(
        "robust.flattening_sd",
        "share",
        "Standard deviation of that belief.",
    ),
    setting(
        "robust.stem_sd_rad",
        "radians",
        "Standard deviation of the stem's angle to the image's upward direction.",
    ),
    setting(
        "robust.min_readings",
        "count",
        "Fewest readings in a box that make an apple.",
    ),
    setting(
        "robust.sphere_draws",
        "count",
        "Spheres tried through four random points. More: steadier among leaves, and slower.",
    ),
    setting(
        "robust.sphere_kept",
        "count",
        "Spheres of these that are refined.",
    ),
    setting(
        "robust.blocks",
        "count",
        "Blocks along the longer side of a box, over which readings are averaged. More: finer and slower.",
    ),
    setting(
        "robust.box_weight",
        "weight",
        "Weight of the box against the points when spheres compete. 0 for boxes that mean little.",
    ),
    setting(
        "robust.contour_sd_px",
        "pixels",
        "Standard deviation of the place of the apple's outline.",
    ),
    setting(
        "robust.shape_sd_m",
        "metres",
        "Standard deviation of an apple's surface about a flattened sphere.",
    ),
    setting(
        "robust.branch_radius_min_m",
        "metres",
        "Smallest radius of a branch. Smaller: stalks count as branches.",
    ),
    setting(
        "robust.branch_radius_max_m",
        "metres",
        "Largest radius of a branch.",
    ),
    setting(
        "robust.branch_near",
        "radii",
        "Least distance of a branch's axis from the apple's centre.",
    ),
    setting(
        "robust.branch_far",
        "radii",
        "Largest distance of a branch's axis from the apple's centre.",
    ),
    setting(
        "robust.branch_reach",
        "radii",
        "Length to either side of its foot along which a branch is looked at.",
    ),
    setting(
        "robust.branch_bend_sd_per_m",
        "per metre",
        "Standard deviation of a branch's bend: way aside over distance squared.",
    ),
    setting(
        "robust.branch_guesses",
        "count",
        "Lines that are looked at. More: branches that hardly show are found more often, and slower.",
    ),
    setting(
        "robust.least_confidence",
        "probability",
        "Answers with a smaller confidence are refused. Higher: fewer and better answers.",
    ),
    setting(
        "fallback.kind",
        "name",
        "What a refused apple with a sphere gets beside its refusal: none, surface_normal (from the side that shows) or away_from_obstacle (from the side that faces away from the nearest obstacle). A guess, labelled as such.",
    ),
    setting(
        "fusion.moved_rate",
        "share",
        "Of pairs of sightings of one apple at rest, those that may be called moved. Smaller: small movements are taken for noise.",
    ),
    setting(
        "fusion.direction_rate",
        "share",
        "Of right directions, those that may be dropped for contradicting the other frames.",
    ),
    setting(
        "fusion.center_sd_m",
        "metres",
        "Standard deviation of a centre along each axis where a frame states none (method paper).",
    ),
    setting(
        "fusion.center_floor_m",
        "metres",
        "Added to a stated one for what the method cannot know. Larger: fewer false movements, and small ones are overlooked.",
    ),
    setting("fusion.radius_floor_m", "metres", "The same for a radius."),
    setting(
        "fusion.direction_sd_rad",
        "radians",
        "Standard deviation of a direction where a frame states none (method paper).",
    ),
    setting(
        "fusion.direction_floor_rad",
        "radians",
        "Added to a stated one.",
    ),
    setting(
        "fusion.sway_sd_m",
        "metres",
        "Standard deviation, along each axis, of the way that a whole tree may sway between frames, or a pose may be off beyond what it states. 0: nothing sways.",
    ),
    setting(
        "fusion.sway_sd_rad",
        "radians",
        "The same for turning, about each axis.",
    ),
    setting(
        "fusion.moved_reach",
        "share",
        "Two places are of one moved apple up to this share of the sum of their radii; farther apart are two apples.",
    ),
    setting(
        "fusion.moved_visible",
        "share",
        "Least visible share of an apple at both places for it to have moved; what is seen worse is a misfit.",
    ),
    setting(
        "fusion.confidence",
        "probability",
        "Confidence of a direction where a frame states none (method paper).",
    ),
    setting(
        "fusion.repeated_error",
        "share",
        "Of wrong directions, those that another frame repeats. Larger: agreement counts for less.",
    ),
    setting(
        "fusion.least_confidence",
        "probability",
        "Fused answers with a smaller confidence are refused. Higher: fewer and better answers.",
    ),
    setting(
        "fusion.voxel_m",
        "metres",
        "Edge of the cells in which the points of the fused cloud are joined.",
    ),
];

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
