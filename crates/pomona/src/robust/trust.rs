//! How far depth is believed where an apple is fitted: by the settings, and what they leave open by the frame itself.

use crate::config::RobustConfig;
use crate::optics::DepthQuality;

/// What a fit takes from the depth of an apple, its outline and its box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trust {
    /// Share of a box's sides whose readings are left out.
    pub(crate) rim_share: f64,
    /// Standard deviation of the silhouette's place, pixels.
    pub(crate) contour_sd_px: f64,
    /// Standard deviation of the surface about a spheroid, metres.
    pub(crate) shape_sd_m: f64,
    /// Standard deviation of a radius by the box, metres; `None` where boxes do not say how large apples are.
    pub(crate) box_radius_sd_m: Option<f64>,
}

/// Shares of a box's sides, at each end, where readings on an apple are bent towards what is behind it, in smeared
/// depth. This, the next and [`BOX_RADIUS_SD_M`] were chosen on two time-of-flight frames with 17 measured apples.
const SMEARED_RIM_SHARE: f64 = 0.15;

/// Standard deviation of the silhouette's place, pixels, where edges are sharp and where they are smeared.
const CONTOUR_SD_PX: (f64, f64) = (0.7, 3.0);

/// Standard deviation of an apple's surface about a spheroid, metres.
const SHAPE_SD_M: f64 = 0.0003;

/// Standard deviation of a radius by the box where depth is smeared, metres.
const BOX_RADIUS_SD_M: f64 = 0.001;

/// Smear below which boxes do not count.
const LEAST_SMEAR: f64 = 0.05;

impl Trust {
    pub(crate) fn of(config: &RobustConfig, quality: &DepthQuality) -> Self {
        let smear = quality.smear();
        let shared = quality.shared_error_m.unwrap_or(0.0);
        let between = |(sharp, smeared): (f64, f64)| sharp + smear * (smeared - sharp);
        let by_frame = (smear > LEAST_SMEAR).then(|| BOX_RADIUS_SD_M / smear);
        Self {
            rim_share: config.rim_share.unwrap_or(smear * SMEARED_RIM_SHARE),
            contour_sd_px: config.contour_sd_px.unwrap_or(between(CONTOUR_SD_PX)),
            shape_sd_m: config.shape_sd_m.unwrap_or(SHAPE_SD_M.max(smear * shared)),
            box_radius_sd_m: match config.box_radius_sd_m {
                Some(sd) => (sd > 0.0).then_some(sd),
                None => by_frame,
            },
        }
    }
}
