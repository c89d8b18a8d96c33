use crate::{ConfigError, Gripper, outdated};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::path::Path;

/// The default settings as commented TOML: meaning, unit and default of each.
pub const COMMENTED_DEFAULTS: &str = include_str!("../robot.toml");

/// All settings of the approach: the gripper, the arm's reach, how it moves, what counts as free.
///
/// As a file it is TOML with the same names; what a file leaves out keeps its default, and a name
/// that does not exist is refused. Metres, radians, seconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ApproachConfig {
    /// The gripper.
    pub gripper: Gripper,
    /// Where the arm gets to.
    pub reach: ReachConfig,
    /// How the tool moves.
    pub motion: MotionConfig,
    /// What counts as free.
    pub clearance: ClearanceConfig,
    /// What is tried before an apple is refused.
    pub search: SearchConfig,
}

/// Where the tool may be, in the base's frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ReachConfig {
    /// Centre of the shell, the arm's shoulder. Default 0 0 0.
    pub shoulder_m: [f64; 3],
    /// Inner radius of the shell. Default 0.20. Less: nearer apples, and folded arms.
    pub shell_inner_m: f64,
    /// Outer radius of the shell. Default 1.30. More: farther apples, and stretched arms.
    pub shell_outer_m: f64,
    /// Corner of the box with the smallest coordinates. Default -10 -10 -10: no box.
    pub box_min_m: [f64; 3],
    /// Corner of the box with the largest coordinates. Default 10 10 10.
    pub box_max_m: [f64; 3],
    /// Largest angle between the approach and the ray from the shoulder to the apple. Default 1.92
    /// (110°). More: apples on the near side of their branch, and arms that reach around them.
    pub behind_angle_max_rad: f64,
}

impl Default for ReachConfig {
    fn default() -> Self {
        Self {
            shoulder_m: [0.0; 3],
            shell_inner_m: 0.20,
            shell_outer_m: 1.30,
            box_min_m: [-10.0; 3],
            box_max_m: [10.0; 3],
            behind_angle_max_rad: 1.92,
        }
    }
}

/// How the tool moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionConfig {
    /// From the pre-grasp to the grasp, at least; longer where an apple's size needs it. Default
    /// 0.150. Longer: the straight is surer to be met, and needs more free room.
    pub standoff_m: f64,
    /// Length of the straight way back. Default 0.200.
    pub retreat_m: f64,
    /// Largest speed of the tool. Default 0.50 m/s.
    pub speed_max_m_per_s: f64,
    /// Largest acceleration of the tool. Default 2.0 m/s².
    pub acceleration_max_m_per_s2: f64,
    /// Largest turning speed of the tool. Default 1.5 rad/s.
    pub turn_max_rad_per_s: f64,
    /// Speed with which the tool enters the final straight. Default 0.15 m/s. Less: gentler, slower.
    pub approach_speed_m_per_s: f64,
    /// Average speed of the retreat. Default 0.10 m/s.
    pub retreat_speed_m_per_s: f64,
    /// Samples of a path in the record. Default 41.
    pub samples: usize,
    /// Where the tool starts, in the base's frame. Default: 0.25 m before the camera on its optical
    /// axis, where it saw nothing nearer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_m: Option<[f64; 3]>,
    /// Its orientation there, x y z w. Default: it points as the camera looks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_quaternion_xyzw: Option<[f64; 4]>,
}

impl Default for MotionConfig {
    fn default() -> Self {
        Self {
            standoff_m: 0.150,
            retreat_m: 0.200,
            speed_max_m_per_s: 0.50,
            acceleration_max_m_per_s2: 2.0,
            turn_max_rad_per_s: 1.5,
            approach_speed_m_per_s: 0.15,
            retreat_speed_m_per_s: 0.10,
            samples: 41,
            start_m: None,
            start_quaternion_xyzw: None,
        }
    }
}

/// What counts as free. A path is free where every obstacle keeps its margin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ClearanceConfig {
    /// From branches. Default 0.005. More: bears errors of the fit and the calibration.
    pub branch_margin_m: f64,
    /// From other apples. Default 0.003.
    pub apple_margin_m: f64,
    /// From the other points of the cloud. Default 0. Negative: the gripper may brush through
    /// leaves to this depth, and through wood that was taken for leaves.
    pub cloud_margin_m: f64,
    /// Radius of a branch whose fit gives none. Default 0.006. More: bears thick branches.
    pub branch_radius_m: f64,
    /// Clearances beyond this are not told apart. Default 0.025. More: slower, larger figures.
    pub cutoff_m: f64,
    /// Small clearances are known to within this. Default 0.002. Less: tighter ways are found, slower in
    /// proportion.
    pub resolution_m: f64,
    /// Side of the cells in which points of the cloud are taken together, as a ball about them.
    /// Default 0.005. More: faster, and obstacles grow by up to 0.87 of it.
    pub voxel_m: f64,
    /// Fewest points in a cell that make it an obstacle. Default 3. More: stray points beside edges
    /// vanish, and so do thin twigs far away.
    pub voxel_min_points: usize,
    /// Points within this of an apple's surface, or inside, are the apple's. Default 0.008. More:
    /// errors of the sphere are borne, and leaves that touch it are overlooked.
    pub own_band_m: f64,
    /// Points farther than this from every apple are left out. Default 0.50. Less: faster, and the
    /// transit is blind there.
    pub region_m: f64,
}

impl Default for ClearanceConfig {
    fn default() -> Self {
        Self {
            branch_margin_m: 0.005,
            apple_margin_m: 0.003,
            cloud_margin_m: 0.0,
            branch_radius_m: 0.006,
            cutoff_m: 0.025,
            resolution_m: 0.002,
            voxel_m: 0.005,
            voxel_min_points: 3,
            own_band_m: 0.008,
            region_m: 0.50,
        }
    }
}

/// How the tool may be turned about the direction of approach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Roll {
    /// The fingers to both sides of the branch; free where the branch is unknown.
    #[default]
    Aligned,
    /// Any; tried in steps, the one that turns the tool least first.
    Free,
}

/// What is tried before an apple is refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SearchConfig {
    /// `aligned`: the fingers to both sides of the branch; `free`: any roll. Default `aligned`.
    pub roll: Roll,
    /// Rolls tried over half a turn where roll is free. Default 4.
    pub rolls: usize,
    /// Half-angle within which a tilted approach is as good, where the method states none. Default
    /// 0.17 (10°). More: more ways around obstacles, less true to the direction.
    pub direction_uncertainty_rad: f64,
    /// Largest tilt of the approach off the direction, whatever its uncertainty. Default 0.35 (20°).
    pub tilt_max_rad: f64,
    /// Azimuths at which a tilt is tried. Default 6; 0 tries none.
    pub tilt_azimuths: usize,
    /// The transit is also tried by a point this far back from the pre-grasp towards the base.
    /// Default 0.20; 0 tries none.
    pub detour_m: f64,
}

impl Default for SearchConfig {
    fn default() -> Self {
        Self {
            roll: Roll::Aligned,
            rolls: 4,
            direction_uncertainty_rad: 0.17,
            tilt_max_rad: 0.35,
            tilt_azimuths: 6,
            detour_m: 0.20,
        }
    }
}

pub(crate) fn require(
    ok: bool,
    name: &'static str,
    value: f64,
    rule: &'static str,
) -> Result<(), ConfigError> {
    if ok {
        Ok(())
    } else {
        Err(ConfigError::Value { name, value, rule })
    }
}

impl ApproachConfig {
    /// Reads settings from a TOML file and checks them.
    ///
    /// # Errors
    ///
    /// [`ConfigError::Read`], [`ConfigError::Parse`], [`ConfigError::Outdated`], [`ConfigError::Value`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ConfigError> {
        let name = || path.as_ref().display().to_string();
        let text = std::fs::read_to_string(path.as_ref()).map_err(|source| ConfigError::Read {
            path: name(),
            source,
        })?;
        let table = text.parse::<toml::Table>().ok();
        if let Some(instead) = table.as_ref().and_then(outdated::in_place_of) {
            return Err(ConfigError::Outdated {
                path: name(),
                instead,
            });
        }
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
        self.gripper.validate()?;
        self.reach.validate()?;
        self.motion.validate()?;
        self.clearance.validate()?;
        self.search.validate()
    }
}

impl ReachConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        for (name, corner) in [
            ("reach.shoulder_m", self.shoulder_m),
            ("reach.box_min_m", self.box_min_m),
            ("reach.box_max_m", self.box_max_m),
        ] {
            for c in corner {
                require(c.abs() <= 100.0, name, c, "within 100 metres")?;
            }
        }
        let inner = self.shell_inner_m;
        let rule = "0 or more, in metres";
        require(inner >= 0.0, "reach.shell_inner_m", inner, rule)?;
        let outer = self.shell_outer_m;
        let rule = "over shell_inner_m and at most 100, in metres";
        let ok = outer > inner && outer <= 100.0;
        require(ok, "reach.shell_outer_m", outer, rule)?;
        for i in 0..3 {
            let ok = self.box_min_m[i] < self.box_max_m[i];
            let rule = "over box_min_m in each coordinate";
            require(ok, "reach.box_max_m", self.box_max_m[i], rule)?;
        }
        let angle = self.behind_angle_max_rad;
        let ok = angle > 0.0 && angle <= PI;
        let rule = "over 0 and at most π, in radians";
        require(ok, "reach.behind_angle_max_rad", angle, rule)
    }
}

impl MotionConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        for (name, value) in [
            ("motion.standoff_m", self.standoff_m),
            ("motion.retreat_m", self.retreat_m),
        ] {
            let rule = "from 0.001 to 2, in metres";
            require((0.001..=2.0).contains(&value), name, value, rule)?;
        }
        for (name, value) in [
            ("motion.speed_max_m_per_s", self.speed_max_m_per_s),
            (
                "motion.acceleration_max_m_per_s2",
                self.acceleration_max_m_per_s2,
            ),
            ("motion.turn_max_rad_per_s", self.turn_max_rad_per_s),
            ("motion.approach_speed_m_per_s", self.approach_speed_m_per_s),
            ("motion.retreat_speed_m_per_s", self.retreat_speed_m_per_s),
        ] {
            let rule = "from 0.001 to 100";
            require((0.001..=100.0).contains(&value), name, value, rule)?;
        }
        for (name, value) in [
            ("motion.approach_speed_m_per_s", self.approach_speed_m_per_s),
            ("motion.retreat_speed_m_per_s", self.retreat_speed_m_per_s),
        ] {
            let ok = value <= self.speed_max_m_per_s;
            require(ok, name, value, "at most speed_max_m_per_s")?;
        }
        for c in self.start_m.into_iter().flatten() {
            require(c.abs() <= 100.0, "motion.start_m", c, "within 100 metres")?;
        }
        if let Some(q) = self.start_quaternion_xyzw {
            let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
            let ok = (norm - 1.0).abs() <= 1e-3;
            let rule = "of norm 1; copy all digits, in the order x y z w";
            require(ok, "motion.start_quaternion_xyzw", norm, rule)?;
        }
        require(
            (2..=10_000).contains(&self.samples),
            "motion.samples",
            self.samples as f64,
            "from 2 to 10000",
        )
    }
}

impl ClearanceConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        for (name, value) in [
            ("clearance.branch_margin_m", self.branch_margin_m),
            ("clearance.apple_margin_m", self.apple_margin_m),
            ("clearance.cloud_margin_m", self.cloud_margin_m),
        ] {
            let rule = "from -0.1 to 0.1, in metres";
            require((-0.1..=0.1).contains(&value), name, value, rule)?;
        }
        let largest_margin = self
            .branch_margin_m
            .max(self.apple_margin_m)
            .max(self.cloud_margin_m);
        let resolution = self.resolution_m;
        let ok = (1e-5..=0.05).contains(&resolution);
        let rule = "from 0.00001 to 0.05, in metres";
        require(ok, "clearance.resolution_m", resolution, rule)?;
        let cutoff = self.cutoff_m;
        let ok = cutoff >= largest_margin + 2.0 * resolution && cutoff <= 10.0;
        let rule = "over every margin by two resolutions, and at most 10, in metres";
        require(ok, "clearance.cutoff_m", cutoff, rule)?;
        let voxel = self.voxel_m;
        let rule = "from 0.0001 to 0.1, in metres";
        let ok = (0.0001..=0.1).contains(&voxel);
        require(ok, "clearance.voxel_m", voxel, rule)?;
        let points = self.voxel_min_points as f64;
        let rule = "1 or more";
        require(points >= 1.0, "clearance.voxel_min_points", points, rule)?;
        for (name, value, most) in [
            ("clearance.branch_radius_m", self.branch_radius_m, 0.5),
            ("clearance.own_band_m", self.own_band_m, 0.1),
            ("clearance.region_m", self.region_m, 10.0),
        ] {
            let ok = (0.0..=most).contains(&value);
            require(
                ok,
                name,
                value,
                "0 or more and not beyond reason, in metres",
            )?;
        }
        Ok(())
    }
}

impl SearchConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        let rolls = self.rolls as f64;
        let ok = (1..=64).contains(&self.rolls);
        require(ok, "search.rolls", rolls, "from 1 to 64")?;
        let rule = "from 0 to 1.5, in radians";
        let uncertainty = self.direction_uncertainty_rad;
        let ok = (0.0..=1.5).contains(&uncertainty);
        require(ok, "search.direction_uncertainty_rad", uncertainty, rule)?;
        let tilt = self.tilt_max_rad;
        require(
            (0.0..=1.5).contains(&tilt),
            "search.tilt_max_rad",
            tilt,
            rule,
        )?;
        let azimuths = self.tilt_azimuths;
        require(
            azimuths <= 64,
            "search.tilt_azimuths",
            azimuths as f64,
            "at most 64",
        )?;
        let detour = self.detour_m;
        let rule = "from 0 to 2, in metres";
        require(
            (0.0..=2.0).contains(&detour),
            "search.detour_m",
            detour,
            rule,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_read_back_the_same() {
        let all = toml::to_string(&ApproachConfig::default()).unwrap();
        let back: ApproachConfig = toml::from_str(&all).unwrap();
        assert_eq!(back, ApproachConfig::default());
        back.validate().unwrap();
        let commented: ApproachConfig = toml::from_str(COMMENTED_DEFAULTS).unwrap();
        assert_eq!(commented, ApproachConfig::default());
        for line in all.lines().filter(|line| line.contains('=')) {
            let (name, _) = line.split_once('=').unwrap();
            let named = format!("\n{name}=");
            assert!(COMMENTED_DEFAULTS.contains(&named), "{name}");
        }
        let some: ApproachConfig = toml::from_str("[gripper]\njaw_width_m = 0.2\n").unwrap();
        assert_eq!(some.gripper.jaw_width_m, 0.2);
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        for (text, part) in [
            ("[gripper]\njaw_width_m = -1.0", "gripper.jaw_width_m"),
            (
                "[gripper]\ntcp_from_flange_quaternion_xyzw = [1.0, 1.0, 0.0, 0.0]",
                "norm 1",
            ),
            (
                "[gripper]\ntool_axis = [0.0, 0.0, 0.0]",
                "gripper.tool_axis",
            ),
            ("[reach]\nshell_outer_m = 0.1", "reach.shell_outer_m"),
            (
                "[reach]\nbehind_angle_max_rad = nan",
                "behind_angle_max_rad",
            ),
            (
                "[reach]\nbox_max_m = [10.0, -20.0, 10.0]",
                "reach.box_max_m",
            ),
            ("[motion]\nsamples = 1", "motion.samples"),
            (
                "[motion]\napproach_speed_m_per_s = 3.0",
                "speed_max_m_per_s",
            ),
            ("[clearance]\ncutoff_m = 0.001", "clearance.cutoff_m"),
            (
                "[clearance]\nvoxel_min_points = 0",
                "clearance.voxel_min_points",
            ),
            ("[search]\nrolls = 0", "search.rolls"),
        ] {
            let config: ApproachConfig = toml::from_str(text).unwrap();
            let message = config.validate().unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
        assert!(toml::from_str::<ApproachConfig>("[griper]\n").is_err());
        assert!(ApproachConfig::read("/nowhere/robot.toml").is_err());
    }
}
