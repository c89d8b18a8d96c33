//! Whether depth shows an apple in a box.

use super::grid_readings::{GridReadings, SphereSupport};
use super::mark::Mark;
use crate::config::{Config, DetectionConfig, Radii};
use crate::optics::{DepthNoise, Projection, window_of_box};
use crate::roundness::Roundness;
use nalgebra::{Matrix4, Point3, Vector3, Vector4};
use pomona_cloud::{DepthImage, PixelBox};
use pomona_fit::{
    CenterSide, PlaneEstimator, Points, RadiusPrior, RadiusWindow, Refusing, SphereEstimator,
    SphereRefit, sphere_weighted,
};
use pomona_geometry::{Plane, Sphere};
use pomona_ransac::{FixedCount, InlierCount, Msac, Ransac};
use rand_chacha::ChaCha8Rng;

/// Spheres through four random readings that are tried.
const DRAWS: u64 = 64;

/// Planes through three random readings that are tried where a surface is not round.
const PLANES: u64 = 30;

/// Share of the readings on one plane that make a flat surface.
const FLAT: f64 = 0.7;

/// Standard deviation of an apple's surface about a sphere, metres: its flattening, mostly.
const ROUND_SD_M: f64 = 0.0015;

/// Standard deviations within which a reading is of a surface.
const WITHIN: f64 = 2.5;

/// Spheres that are looked at one after the other before a box is given up.
const ATTEMPTS: usize = 3;

/// Share of its outline on which an apple must show that is not the first thing seen in its box.
const LEAST_SHOWN: f64 = 0.2;

/// Standard deviation of a radius that is held at a bound, metres.
const HELD_M: f64 = 0.0002;

/// By how much boxes may be larger than what they hold.
const LOOSE_BOX: f64 = 1.4;

/// Most of a sphere's core that may be seen through: gaps of depth cameras, and boxes that shift.
const SEEN_THROUGH: f64 = 0.35;

/// Least share of a sphere's outline in the box on which its surface must show.
const LEAST_COVERAGE: f64 = 0.15;

/// The same of a sphere as large as the bounds allow.
const STRETCHED_SHOWN: f64 = 0.4;

/// Most of a box that may lie beyond the outline of its sphere on one side.
const BEYOND: f64 = 0.3;

/// Standard deviations by which a surface may be flatter than it looks.
const UNSURE: f64 = 2.0;

/// Least share of the readings within the outline that must be its surface.
const LEAST_SUPPORT: f64 = 0.15;

/// What depth says about one box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DepthAssessment {
    pub(super) mark: Mark,
    /// The sphere that its depth shows.
    pub(super) sphere: Option<Sphere>,
    pub(super) counts: SphereSupport,
    pub(super) roundness: Option<Roundness>,
}

impl DepthAssessment {
    fn of(mark: Mark) -> Self {
        Self {
            mark,
            sphere: None,
            counts: SphereSupport::default(),
            roundness: None,
        }
    }
}

/// Looks at the boxes of one depth image.
pub(super) struct DepthChecker<'a> {
    pub(super) depth: &'a DepthImage,
    pub(super) projection: &'a Projection<'a>,
    pub(super) config: &'a DetectionConfig,
    /// Radii of what is taken for an apple.
    pub(super) radii: Radii,
    noise: DepthNoise,
}

impl<'a> DepthChecker<'a> {
    pub(super) fn new(
        depth: &'a DepthImage,
        projection: &'a Projection<'a>,
        config: &'a Config,
    ) -> Self {
        Self {
            depth,
            projection,
            config: &config.detection,
            radii: config.fruit.checked(),
            noise: DepthNoise::stated(&config.robust),
        }
    }

    /// Judges a box. `readings` is memory that serves one box after another; it holds the box's readings afterwards.
    pub(super) fn check(
        &self,
        bounds: &PixelBox,
        rng: &mut ChaCha8Rng,
        readings: &mut GridReadings,
    ) -> DepthAssessment {
        if !self.config.depth_check {
            return DepthAssessment::of(Mark::Unchecked);
        }
        let window = window_of_box(bounds, self.depth.width, self.depth.height);
        readings.fill(self.depth, self.projection, window);
        if readings.len() < self.config.min_readings {
            return DepthAssessment::of(Mark::NoDepth);
        }
        let front = readings.depth_at(0.1);
        if front > self.config.range_max_m {
            return DepthAssessment::of(Mark::TooFar);
        }
        let metres = self.projection.pixel_m(front);
        let (width, height) = (bounds.width(), bounds.height());
        let (less, more) = (width.min(height), width.max(height));
        if 0.5 * less * metres > LOOSE_BOX * self.radii.most {
            return DepthAssessment::of(Mark::TooLarge);
        }
        if 0.5 * more * metres < LOOSE_BOX * self.radii.least
            && let Some(small) = self.too_small(bounds, readings, rng)
        {
            return small;
        }
        self.apple(bounds, readings, rng)
    }

    /// The first of a few spheres that could be an apple, or why none could. Whatever was taken for
    /// one and is none, a leaf before the apple, is left out when the next is looked for.
    fn apple(
        &self,
        bounds: &PixelBox,
        readings: &mut GridReadings,
        rng: &mut ChaCha8Rng,
    ) -> DepthAssessment {
        readings.all_left();
        let mut first = DepthAssessment::of(Mark::NotRound);
        for attempt in 0..ATTEMPTS {
            let Some(sphere) = self.sphere(self.radii, readings, rng) else {
                break;
            };
            let check = self.judge(bounds, sphere, readings);
            match check.mark {
                Mark::TooFar => return check,
                Mark::Plausible if attempt == 0 || self.convinces(&check) => return check,
                _ => {}
            }
            if attempt == 0 {
                first = check;
                if self.is_flat(sphere.center.z, readings, rng) {
                    break;
                }
            }
            readings.leave_out(&sphere, self.threshold(sphere.center.z));
        }
        let z = first.sphere.map_or(readings.depth_at(0.5), |s| s.center.z);
        first.mark = if self.is_flat(z, readings, rng) {
            Mark::Flat
        } else {
            Mark::NotRound
        };
        first
    }

    /// Whether what is left of a box, less what was no apple, shows one beyond doubt.
    fn convinces(&self, check: &DepthAssessment) -> bool {
        let round = check.roundness.as_ref();
        round.is_some_and(|r| r.least >= self.config.least_roundness)
            && check.counts.coverage() >= LEAST_SHOWN
    }

    /// What a sphere within the bounds looks like.
    fn judge(&self, bounds: &PixelBox, sphere: Sphere, readings: &GridReadings) -> DepthAssessment {
        let z = sphere.center.z;
        let threshold = self.threshold(z);
        let counts = readings.counts(&sphere, threshold);
        let near = (0..readings.len()).map(|i| readings.point(i)).filter(|p| {
            sphere.signed_distance(p).abs() <= 1.5 * threshold && p.z <= sphere.center.z
        });
        let roundness = Roundness::of(near, &sphere, self.sigma(z));
        let bent = |r: &Roundness| r.least + UNSURE * r.least_sd < self.config.least_roundness;
        // A surface that would be flatter if it could, and shows little.
        let stretched =
            sphere.radius > 0.98 * self.radii.most && counts.coverage() < STRETCHED_SHOWN;
        let mark = if z - sphere.radius > self.config.range_max_m {
            Mark::TooFar
        } else if roundness.as_ref().is_some_and(bent)
            || stretched
            || counts.seen_through() > SEEN_THROUGH
            || counts.support() < LEAST_SUPPORT
            || counts.coverage() < LEAST_COVERAGE
            || self.beyond(bounds, &sphere) > BEYOND
        {
            Mark::NotRound
        } else {
            Mark::Plausible
        };
        DepthAssessment {
            mark,
            sphere: Some(sphere),
            counts,
            roundness,
        }
    }

    /// For a box no larger than the smallest apples: whether all of it is something round that is smaller still.
    fn too_small(
        &self,
        bounds: &PixelBox,
        readings: &mut GridReadings,
        rng: &mut ChaCha8Rng,
    ) -> Option<DepthAssessment> {
        let least = self.radii.least;
        readings.all_left();
        let smaller_too = Radii {
            least: least / 4.0,
            ..self.radii
        };
        let sphere = self.sphere(smaller_too, readings, rng)?;
        let check = self.judge(bounds, sphere, readings);
        let small = sphere.radius + 2.0 * self.radius_sd(&sphere, readings) < least;
        (small && check.mark == Mark::Plausible).then_some(DepthAssessment {
            mark: Mark::TooSmall,
            ..check
        })
    }

    /// Whether one plane holds most of the readings.
    fn is_flat(&self, z: f64, readings: &GridReadings, rng: &mut ChaCha8Rng) -> bool {
        let Ok(points) = Points::new(&readings.x, &readings.y, &readings.z) else {
            return false;
        };
        let plane = Ransac::new(InlierCount::within(WITHIN * self.noise.sigma(z)))
            .stopping(FixedCount::new(PLANES))
            .run(&PlaneEstimator::new(points), rng);
        plane.is_ok_and(|p| p.inliers.len() as f64 >= FLAT * readings.len() as f64)
    }

    /// How far the box reaches beyond the sphere's outline at its worst edge, as a share of its longer side.
    fn beyond(&self, bounds: &PixelBox, sphere: &Sphere) -> f64 {
        let Some((u, v)) = self.projection.project(&sphere.center) else {
            return f64::INFINITY;
        };
        let half = sphere.radius / self.projection.pixel_m(sphere.center.z);
        let b = bounds;
        let edges = [
            u - half - b.x_min,
            v - half - b.y_min,
            b.x_max - u - half,
            b.y_max - v - half,
        ];
        let most = edges.into_iter().fold(0.0, f64::max);
        most / b.width().max(b.height())
    }

    /// Pixels of the readings that show a sphere's surface.
    pub(super) fn surface(&self, readings: &GridReadings, sphere: &Sphere) -> Vec<u32> {
        let threshold = self.threshold(sphere.center.z);
        let near = |i: &usize| sphere.signed_distance(&readings.point(*i)).abs() <= threshold;
        (0..readings.len())
            .filter(near)
            .map(|i| readings.pixel[i])
            .collect()
    }

    /// Standard deviation of a reading about a sphere at depth `z`, metres.
    fn sigma(&self, z: f64) -> f64 {
        self.noise.sigma(z).hypot(ROUND_SD_M)
    }

    /// Distance within which a reading is of a sphere at depth `z`, metres.
    fn threshold(&self, z: f64) -> f64 {
        WITHIN * self.sigma(z)
    }

    /// The sphere with a radius within `bounds` that most of the readings left support, with its centre behind what is
    /// seen.
    fn sphere(
        &self,
        bounds: Radii,
        readings: &mut GridReadings,
        rng: &mut ChaCha8Rng,
    ) -> Option<Sphere> {
        if readings.left_z.len() < self.config.min_readings {
            return None;
        }
        let Radii { least, most } = bounds;
        let front = readings.left_depth_at(0.25);
        let behind = Plane::new(Point3::new(0.0, 0.0, front), Vector3::z())?;
        let points = Points::new(&readings.left_x, &readings.left_y, &readings.left_z).ok()?;
        let threshold = self.threshold(front);
        let report = Ransac::new(Msac::within(threshold))
            .constraint(Refusing(RadiusWindow::new(least, most).ok()?))
            .constraint(Refusing(CenterSide::positive(behind)))
            .stopping(FixedCount::new(DRAWS).max_draws(4 * DRAWS))
            .min_inliers(8)
            .run(&SphereEstimator::new(points, SphereRefit::Geometric), rng)
            .ok()?;
        let weight = self.sigma(front).powi(-2);
        let wide = RadiusPrior::new(0.5 * (least + most), 0.5 * (most - least)).ok()?;
        let mut sphere = report.model;
        for _ in 0..2 {
            let mut near = std::mem::take(&mut readings.near);
            near.clear();
            let of_it = |i: &usize| sphere.signed_distance(&readings.point(*i)).abs() <= threshold;
            near.extend((0..readings.len()).filter(of_it));
            let weighted = near.iter().map(|&i| (readings.point(i), weight));
            let mut refined = sphere_weighted(weighted.clone(), &sphere, Some(wide));
            if let Some(beyond) = refined.filter(|s| !(least..=most).contains(&s.radius)) {
                // Little of the surface leaves the radius open: the nearest one within the bounds will do.
                let held = RadiusPrior::new(beyond.radius.clamp(least, most), HELD_M).ok()?;
                refined = sphere_weighted(weighted, &sphere, Some(held));
            }
            readings.near = near;
            sphere = refined?;
        }
        let within = (0.95 * least..=1.05 * most).contains(&sphere.radius);
        (within && sphere.center.z > front).then_some(sphere)
    }

    /// Standard deviation of the radius, metres, by the readings of the last refit and the prior.
    fn radius_sd(&self, sphere: &Sphere, readings: &GridReadings) -> f64 {
        let weight = self.sigma(sphere.center.z).powi(-2);
        let mut information = Matrix4::zeros();
        for &i in &readings.near {
            let Some(n) = (readings.point(i) - sphere.center).try_normalize(1e-9) else {
                continue;
            };
            let row = Vector4::new(n.x, n.y, n.z, 1.0);
            information += weight * row * row.transpose();
        }
        let half = 0.5 * (self.radii.most - self.radii.least);
        information[(3, 3)] += half.powi(-2);
        information.try_inverse().map_or(half, |covariance| {
            covariance[(3, 3)].max(0.0).sqrt().min(half)
        })
    }
}
