use crate::attempt::Attempt;
use crate::collision_check::CollisionCheck;
use crate::obstacles::ObstacleFilter;
use crate::pose::{aligned, nearer_half_turn, tool_rotation};
use crate::straight_motion::StraightMotion;
use crate::transit::OpenGripper;
use crate::{
    Approach, ApproachConfig, Clearance, ConfigError, ObstacleMap, Refusal, Roll, StartPose, Target,
};
use nalgebra::{Unit, UnitQuaternion, Vector3};
use pomona_geometry::{Sphere, across};
use pomona_transforms::{Direction, RobotFrame};
use std::f64::consts::{PI, TAU};

/// Plans approaches by one checked configuration.
#[derive(Clone, Debug)]
pub struct Planner {
    config: ApproachConfig,
    open: OpenGripper,
}

impl Planner {
    /// A planner with these settings.
    ///
    /// # Errors
    ///
    /// [`ConfigError::Value`] names the setting that makes no sense.
    pub fn new(config: ApproachConfig) -> Result<Self, ConfigError> {
        config.validate()?;
        Ok(Self {
            open: OpenGripper::of(&config.gripper),
            config,
        })
    }

    /// Its settings.
    pub fn config(&self) -> &ApproachConfig {
        &self.config
    }

    /// The first collision-free approach to the target.
    ///
    /// Directions are tried in their order; each one straight, then tilted by half and by all of its
    /// uncertainty; each of these with the allowed rolls, directly; without a tilt also by a detour.
    ///
    /// # Errors
    ///
    /// Where there is none, the [`Refusal`] of the first approach tried.
    pub fn plan(
        &self,
        scene: &ObstacleMap,
        target: &Target,
        start: &StartPose,
    ) -> Result<Approach, Refusal> {
        self.plan_without(scene, target, start, &[])
    }

    /// The same with apples gone: those whose number has `true` in `gone`.
    ///
    /// # Errors
    ///
    /// As for [`Planner::plan`].
    pub fn plan_without(
        &self,
        scene: &ObstacleMap,
        target: &Target,
        start: &StartPose,
        gone: &[bool],
    ) -> Result<Approach, Refusal> {
        let none = Refusal::NoTarget {
            apple: target.apple,
            apples: scene.apples().len(),
        };
        let apple = *scene.apples().get(target.apple).ok_or(none)?;
        if !start.is_finite() {
            return Err(Refusal::NoStart);
        }
        self.fits(&apple)?;
        let mut first = None;
        let mut tried = 0;
        for (candidate, nominal) in target.directions.iter().enumerate() {
            for direction in self.tilts(nominal, target.direction_uncertainty_rad) {
                for rotation in self.rotations(&direction, target.branch.as_ref(), start) {
                    tried += 1;
                    let attempt = Attempt {
                        config: &self.config,
                        check: self.check(scene),
                        apple,
                        number: target.apple,
                        candidate,
                        nominal: *nominal,
                        direction,
                        rotation,
                        start,
                        tried,
                    };
                    // What the first attempt collides with is reported; of the others only whether they do.
                    match attempt.free_approach(gone, first.is_some()) {
                        Ok(approach) => return Ok(approach),
                        Err(refusal) => {
                            first.get_or_insert(refusal);
                        }
                    }
                }
            }
        }
        Err(first.unwrap_or(none))
    }

    /// Whether an approach stays free of one apple, branches and cloud left aside: the clearance
    /// where it does not.
    pub(crate) fn touches(
        &self,
        scene: &ObstacleMap,
        approach: &Approach,
        other: usize,
    ) -> Option<Clearance> {
        let gone: Vec<bool> = (0..scene.apples().len()).map(|i| i != other).collect();
        let filter = ObstacleFilter {
            target: approach.apple,
            target_counts: false,
            gone: &gone,
            wood_counts: false,
            any_collision: false,
        };
        let apple = *scene.apples().get(approach.apple)?;
        let straight = StraightMotion::new(
            &self.config.gripper,
            approach.grasp,
            approach.standoff_m,
            self.config.motion.retreat_m,
            apple,
        );
        let check = self.check(scene);
        check.clearance(&filter, &straight, &approach.path).err()
    }

    fn check<'a>(&'a self, scene: &'a ObstacleMap) -> CollisionCheck<'a> {
        CollisionCheck {
            gripper: &self.config.gripper,
            open: &self.open,
            config: &self.config.clearance,
            scene,
        }
    }

    fn fits(&self, apple: &Sphere) -> Result<(), Refusal> {
        let gripper = &self.config.gripper;
        let (needed_width_m, needed_depth_m) = gripper.needed_for(apple.radius);
        if needed_width_m <= gripper.jaw_width_m && needed_depth_m <= gripper.palm_depth_m {
            return Ok(());
        }
        Err(Refusal::GripperTooSmall {
            needed_width_m,
            width_m: gripper.jaw_width_m,
            needed_depth_m,
            depth_m: gripper.palm_depth_m,
        })
    }

    /// The direction itself, then those about it.
    fn tilts(
        &self,
        nominal: &Direction<RobotFrame>,
        uncertainty_rad: f64,
    ) -> Vec<Direction<RobotFrame>> {
        let search = &self.config.search;
        let largest = uncertainty_rad.min(search.tilt_max_rad);
        let mut directions = vec![*nominal];
        if !(largest > 0.0) {
            return directions;
        }
        let [u, v] = across(&nominal.unit());
        for share in [0.5, 1.0] {
            let (sin, cos) = (largest * share).sin_cos();
            for step in 0..search.tilt_azimuths {
                let (s, c) = (TAU * step as f64 / search.tilt_azimuths as f64).sin_cos();
                let tilted = nominal.vector() * cos + (u * c + v * s) * sin;
                directions.push(Direction::from_unit(Unit::new_normalize(tilted)));
            }
        }
        directions
    }

    /// The orientations to try, the one that turns the tool least first.
    fn rotations(
        &self,
        direction: &Direction<RobotFrame>,
        branch: Option<&Vector3<f64>>,
        start: &StartPose,
    ) -> Vec<UnitQuaternion<f64>> {
        let search = &self.config.search;
        let reference = &start.0.rotation;
        if search.roll == Roll::Aligned
            && let Some(rotation) = branch.and_then(|branch| aligned(direction, branch))
        {
            return vec![nearer_half_turn(rotation, reference)];
        }
        let step = PI / search.rolls as f64;
        let mut rotations: Vec<_> = (0..search.rolls)
            .map(|i| nearer_half_turn(tool_rotation(direction, step * i as f64), reference))
            .collect();
        rotations.sort_by(|a, b| a.angle_to(reference).total_cmp(&b.angle_to(reference)));
        rotations
    }
}
