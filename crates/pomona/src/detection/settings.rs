use crate::config_error::{ConfigError, require};
use serde::{Deserialize, Serialize};

/// Settings of what depth says about the boxes of a detector. The noise of the readings is that of
/// [`RobustConfig`](crate::RobustConfig), whichever the method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DetectionConfig {
    /// Whether depth has a say at all. Default true. Off: boxes are taken as the detector gives them.
    pub depth_check: bool,
    /// Whether boxes with a mark are picked all the same. Default false: they are refused as implausible.
    pub pick_marked: bool,
    /// Smallest radius of what is taken for an apple, metres. Default 0.018.
    pub radius_min_m: f64,
    /// Largest radius of what is taken for an apple, metres. Default 0.060.
    pub radius_max_m: f64,
    /// Farthest depth at which an apple is worth picking, metres. Default 2.5.
    pub range_max_m: f64,
    /// Fewest readings in a box by which depth can judge. Default 20.
    pub min_readings: usize,
    /// Least curvature of the surface in every direction, as a share of a sphere's. Default 0.35. Higher: more of what is no
    /// apple is marked, and more apples that leaves cut up.
    pub least_roundness: f64,
    /// Two boxes are of one apple where their spheres' centres are nearer than this many radii. Default 0.5; 0 joins none.
    pub merge_distance: f64,
    /// Whether apples that the colour misses are looked for in depth. Default false.
    pub depth_search: bool,
    /// Least share of its outline on which the surface of an apple found in depth shows. Default 0.5. Lower: hidden apples
    /// are found, and more of what is none.
    pub search_coverage: f64,
}

impl Default for DetectionConfig {
    fn default() -> Self {
        Self {
            depth_check: true,
            pick_marked: false,
            radius_min_m: 0.018,
            radius_max_m: 0.060,
            range_max_m: 2.5,
            min_readings: 20,
            least_roundness: 0.35,
            merge_distance: 0.5,
            depth_search: false,
            search_coverage: 0.5,
        }
    }
}

impl DetectionConfig {
    pub(crate) fn validate(&self) -> Result<(), ConfigError> {
        let c = self;
        require(
            c.radius_min_m > 0.0 && c.radius_min_m.is_finite(),
            "detection.radius_min_m",
            c.radius_min_m,
            "positive, in metres",
        )?;
        require(
            c.radius_max_m > c.radius_min_m && c.radius_max_m <= 1.0,
            "detection.radius_max_m",
            c.radius_max_m,
            "over radius_min_m and at most 1, in metres",
        )?;
        require(
            c.range_max_m > 0.0 && c.range_max_m <= 100.0,
            "detection.range_max_m",
            c.range_max_m,
            "positive and at most 100, in metres",
        )?;
        require(
            (8..=10_000).contains(&c.min_readings),
            "detection.min_readings",
            c.min_readings,
            "from 8 to 10000",
        )?;
        let shares = [
            ("detection.least_roundness", c.least_roundness),
            ("detection.merge_distance", c.merge_distance),
            ("detection.search_coverage", c.search_coverage),
        ];
        for (name, value) in shares {
            require((0.0..=1.0).contains(&value), name, value, "from 0 to 1")?;
        }
        Ok(())
    }
}
