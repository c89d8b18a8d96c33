use crate::config_error::{ConfigError, require};
use crate::{DetectionConfig, FallbackConfig, FusionConfig, RobustConfig};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Which method calculates the directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Method {
    /// The published one: Gao et al. 2022.
    Paper,
    /// Ours: a flattened body with priors, branches seen as strips with two edges, answers that know how sure they are.
    #[default]
    Robust,
}

impl Method {
    /// All of them, in the order in which they are listed to people.
    pub const ALL: [Self; 2] = [Self::Robust, Self::Paper];

    /// Its name in `picks.json` and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Robust => "robust",
        }
    }
}

/// All settings of a run.
///
/// As a file it is TOML with the same names; what a file leaves out keeps its default,
/// and a name that does not exist is refused.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// The method.
    pub method: Method,
    /// Settings of the method `paper`.
    pub paper: PaperConfig,
    /// Settings of the method `robust`.
    pub robust: RobustConfig,
    /// Settings of what depth says about a detector's boxes.
    pub detection: DetectionConfig,
    /// What is given in place of a direction that is refused.
    pub fallback: FallbackConfig,
    /// Settings of the fusion of several frames.
    pub fusion: FusionConfig,
}

/// Settings of the method `paper`.
///
/// The defaults are the paper's figures (sections 2.2.3–2.2.4), but for the radius bounds: it
/// states none, and without them its wide inlier band prefers spheres far too large.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PaperConfig {
    /// Spheres tried that meet the radius bounds. More: steadier, and slower in proportion. Paper: 1000.
    pub sphere_iterations: u64,
    /// A point supports a sphere within this share of the sphere's radius. Paper: 1/5.
    pub sphere_band: f64,
    /// Smallest radius of an apple, metres. Default 0.020.
    pub radius_min_m: f64,
    /// Largest radius of an apple, metres. Default 0.050. Too large a bound lets in spheres
    /// that take leaves for surface.
    pub radius_max_m: f64,
    /// Fewest points that make an apple. Default 20.
    pub sphere_min_points: usize,
    /// The branch is looked for from this many radii of the centre outwards. Paper: 1.2.
    pub shell_inner: f64,
    /// And up to this many radii. Paper: 3.
    pub shell_outer: f64,
    /// Lines tried that pass the centre at an allowed distance. Paper: 3000.
    pub line_iterations: u64,
    /// A point supports a line within this distance, metres. Paper: 0.005.
    pub line_band_m: f64,
    /// Lines pass the centre at no less than this many radii. Paper: 0.5.
    pub line_distance_min: f64,
    /// And at no more than this many. Paper: 1.5.
    pub line_distance_max: f64,
    /// Fewest points that make a branch. Default 10.
    pub line_min_points: usize,
}

impl Default for PaperConfig {
    fn default() -> Self {
        Self {
            sphere_iterations: 1000,
            sphere_band: 0.2,
            radius_min_m: 0.020,
            radius_max_m: 0.050,
            sphere_min_points: 20,
            shell_inner: 1.2,
            shell_outer: 3.0,
            line_iterations: 3000,
            line_band_m: 0.005,
            line_distance_min: 0.5,
            line_distance_max: 1.5,
            line_min_points: 10,
        }
    }
}

impl Config {
    /// Reads settings from a TOML file and checks them.
    ///
    /// # Errors
    ///
    /// Where the file cannot be read, is not TOML, names an unknown setting, or has a value
    /// that makes no sense.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ConfigError> {
        let name = || path.as_ref().display().to_string();
        let text = std::fs::read_to_string(path.as_ref()).map_err(|source| ConfigError::Read {
            path: name(),
            source,
        })?;
        let config: Self = toml::from_str(&text).map_err(|source| ConfigError::Parse {
            path: name(),
            source: Box::new(source),
        })?;
        config.validate()?;
        Ok(config)
    }

    /// Checks every setting.
    ///
    /// # Errors
    ///
    /// [`ConfigError::Value`] for the first one that makes no sense.
    pub fn validate(&self) -> Result<(), ConfigError> {
        self.paper.validate()?;
        self.robust.validate()?;
        self.detection.validate()?;
        self.fusion.validate()
    }
}

impl PaperConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        const COUNT: &str = "from 1 to 10 million";
        let count = |n: u64| (1..=10_000_000).contains(&n);
        let c = self;
        require(
            count(c.sphere_iterations),
            "paper.sphere_iterations",
            c.sphere_iterations,
            COUNT,
        )?;
        require(
            count(c.line_iterations),
            "paper.line_iterations",
            c.line_iterations,
            COUNT,
        )?;
        let share = c.sphere_band > 0.0 && c.sphere_band < 1.0;
        require(share, "paper.sphere_band", c.sphere_band, "between 0 and 1")?;
        let radius = c.radius_min_m > 0.0 && c.radius_min_m.is_finite();
        require(
            radius,
            "paper.radius_min_m",
            c.radius_min_m,
            "positive, in metres",
        )?;
        let window = c.radius_max_m > c.radius_min_m && c.radius_max_m <= 1.0;
        require(
            window,
            "paper.radius_max_m",
            c.radius_max_m,
            "over radius_min_m and at most 1, in metres",
        )?;
        let inner = c.shell_inner >= 1.0 && c.shell_inner.is_finite();
        require(
            inner,
            "paper.shell_inner",
            c.shell_inner,
            "at least 1, in radii",
        )?;
        let outer = c.shell_outer > c.shell_inner && c.shell_outer <= 100.0;
        require(
            outer,
            "paper.shell_outer",
            c.shell_outer,
            "over shell_inner and at most 100, in radii",
        )?;
        let band = c.line_band_m > 0.0 && c.line_band_m <= 1.0;
        require(
            band,
            "paper.line_band_m",
            c.line_band_m,
            "positive and at most 1, in metres",
        )?;
        let near = c.line_distance_min >= 0.0 && c.line_distance_min.is_finite();
        require(
            near,
            "paper.line_distance_min",
            c.line_distance_min,
            "0 or more, in radii",
        )?;
        let far = c.line_distance_max > c.line_distance_min && c.line_distance_max.is_finite();
        require(
            far,
            "paper.line_distance_max",
            c.line_distance_max,
            "over line_distance_min, in radii",
        )?;
        require(
            c.sphere_min_points >= 4,
            "paper.sphere_min_points",
            c.sphere_min_points,
            "4 or more",
        )?;
        require(
            c.line_min_points >= 2,
            "paper.line_min_points",
            c.line_min_points,
            "2 or more",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Config, ConfigError> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("pomona.toml");
        std::fs::write(&path, text).unwrap();
        Config::read(path)
    }

    #[test]
    fn what_a_file_leaves_out_keeps_its_default() {
        assert_eq!(parse("").unwrap(), Config::default());
        let config = parse("[paper]\nradius_max_m = 0.06\n").unwrap();
        assert_eq!(config.paper.radius_max_m, 0.06);
        assert_eq!(config.paper.line_iterations, 3000);
    }

    #[test]
    fn a_file_of_all_settings_reads_back_the_same() {
        let all = toml::to_string(&Config::default()).unwrap();
        assert_eq!(parse(&all).unwrap(), Config::default());
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        for (text, part) in [
            ("[paper]\nspere_band = 0.1", "spere_band"),
            ("method = \"magic\"", "magic"),
            ("[paper]\nsphere_band = \"wide\"", "sphere_band"),
            ("[paper]\nsphere_band = nan", "paper.sphere_band"),
            ("[paper]\nradius_max_m = 0.01", "paper.radius_max_m"),
            ("[paper]\nsphere_iterations = 0", "paper.sphere_iterations"),
            ("[paper]\nshell_outer = inf", "paper.shell_outer"),
            ("[paper", "pomona.toml"),
            ("[fallback]\nkind = \"luck\"", "luck"),
            ("[fusion]\nmoved_rate = 0", "fusion.moved_rate"),
            (
                "[detection]\nradius_max_m = 0.001",
                "detection.radius_max_m",
            ),
            (
                "[detection]\nmerge_distance = nan",
                "detection.merge_distance",
            ),
        ] {
            let message = parse(text).unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
