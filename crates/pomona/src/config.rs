//! Every setting of a run: declared here, in one file for each section, and nowhere else.

mod detection;
mod fallback;
mod fruit;
mod fusion;
mod paper;
mod robust;

pub use detection::DetectionConfig;
pub use fallback::{FallbackConfig, FallbackKind};
pub use fruit::FruitConfig;
pub(crate) use fruit::Radii;
pub use fusion::FusionConfig;
pub use paper::PaperConfig;
pub use robust::{RobustConfig, SensorPreset};

use pomona_settings::{ConfigError, choices, settings};
use std::path::Path;

choices! {
    /// Which method calculates the directions.
    pub enum Method {
        /// Ours: a flattened body with priors, branches seen as strips with two edges, and a confidence for every
        /// answer.
        Robust = "robust",
        /// The published one: Gao et al. 2022, doi 10.3390/agriculture12081170.
        Paper = "paper",
    }
}

settings! {
    /// All settings of a run.
    ///
    /// As a file it is TOML with the same names; what a file leaves out keeps its default,
    /// and a name that does not exist is refused.
    pub struct Config {
        /// The method.
        method: Method = Method::Robust, "name", any();
    }
    sections {
        /// How large the fruit is, for detection and both methods.
        fruit: FruitConfig;
        /// Settings of the method `paper`.
        paper: PaperConfig;
        /// Settings of the method `robust`.
        robust: RobustConfig;
        /// Settings of what depth says about a detector's boxes.
        detection: DetectionConfig;
        /// What is given in place of a direction that is refused.
        fallback: FallbackConfig;
        /// Settings of the fusion of several frames.
        fusion: FusionConfig;
    }
    require {
        robust.radius_mean_m: "within the window of fruit.radius_min_m and fruit.radius_max_m" => |c| {
            c.robust.radius_mean_m.is_none_or(|mean| c.fruit.radii().contains(mean))
        };
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
        pomona_settings::read(path)
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
        let config = parse("[fruit]\nradius_max_m = 0.06\n").unwrap();
        assert_eq!(config.fruit.radius_max_m, 0.06);
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
            ("[fruit]\nradius_max_m = 0.01", "fruit.radius_max_m"),
            ("[paper]\nsphere_iterations = 0", "paper.sphere_iterations"),
            ("[paper]\nshell_outer = inf", "paper.shell_outer"),
            ("[paper", "pomona.toml"),
            ("[fallback]\nkind = \"luck\"", "luck"),
            ("[fusion]\nmoved_rate = 0", "fusion.moved_rate"),
            ("[fruit]\nradius_min_m = nan", "fruit.radius_min_m"),
            (
                "[detection]\nmerge_distance = nan",
                "detection.merge_distance",
            ),
            ("[robust]\nradius_mean_m = 0.07", "robust.radius_mean_m"),
        ] {
            let message = parse(text).unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }

    #[test]
    fn a_window_of_radii_of_one_stage_is_answered_by_that_of_all() {
        for section in ["paper", "robust", "detection"] {
            let message = parse(&format!("[{section}]\nradius_max_m = 0.06")).unwrap_err();
            let message = message.to_string();
            assert!(
                message.contains("did you mean `fruit.radius_max_m`?"),
                "{message}"
            );
        }
    }
}
