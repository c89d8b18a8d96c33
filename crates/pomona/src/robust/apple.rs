//! One apple: from the readings of its box to its spheroid.

use super::blocks::{Area, Blocks};
use super::silhouette::{agreement, silhouette_rays};
use super::sphere::{BoxRays, candidates, support};
use super::spheroid::{
    FitSchedule, Spheroid, SpheroidFit, SpheroidPrior, SurfaceObservations, fit_spheroid,
};
use super::trust::Trust;
use crate::config::{FruitConfig, RobustConfig};
use crate::optics::{DepthNoise, DepthPatch, Projection, depth_jump_m};
use crate::outcome::Status;
use nalgebra::{Point3, Unit, Vector3};
use pomona_cloud::{PixelBox, PixelWindow};
use pomona_geometry::Sphere;
use rand_chacha::ChaCha8Rng;

/// Weight of the outline against the points where bodies compete.
const OUTLINE_WEIGHT: f64 = 0.3;

/// Standard deviation of an apple about a sphere, metres: what a sphere leaves to its flattening.
const ROUND_SD_M: f64 = 0.0015;

/// Within how much of a sphere a block of readings supports it, metres, beside its noise.
const ROUND_SUPPORT_M: f64 = 0.0008;

/// Standard deviations within which a block supports a sphere: about 99 % of Gaussian ones.
const SUPPORT_SIGMAS: f64 = 2.5;

/// Pixels from its silhouette within which a silhouette ray agrees with a spheroid.
const SILHOUETTE_TOLERANCE_PX: f64 = 2.5;

/// Depth of an apple's visible surface before its centre, as a share of the radius, for the scale of its box.
const SURFACE_BEFORE_CENTER: f64 = 0.25;

/// Cut-offs of the robust weight, standard deviations, while spheres compete: two steps, then two after the
/// silhouette has been found again.
const SPHERE_CUTOFFS: [[f64; 2]; 2] = [[5.0, 3.5], [3.0, 3.0]];

/// Cut-offs of the two fits of the flattened spheroid.
const FIRST_CUTOFFS: [f64; 4] = [5.0, 4.0, 3.5, 3.0];
const LAST_CUTOFFS: [f64; 4] = [3.0; 4];

/// How much of its flattening a spheroid's equator exceeds the sphere fitted to it: mean over the directions seen.
const SPHERE_TO_EQUATOR: f64 = 0.3;

/// Mean stem axis before an apple is seen, z over −y: up in the image, a little towards the camera.
const STEM_LEAN: f64 = -0.2;

/// Fewest blocks of readings that make an apple.
const LEAST_BLOCKS: usize = 8;

/// Standard deviations of a reading between neighbours on different things.
const JUMP_SIGMAS: f64 = 6.0;

/// A fitted apple, and how well it was seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenApple {
    pub(crate) fit: SpheroidFit,
    /// Share of its outline's area on which its surface shows.
    pub(crate) visible_share: f64,
    /// How well the spheroid agrees with points, outline and box; 1 is perfect.
    pub(crate) agreement: f64,
}

/// Buffers that serve one apple after another.
#[derive(Clone, Debug, Default)]
pub(crate) struct AppleBuffers {
    pub(crate) patch: DepthPatch,
    blocks: Blocks,
    pub(crate) points: Vec<(Point3<f64>, f64)>,
    pub(crate) rays: Vec<Unit<Vector3<f64>>>,
}

/// Pixels by which the patch of an apple is wider than its box: room for outlines that the box cuts.
pub(crate) const MARGIN_PX: usize = 8;

/// What an apple is fitted with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AppleSearch<'a> {
    pub(crate) config: &'a RobustConfig,
    pub(crate) fruit: &'a FruitConfig,
    pub(crate) projection: &'a Projection<'a>,
    pub(crate) noise: DepthNoise,
    pub(crate) trust: Trust,
    pub(crate) bounds: &'a PixelBox,
    /// The pixels of the box.
    pub(crate) window: PixelWindow,
}

impl AppleSearch<'_> {
    /// Fits the apple of the box; `buffers.patch` holds the box and its margin.
    pub(crate) fn fit(
        &self,
        rng: &mut ChaCha8Rng,
        buffers: &mut AppleBuffers,
    ) -> Result<SeenApple, Status> {
        let (config, noise) = (self.config, self.noise);
        let side = self.block_side();
        let readings = self.gather(side, buffers);
        if readings == 0 {
            return Err(Status::NoDepth);
        }
        if readings < config.min_readings || buffers.blocks.len() < LEAST_BLOCKS {
            return Err(Status::TooFewPoints);
        }
        let bounds = BoxRays::new(self.bounds, self.projection).ok_or(Status::NoSphere)?;
        let front = buffers
            .blocks
            .z
            .iter()
            .fold(f32::INFINITY, |a, &b| a.min(b));
        let sigma = noise.sigma(f64::from(front)) * self.shared(1.0 / side as f64);
        let threshold = SUPPORT_SIGMAS * sigma.hypot(ROUND_SUPPORT_M);
        let spheres = candidates(
            &buffers.blocks,
            &bounds,
            config,
            self.fruit.hypotheses(),
            threshold,
            rng,
        );
        let (agreement, sphere) = self
            .best_sphere(&spheres, &bounds, threshold, buffers)
            .ok_or(Status::NoSphere)?;
        let fit = self.flattened(sphere, buffers).ok_or(Status::NoSphere)?;
        let radius = fit.spheroid.radius;
        if !self.fruit.fitted().contains(radius) {
            return Err(Status::ImplausibleRadius);
        }
        let outline = (radius / self.pixel(&fit.spheroid)).powi(2) * std::f64::consts::PI;
        Ok(SeenApple {
            fit,
            visible_share: (fit.weight * (side * side) as f64 / outline).min(1.0),
            agreement,
        })
    }

    /// Fills in the blocks and their points; returns the number of readings.
    fn gather(&self, side: usize, buffers: &mut AppleBuffers) -> usize {
        let (patch, blocks, window) = (&buffers.patch, &mut buffers.blocks, self.window);
        let (x0, y0) = (window.x0 - patch.origin.0, window.y0 - patch.origin.1);
        let area = Area {
            x0,
            y0,
            x1: x0 + window.width(),
            y1: y0 + window.height(),
        }
        .shrunk(self.trust.rim_share);
        let jump = |z: f32| depth_jump_m(self.noise.sigma(f64::from(z)), JUMP_SIGMAS) as f32;
        let readings = blocks.fill(patch, area, side, jump);
        let points =
            (0..blocks.len()).map(|i| (blocks.get(i), self.shared(f64::from(blocks.share[i]))));
        buffers.points.clear();
        buffers.points.extend(points);
        readings
    }

    /// Side of a block, pixels.
    pub(crate) fn block_side(&self) -> usize {
        (self.window.width().max(self.window.height()) / self.config.blocks).max(1)
    }

    /// The noise of an average as a share of that of one reading, where neighbours share it.
    pub(crate) fn shared(&self, share: f64) -> f64 {
        (share * self.noise.correlation_px).min(1.0)
    }

    /// Metres of a pixel at the spheroid's depth.
    pub(crate) fn pixel(&self, spheroid: &Spheroid) -> f64 {
        self.projection.pixel_m(spheroid.center.z)
    }

    /// The prior of the apple; of its radius by the smaller side of the box where the settings trust boxes.
    fn prior(&self, blocks: &Blocks) -> SpheroidPrior {
        let config = self.config;
        let mean = config.radius_mean_m.unwrap_or(self.fruit.prior_mean());
        let population = config.radius_sd_m.unwrap_or(self.fruit.prior_sd());
        let radius = if let Some(box_sd) = self.trust.box_radius_sd_m {
            let b = self.bounds;
            let side = (b.x_max - b.x_min).min(b.y_max - b.y_min);
            // Things in front are fewer than half of what a box shows; what shows of an apple lies before its centre.
            let mut depths = blocks.z.clone();
            let third = depths.len() / 3;
            let (_, depth, _) = depths.select_nth_unstable_by(third, f32::total_cmp);
            let depth = f64::from(*depth) + SURFACE_BEFORE_CENTER * mean;
            let radius = 0.5 * side * self.projection.pixel_m(depth);
            let tried = self.fruit.hypotheses();
            let radius = radius.clamp(tried.least, tried.most);
            // Both tell of the size: the box, and what apples are like.
            let (by_box, by_kind) = (box_sd.powi(-2), population.powi(-2));
            let together = by_box + by_kind;
            (
                (by_box * radius + by_kind * mean) / together,
                together.powf(-0.5),
            )
        } else {
            (mean, population)
        };
        SpheroidPrior {
            radius,
            flattening: (self.config.flattening_mean, self.config.flattening_sd),
            axis: up(),
            axis_sd: self.config.stem_sd_rad,
            shape_sd: self.trust.shape_sd_m,
        }
    }

    /// Looks for the outline about `spheroid`, and fits to it and to the points.
    fn refit(
        &self,
        spheroid: Spheroid,
        prior: &SpheroidPrior,
        schedule: &FitSchedule<'_>,
        buffers: &mut AppleBuffers,
    ) -> Option<SpheroidFit> {
        let sigma = self.noise.sigma(spheroid.center.z);
        silhouette_rays(
            &buffers.patch,
            self.projection,
            &spheroid,
            sigma,
            &mut buffers.rays,
        );
        let observations = SurfaceObservations {
            points: &buffers.points,
            rays: &buffers.rays,
            ray_sd: self.trust.contour_sd_px * self.pixel(&spheroid),
            noise: self.noise,
        };
        fit_spheroid(&observations, spheroid, prior, schedule)
    }

    /// Of the spheres, each refined a little, the one that agrees best with points, outline and box.
    fn best_sphere(
        &self,
        spheres: &[Sphere],
        bounds: &BoxRays,
        threshold: f64,
        buffers: &mut AppleBuffers,
    ) -> Option<(f64, Spheroid)> {
        let config = self.config;
        let tried = self.fruit.hypotheses();
        let prior = SpheroidPrior {
            shape_sd: ROUND_SD_M,
            ..self.prior(&buffers.blocks)
        };
        let schedule = |cuts| FitSchedule {
            cuts,
            fix_shape: true,
            reject_outlying_rays: false,
        };
        let mut best: Option<(f64, Spheroid)> = None;
        for sphere in spheres {
            let spheroid = Spheroid::round(sphere, up());
            let refined = self
                .refit(spheroid, &prior, &schedule(&SPHERE_CUTOFFS[0]), buffers)
                .and_then(|first| {
                    self.refit(
                        first.spheroid,
                        &prior,
                        &schedule(&SPHERE_CUTOFFS[1]),
                        buffers,
                    )
                });
            let Some(spheroid) = refined.map(|fit| fit.spheroid) else {
                continue;
            };
            if !tried.contains(spheroid.radius) {
                continue;
            }
            let outline = agreement(
                &buffers.rays,
                &spheroid,
                SILHOUETTE_TOLERANCE_PX * self.pixel(&spheroid),
            );
            let score = support(&buffers.blocks, &spheroid.sphere(), threshold)
                - config.box_weight * bounds.disagreement(&spheroid.sphere())
                + OUTLINE_WEIGHT * outline;
            if best.is_none_or(|(other, _)| score > other) {
                best = Some((score, spheroid));
            }
        }
        best
    }

    /// The flattened spheroid from a sphere.
    fn flattened(&self, sphere: Spheroid, buffers: &mut AppleBuffers) -> Option<SpheroidFit> {
        let flattening = self.config.flattening_mean;
        let start = Spheroid {
            radius: sphere.radius * (1.0 + SPHERE_TO_EQUATOR * flattening),
            flattening,
            // Leant a little towards the camera: straight up, the fit would not know which way to turn it.
            axis: Unit::new_normalize(Vector3::new(0.0, -1.0, STEM_LEAN)),
            ..sphere
        };
        let prior = self.prior(&buffers.blocks);
        let schedule = |cuts, reject_outlying_rays| FitSchedule {
            cuts,
            fix_shape: false,
            reject_outlying_rays,
        };
        let first = self.refit(start, &prior, &schedule(&FIRST_CUTOFFS, false), buffers)?;
        self.refit(
            first.spheroid,
            &prior,
            &schedule(&LAST_CUTOFFS, true),
            buffers,
        )
    }
}

/// Upwards in the image: where stems point by and large.
fn up() -> Unit<Vector3<f64>> {
    -Vector3::y_axis()
}
