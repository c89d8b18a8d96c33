//! The clearance of a whole path.

use crate::obstacles::{Hit, ObstacleFilter};
use crate::straight_motion::StraightMotion;
use crate::transit::{self, OpenGripper};
use crate::{Clearance, ClearanceConfig, Gripper, ObstacleMap, Path, Stage};

/// Collision checks of one gripper among the obstacles of one frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CollisionCheck<'a> {
    pub(crate) gripper: &'a Gripper,
    pub(crate) open: &'a OpenGripper,
    pub(crate) config: &'a ClearanceConfig,
    pub(crate) scene: &'a ObstacleMap,
}

impl CollisionCheck<'_> {
    /// The clearance of the transit and of the straight motion; the first collision as an error.
    pub(crate) fn clearance(
        &self,
        filter: &ObstacleFilter<'_>,
        straight: &StraightMotion,
        path: &Path,
    ) -> Result<Clearance, Clearance> {
        let Self {
            config,
            scene,
            open,
            ..
        } = *self;
        let timed = |(hit, stage): (Hit, Stage)| {
            let time = straight.time_of(&hit, stage, self.gripper, path);
            clearance_of(&hit, time, stage, 0.0)
        };
        let around_target = ObstacleFilter {
            target_counts: false,
            ..*filter
        };
        let near = straight
            .clearance(scene, &around_target, config)
            .map_err(timed)?;
        let intervals = transit::intervals(path, open);
        // Most paths that collide do so on the transit, and looking for the least slack takes longer.
        let transit = |any_collision| {
            let before_target = ObstacleFilter {
                target_counts: filter.wood_counts,
                any_collision,
                ..*filter
            };
            transit::nearest(path, &intervals, open, scene, &before_target, config)
                .map_err(|(hit, time)| clearance_of(&hit, time, Stage::Transit, 0.0))
        };
        transit(true)?;
        let passed = transit(false)?;
        let passed = passed.map(|(hit, time)| {
            let less = hit.slack() - transit::floor(hit.slack(), config.resolution_m);
            clearance_of(&hit, time, Stage::Transit, less)
        });
        let nearest = near
            .map(timed)
            .into_iter()
            .chain(passed)
            .min_by(|a, b| a.slack_m().total_cmp(&b.slack_m()));
        Ok(nearest.unwrap_or_else(|| Clearance {
            distance_m: transit::floor(config.cutoff_m, config.resolution_m)
                + config.cloud_margin_m.min(0.0),
            margin_m: config.cloud_margin_m.min(0.0),
            obstacle: None,
            point_m: path.sample(0.0).position.into(),
            time_s: 0.0,
            stage: Stage::Transit,
        }))
    }
}

fn clearance_of(hit: &Hit, time_s: f64, stage: Stage, less: f64) -> Clearance {
    Clearance {
        distance_m: hit.distance - less,
        margin_m: hit.margin,
        obstacle: Some(hit.obstacle),
        point_m: hit.point.into(),
        time_s,
        stage,
    }
}
