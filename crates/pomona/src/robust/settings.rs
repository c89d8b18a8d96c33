use crate::config_error::{ConfigError, require};
use crate::optics::{DepthNoise, SensorPreset};
use serde::{Deserialize, Serialize};

/// Settings of the method `robust`.
///
/// Lengths in metres where the name says so, in radii of the apple or pixels where the text says so.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RobustConfig {
    /// The depth camera: `generic`, `paper`, `kinect`, `azure-kinect` or `d400`. Decides from which difference on two
    /// readings disagree.
    pub sensor: SensorPreset,
    /// Standard deviation of a depth reading at depth z as a + b z + c z²: [a, b, c], metres. Empty: that of `sensor`.
    pub noise_m: Vec<f64>,
    /// Smallest radius of a sphere that is tried, metres; a fit more than a tenth below it is refused. Default 0.020.
    pub radius_min_m: f64,
    /// Largest radius of a sphere that is tried, metres; a fit more than a tenth above it is refused. Default 0.055.
    pub radius_max_m: f64,
    /// Radius that apples are believed to have, metres. Default 0.038. Counts where little of one shows.
    pub radius_mean_m: f64,
    /// Standard deviation of that belief, metres. Default 0.006. Smaller: hidden apples are steadier, odd sizes worse.
    pub radius_sd_m: f64,
    /// Standard deviation, metres, of a radius read off the smaller side of a box; 0 (default): boxes do not say how large apples
    /// are. For drawn boxes and smeared depth 0.001, for boxes of what shows of hidden apples 0.
    pub box_radius_sd_m: f64,
    /// Share of a box's width and height on each side whose readings are left out. Default 0. For time-of-flight cameras, which
    /// smear an apple's rim backwards, 0.15.
    pub rim_share: f64,
    /// Share by which apples are believed to be lower than wide. Default 0.07.
    pub flattening_mean: f64,
    /// Standard deviation of that belief. Default 0.04.
    pub flattening_sd: f64,
    /// Standard deviation of the stem's angle to the image's upward direction, radians. Default 0.7.
    pub stem_sd_rad: f64,
    /// Fewest readings in a box that make an apple. Default 20.
    pub min_readings: usize,
    /// Spheres tried through four random points. Default 200. More: steadier among leaves, and slower.
    pub sphere_draws: usize,
    /// Spheres of these that are refined. Default 4.
    pub sphere_kept: usize,
    /// Blocks along the longer side of a box, over which readings are averaged. Default 24. More: finer and slower.
    pub blocks: usize,
    /// Weight of the box against the points when spheres compete. Default 0.2; 0 for boxes that mean little.
    pub box_weight: f64,
    /// Standard deviation of the place of the apple's outline, pixels. Default 0.7.
    pub contour_sd_px: f64,
    /// Standard deviation of an apple's surface about a flattened sphere, metres. Default 0.0003.
    pub shape_sd_m: f64,
    /// Smallest radius of a branch, metres. Default 0.0013. Smaller: stalks count as branches.
    pub branch_radius_min_m: f64,
    /// Largest radius of a branch, metres. Default 0.018.
    pub branch_radius_max_m: f64,
    /// Least distance of a branch's axis from the apple's centre, radii of the apple. Default 0.85.
    pub branch_near: f64,
    /// Largest distance of a branch's axis from the apple's centre, radii of the apple. Default 1.9.
    pub branch_far: f64,
    /// Length to either side of its foot along which a branch is looked at, radii of the apple. Default 2.9.
    pub branch_reach: f64,
    /// Standard deviation of a branch's bend: way aside over distance squared, per metre. Default 0.2.
    pub branch_bend_sd_per_m: f64,
    /// Lines that are looked at. Default 30. More: branches that hardly show are found more often, and slower.
    pub branch_guesses: usize,
    /// Answers with a smaller confidence are refused. Default 0.35. Higher: fewer and better answers.
    pub least_confidence: f64,
}

impl Default for RobustConfig {
    fn default() -> Self {
        Self {
            sensor: SensorPreset::Generic,
            noise_m: Vec::new(),
            radius_min_m: 0.020,
            radius_max_m: 0.055,
            radius_mean_m: 0.038,
            radius_sd_m: 0.006,
            box_radius_sd_m: 0.0,
            rim_share: 0.0,
            flattening_mean: 0.07,
            flattening_sd: 0.04,
            stem_sd_rad: 0.7,
            min_readings: 20,
            sphere_draws: 200,
            sphere_kept: 4,
            blocks: 24,
            box_weight: 0.2,
            contour_sd_px: 0.7,
            shape_sd_m: 0.0003,
            branch_radius_min_m: 0.0013,
            branch_radius_max_m: 0.018,
            branch_near: 0.85,
            branch_far: 1.9,
            branch_reach: 2.9,
            branch_bend_sd_per_m: 0.2,
            branch_guesses: 45,
            least_confidence: 0.35,
        }
    }
}

impl RobustConfig {
    /// The noise of the depth readings.
    pub(crate) fn noise(&self) -> DepthNoise {
        let preset = self.sensor.noise();
        match self.noise_m[..] {
            [a, b, c] => DepthNoise {
                law: [a, b, c],
                ..preset
            },
            _ => preset,
        }
    }

    pub(crate) fn validate(&self) -> Result<(), ConfigError> {
        let c = self;
        let noise = c.noise_m.is_empty() || c.noise_m.len() == 3;
        let finite = c.noise_m.iter().all(|n| n.is_finite() && n.abs() <= 1.0);
        require(
            noise && finite,
            "robust.noise_m",
            c.noise_m.len(),
            "empty, or three numbers within 1: a + b z + c z², in metres",
        )?;
        let positive: [(&'static str, f64); 10] = [
            ("robust.radius_min_m", c.radius_min_m),
            ("robust.radius_mean_m", c.radius_mean_m),
            ("robust.radius_sd_m", c.radius_sd_m),
            ("robust.flattening_sd", c.flattening_sd),
            ("robust.stem_sd_rad", c.stem_sd_rad),
            ("robust.contour_sd_px", c.contour_sd_px),
            ("robust.shape_sd_m", c.shape_sd_m),
            ("robust.branch_radius_min_m", c.branch_radius_min_m),
            ("robust.branch_near", c.branch_near),
            ("robust.branch_bend_sd_per_m", c.branch_bend_sd_per_m),
        ];
        for (name, value) in positive {
            let ok = value > 0.0 && value <= 1000.0;
            require(ok, name, value, "positive and at most 1000")?;
        }
        let ordered: [(&'static str, f64, f64, f64, &'static str); 4] = [
            (
                "robust.radius_max_m",
                c.radius_max_m,
                c.radius_min_m,
                1.0,
                "over radius_min_m and at most 1, in metres",
            ),
            (
                "robust.branch_radius_max_m",
                c.branch_radius_max_m,
                c.branch_radius_min_m,
                0.1,
                "over branch_radius_min_m and at most 0.1, in metres",
            ),
            (
                "robust.branch_far",
                c.branch_far,
                c.branch_near,
                10.0,
                "over branch_near and at most 10, in radii",
            ),
            (
                "robust.branch_reach",
                c.branch_reach,
                1.0,
                10.0,
                "over 1 and at most 10, in radii",
            ),
        ];
        for (name, value, low, high, rule) in ordered {
            require(value > low && value <= high, name, value, rule)?;
        }
        let shares = [
            ("robust.flattening_mean", c.flattening_mean),
            ("robust.least_confidence", c.least_confidence),
        ];
        for (name, value) in shares {
            require((0.0..=1.0).contains(&value), name, value, "from 0 to 1")?;
        }
        let firm = (0.0..=1.0).contains(&c.box_radius_sd_m);
        let name = "robust.box_radius_sd_m";
        require(firm, name, c.box_radius_sd_m, "from 0 to 1, in metres")?;
        let rim = (0.0..=0.4).contains(&c.rim_share);
        require(rim, "robust.rim_share", c.rim_share, "from 0 to 0.4")?;
        let weight = (0.0..=100.0).contains(&c.box_weight);
        require(weight, "robust.box_weight", c.box_weight, "from 0 to 100")?;
        let counts = [
            ("robust.min_readings", c.min_readings),
            ("robust.sphere_draws", c.sphere_draws),
            ("robust.sphere_kept", c.sphere_kept),
            ("robust.blocks", c.blocks),
            ("robust.branch_guesses", c.branch_guesses),
        ];
        for (name, value) in counts {
            let ok = (1..=100_000).contains(&value);
            require(ok, name, value, "from 1 to 100000")?;
        }
        Ok(())
    }
}
