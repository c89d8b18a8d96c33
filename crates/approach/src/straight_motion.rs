//! The clearance of the straight stages, as the volumes that they sweep.

use crate::Gripper;
use crate::obstacles::{Hit, ObstacleFilter};
use crate::outline::{Outline, PlacedOutline};
use crate::shape::Shape;
use crate::swept_volume::SweptVolume;
use crate::{ClearanceConfig, ObstacleMap, Path, Stage};
use nalgebra::{Isometry3, Vector3};
use pomona_geometry::Sphere;

/// The straight motion to the apple and back, in the tool frame at the apple and in the base's.
pub(crate) struct StraightMotion {
    bodies: [SweptVolume; 4],
    outline: PlacedOutline,
    grasp: Isometry3<f64>,
    back: Vector3<f64>,
    apple: Sphere,
}

impl StraightMotion {
    pub(crate) fn new(
        gripper: &Gripper,
        grasp: Isometry3<f64>,
        standoff_m: f64,
        retreat_m: f64,
        apple: Sphere,
    ) -> Self {
        let swept = gripper.swept(standoff_m.max(retreat_m), apple.radius);
        Self {
            outline: PlacedOutline::new(&Outline::of(&swept), &grasp),
            bodies: swept.map(|body| body.moved(&grasp)),
            back: grasp * Vector3::new(-retreat_m, 0.0, 0.0),
            grasp,
            apple,
        }
    }

    /// The nearest obstacle, with the stage.
    ///
    /// The approach, closing the fingers, and the retreat sweep one volume; the apple moves back in the gripper, and
    /// must not press into what it does not touch where it hangs.
    ///
    /// # Errors
    ///
    /// The hit with the least slack where that is negative.
    pub(crate) fn clearance(
        &self,
        scene: &ObstacleMap,
        filter: &ObstacleFilter<'_>,
        config: &ClearanceConfig,
    ) -> Result<Option<(Hit, Stage)>, (Hit, Stage)> {
        let shape = Shape::with_outline(&self.bodies, self.outline);
        let hit = scene.nearest(&shape, filter, config, config.cutoff_m);
        if let Some(hit) = hit
            && hit.slack() < 0.0
        {
            return Err((hit, Stage::Approach));
        }
        if let Some(pressed) = scene.pressed(&self.apple, self.back, filter, config) {
            return Err((pressed, Stage::Retreat));
        }
        Ok(hit.map(|hit| (hit, Stage::Approach)))
    }

    /// When the gripper is first as near to a hit's point as it gets on its straight.
    pub(crate) fn time_of(&self, hit: &Hit, stage: Stage, gripper: &Gripper, path: &Path) -> f64 {
        if stage == Stage::Retreat {
            return path.grasp_s();
        }
        let distance = |body: &SweptVolume| body.distance_to_point(&hit.point);
        let nearest = self
            .bodies
            .iter()
            .zip(gripper.fronts())
            .min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
        let ahead = self.grasp.inverse_transform_point(&hit.point).x;
        let front = nearest.map_or(0.0, |(_, front)| front);
        path.time_on_straight((front - ahead).max(0.0))
    }
}
