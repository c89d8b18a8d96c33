use crate::config::{ConfigError, require};
use serde::{Deserialize, Serialize};

/// Settings of the fusion of several frames of one tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FusionConfig {
    /// Share of pairs of sightings of one apple at rest that may be called `moved`. Default 0.001. Smaller:
    /// small movements are taken for noise.
    pub moved_rate: f64,
    /// Share of right directions that may be dropped for contradicting the other frames. Default 0.001.
    pub direction_rate: f64,
    /// Standard deviation of a centre along each axis where a frame states none (method `paper`), metres. Default 0.003.
    pub center_sd_m: f64,
    /// What is added to a stated one for what the method cannot know, as a standard deviation along each axis,
    /// metres. Default 0.0015. Larger: fewer false `moved`, and smaller movements are overlooked.
    pub center_floor_m: f64,
    /// The same for a radius, metres. Default 0.0007.
    pub radius_floor_m: f64,
    /// Standard deviation of a direction where a frame states none (method `paper`), radians. Default 0.15.
    pub direction_sd_rad: f64,
    /// What is added to a stated one, as a standard deviation, radians. Default 0.04.
    pub direction_floor_rad: f64,
    /// Standard deviation of the way that a whole tree may sway between frames, or a pose may be off
    /// beyond what it states, along each axis, metres. Default 0.01. 0: nothing sways.
    pub sway_sd_m: f64,
    /// The same for turning, about each axis, radians. Default 0.005.
    pub sway_sd_rad: f64,
    /// Two places of one apple overlap: their distance is at most this share of the sum of the radii. Default 0.95.
    /// What lies farther apart are two apples.
    pub moved_reach: f64,
    /// Least visible share of an apple at both places for it to have moved. Default 0.3. What is seen worse is a misfit:
    /// spheres of hidden apples are at times wrong by centimetres.
    pub moved_visible: f64,
    /// Confidence of a direction where a frame states none (method `paper`), 0 to 1. Default 0.7.
    pub confidence: f64,
    /// Share of wrong directions that another frame repeats. Default 0.3. Larger: agreement counts for less.
    pub repeated_error: f64,
    /// Answers with a smaller confidence are refused. Default 0.35.
    pub least_confidence: f64,
    /// Edge of the cells in which the points of the fused cloud are joined, metres. Default 0.002.
    pub voxel_m: f64,
}

impl Default for FusionConfig {
    fn default() -> Self {
        Self {
            moved_rate: 0.001,
            direction_rate: 0.001,
            center_sd_m: 0.003,
            center_floor_m: 0.0015,
            radius_floor_m: 0.0007,
            direction_sd_rad: 0.15,
            direction_floor_rad: 0.04,
            sway_sd_m: 0.01,
            sway_sd_rad: 0.005,
            moved_reach: 0.95,
            moved_visible: 0.3,
            confidence: 0.7,
            repeated_error: 0.3,
            least_confidence: 0.35,
            voxel_m: 0.002,
        }
    }
}

impl FusionConfig {
    /// Checks every setting.
    ///
    /// # Errors
    ///
    /// [`ConfigError::Value`] for the first one that makes no sense.
    pub fn validate(&self) -> Result<(), ConfigError> {
        const RATE: &str = "over 0 and at most 0.1";
        const LENGTH: &str = "positive and at most 1, in metres";
        const FLOOR: &str = "0 to 1, in metres";
        const ANGLE: &str = "positive and at most 1.6, in radians";
        const SHARE: &str = "between 0 and 1";
        let c = self;
        for (name, value) in [
            ("fusion.moved_rate", c.moved_rate),
            ("fusion.direction_rate", c.direction_rate),
        ] {
            require((1e-12..=0.1).contains(&value), name, value, RATE)?;
        }
        for (name, value) in [
            ("fusion.center_sd_m", c.center_sd_m),
            ("fusion.voxel_m", c.voxel_m),
        ] {
            require((1e-5..=1.0).contains(&value), name, value, LENGTH)?;
        }
        for (name, value) in [
            ("fusion.center_floor_m", c.center_floor_m),
            ("fusion.radius_floor_m", c.radius_floor_m),
            ("fusion.sway_sd_m", c.sway_sd_m),
        ] {
            require((0.0..=1.0).contains(&value), name, value, FLOOR)?;
        }
        let angle = c.direction_sd_rad > 0.0 && c.direction_sd_rad <= 1.6;
        require(angle, "fusion.direction_sd_rad", c.direction_sd_rad, ANGLE)?;
        for (name, value) in [
            ("fusion.direction_floor_rad", c.direction_floor_rad),
            ("fusion.sway_sd_rad", c.sway_sd_rad),
        ] {
            require(
                (0.0..=1.6).contains(&value),
                name,
                value,
                "0 to 1.6, in radians",
            )?;
        }
        for (name, value) in [
            ("fusion.confidence", c.confidence),
            ("fusion.repeated_error", c.repeated_error),
        ] {
            require(value > 0.0 && value < 1.0, name, value, SHARE)?;
        }
        let visible = (0.0..=1.0).contains(&c.moved_visible);
        require(visible, "fusion.moved_visible", c.moved_visible, "0 to 1")?;
        let least = c.least_confidence >= 0.0 && c.least_confidence <= 1.0;
        require(
            least,
            "fusion.least_confidence",
            c.least_confidence,
            "0 to 1",
        )?;
        let reach = c.moved_reach > 0.0 && c.moved_reach <= 3.0;
        require(
            reach,
            "fusion.moved_reach",
            c.moved_reach,
            "over 0 and at most 3",
        )
    }
}
