//! The settings of the approach, but for the gripper's, which stand in `gripper.rs`.

use crate::gripper::Gripper;
use pomona_settings::{ConfigError, choices, settings};
use std::f64::consts::PI;
use std::path::Path;

settings! {
    /// All settings of the approach: the gripper, the arm's reach, how it moves, what counts as free.
    ///
    /// As a file it is TOML with the same names; what a file leaves out keeps its default, and a name
    /// that does not exist is refused. Metres, radians, seconds.
    pub struct ApproachConfig {
    }
    sections {
        /// The gripper.
        gripper: Gripper;
        /// Where the tool may be, in the base's frame.
        reach: ReachConfig;
        /// How the tool moves.
        motion: MotionConfig;
        /// What counts as free.
        clearance: ClearanceConfig;
        /// What is tried before an apple is refused.
        search: SearchConfig;
    }
}

impl ApproachConfig {
    /// Reads settings from a TOML file and checks them.
    ///
    /// # Errors
    ///
    /// Where the file cannot be read, is not TOML, names an unknown setting, or has a value that makes no sense.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ConfigError> {
        pomona_settings::read(path)
    }
}

settings! {
    /// Where the tool may be, in the base's frame.
    pub struct ReachConfig {
        /// Centre of the shell, the arm's shoulder.
        shoulder_m: [f64; 3] = [0.0; 3], "metres", within(-100.0, 100.0);
        /// Inner radius of the shell. Less: nearer apples, and folded arms.
        shell_inner_m: f64 = 0.20, "metres", within(0.0, 100.0);
        /// Outer radius of the shell. More: farther apples, and stretched arms.
        shell_outer_m: f64 = 1.30, "metres", within(0.0, 100.0);
        /// Corner of the box with the smallest coordinates. The default is no box.
        box_min_m: [f64; 3] = [-10.0; 3], "metres", within(-100.0, 100.0);
        /// Corner of the box with the largest coordinates.
        box_max_m: [f64; 3] = [10.0; 3], "metres", within(-100.0, 100.0);
        /// Largest angle between the approach and the ray from the shoulder to the apple; the default is 110°. More:
        /// apples on the near side of their branch, and arms that reach around them.
        behind_angle_max_rad: f64 = 1.92, "radians", above(0.0).at_most(PI);
    }
    order {
        shell_outer_m > shell_inner_m;
        box_max_m > box_min_m;
    }
}

settings! {
    /// How the tool moves.
    pub struct MotionConfig {
        /// From the pre-grasp to the grasp, at least; longer where an apple's size needs it. Longer: the straight is
        /// surer to be met, and needs more free room.
        standoff_m: f64 = 0.150, "metres", within(0.001, 2.0);
        /// Length of the straight way back. Longer: the apple is surer to be clear of the tree, and needs more free
        /// room.
        retreat_m: f64 = 0.200, "metres", within(0.001, 2.0);
        /// Largest speed of the tool. More: faster picking.
        speed_max_m_per_s: f64 = 0.50, "metres per second", within(0.001, 100.0);
        /// Largest acceleration of the tool. More: faster picking, and a harder shake.
        acceleration_max_m_per_s2: f64 = 2.0, "metres per second squared", within(0.001, 100.0);
        /// Largest turning speed of the tool. More: faster picking.
        turn_max_rad_per_s: f64 = 1.5, "radians per second", within(0.001, 100.0);
        /// Speed with which the tool enters the final straight. Less: gentler, slower.
        approach_speed_m_per_s: f64 = 0.15, "metres per second", within(0.001, 100.0);
        /// Average speed of the retreat. Less: gentler, slower.
        retreat_speed_m_per_s: f64 = 0.10, "metres per second", within(0.001, 100.0);
        /// Samples of a path in the record. More: a finer path, and larger files.
        samples: usize = 41, "count", within(2.0, 1e4);
        /// Where the tool starts, in the base's frame. Left out: 0.25 m before the camera on its optical axis, where
        /// it saw nothing nearer.
        start_m: Option<[f64; 3]> = None, "metres", within(-100.0, 100.0), example [0.3, 0.0, 0.5];
        /// Its orientation there, x y z w. Left out: it points as the camera looks.
        start_quaternion_xyzw: Option<[f64; 4]> = None, "unit quaternion", unit(), example [0.0, 0.0, 0.0, 1.0];
    }
    order {
        approach_speed_m_per_s <= speed_max_m_per_s;
        retreat_speed_m_per_s <= speed_max_m_per_s;
    }
}

settings! {
    /// What counts as free. A path is free where every obstacle keeps its margin.
    pub struct ClearanceConfig {
        /// Margin from branches. More: tolerates errors of the fit and the calibration.
        branch_margin_m: f64 = 0.005, "metres", within(-0.1, 0.1);
        /// Margin from other apples. More: fewer of them are knocked off, and fewer apples can be approached.
        apple_margin_m: f64 = 0.003, "metres", within(-0.1, 0.1);
        /// Margin from the other points of the cloud. Negative: the gripper may brush through leaves to this depth,
        /// and through wood that was taken for leaves.
        cloud_margin_m: f64 = 0.0, "metres", within(-0.1, 0.1);
        /// Radius of a branch whose fit gives none. More: tolerates thick branches.
        branch_radius_m: f64 = 0.006, "metres", within(0.0, 0.5);
        /// Clearances beyond this are not told apart. More: slower, larger figures.
        cutoff_m: f64 = 0.025, "metres", above(0.0).at_most(10.0);
        /// Small clearances are known to within this. Less: tighter paths are found, slower in proportion.
        resolution_m: f64 = 0.002, "metres", within(1e-5, 0.05);
        /// Side of the cells in which points of the cloud are taken together, as a ball about them. More: faster, and
        /// obstacles grow by up to 0.87 of it.
        voxel_m: f64 = 0.005, "metres", within(0.0001, 0.1);
        /// Fewest points in a cell that make it an obstacle. More: stray points beside edges vanish, and so do thin
        /// twigs far away.
        voxel_min_points: usize = 3, "count", at_least(1.0);
        /// Points within this of an apple's surface, or inside, are the apple's. More: errors of the sphere are
        /// tolerated, and leaves that touch it are overlooked.
        own_band_m: f64 = 0.008, "metres", within(0.0, 0.1);
        /// Points farther than this from every apple are left out. Less: faster, and the transit is blind there.
        region_m: f64 = 0.50, "metres", within(0.0, 10.0);
    }
    require {
        cutoff_m: "over every margin by two resolutions" => |c| {
            let margin = c.branch_margin_m.max(c.apple_margin_m).max(c.cloud_margin_m);
            c.cutoff_m >= margin + 2.0 * c.resolution_m
        };
    }
}

choices! {
    /// How the tool may be turned about the direction of approach.
    pub enum Roll {
        /// The fingers to both sides of the branch; free where the branch is unknown.
        Aligned = "aligned",
        /// Any; tried in steps, the one that turns the tool least first.
        Free = "free",
    }
}

settings! {
    /// What is tried before an apple is refused.
    pub struct SearchConfig {
        /// How the fingers lie about the branch.
        roll: Roll = Roll::Aligned, "name", any();
        /// Rolls tried over half a turn where roll is free. More: tighter places are reached, slower in proportion.
        rolls: usize = 4, "count", within(1.0, 64.0);
        /// Half-angle within which a tilted approach is as good, where the method states none; the default is 10°.
        /// More: more ways around obstacles, less true to the direction.
        direction_uncertainty_rad: f64 = 0.17, "radians", within(0.0, 1.5);
        /// Largest tilt of the approach off the direction, whatever its uncertainty; the default is 20°. More: more
        /// ways around obstacles, less true to the direction.
        tilt_max_rad: f64 = 0.35, "radians", within(0.0, 1.5);
        /// Azimuths at which a tilt is tried. 0 tries none.
        tilt_azimuths: usize = 6, "count", within(0.0, 64.0);
        /// The transit is also tried by a point this far back from the pre-grasp towards the base. 0 tries none.
        detour_m: f64 = 0.20, "metres", within(0.0, 2.0);
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
