//! The branch: line hypotheses refined into curved axes and ranked by what their cross-sections show.
//!
//! Constants here that name no source were set by hand on the tuning scenes (seeds 200 and up of `orchard`, `harsh`
//! and `harsh-kinect`); `cargo xtask ablate` shows what the ideas behind them are worth, and the goldens hold them.

use super::axis::BranchAxis;
use super::axis_fit::{AxisFit, AxisSupport};
use super::cross_section::{CrossSection, SectionSpacing, cross_sections};
use super::line_hypothesis::{DistanceRange, line_hypotheses};
use super::shell::Shell;
use super::strips::{StripRules, strips};
use crate::config::RobustConfig;
use crate::optics::{Projection, depth_jump_m};
use nalgebra::{Point3, Unit, Vector3};
use pomona_geometry::Sphere;

/// A branch candidate after refinement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    pub(crate) axis: BranchAxis,
    /// Point of the axis nearest to the apple's centre.
    pub(crate) foot: Point3<f64>,
    pub(crate) tangent: Unit<Vector3<f64>>,
    /// Of the foot from the centre.
    pub(crate) distance: f64,
    pub(crate) support: AxisSupport,
    /// Score of the support per metre of inspected axis, 1 at best.
    pub(crate) score: f64,
    /// Standard deviation of the foot across the axis, metres.
    pub(crate) foot_sd: f64,
    /// Root mean square of the depths about the axis' surface, metres.
    pub(crate) rms: f64,
}

/// Everything that the search for branches reads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search<'a> {
    pub(crate) shell: &'a Shell,
    pub(crate) projection: &'a Projection<'a>,
    pub(crate) apple: Sphere,
    /// Standard deviation of a reading at the apple's depth.
    pub(crate) sigma: f64,
    pub(crate) config: &'a RobustConfig,
}

/// One pass of the refinement over all candidates.
struct RefinementPass {
    /// Distance between cross-sections, metres.
    step: f64,
    /// Largest difference in depth between axis and object at the foot, metres, beside noise and thickness.
    tolerance: f64,
    /// Growth of that difference per metre along the axis: what the direction may be wrong by.
    growth: f64,
    /// Candidates that are kept.
    kept: usize,
}

/// Coarse passes over many candidates, then fine ones over few.
const PASSES: [RefinementPass; 5] = [
    RefinementPass {
        step: 0.004,
        tolerance: 0.004,
        growth: 0.10,
        kept: 16,
    },
    RefinementPass {
        step: 0.004,
        tolerance: 0.002,
        growth: 0.06,
        kept: 10,
    },
    RefinementPass {
        step: 0.003,
        tolerance: 0.001,
        growth: 0.03,
        kept: 6,
    },
    RefinementPass {
        step: 0.003,
        tolerance: 0.001,
        growth: 0.02,
        kept: 6,
    },
    RefinementPass {
        step: 0.002,
        tolerance: 0.001,
        growth: 0.02,
        kept: 6,
    },
];

impl Search<'_> {
    /// The branch candidates about the apple, best first.
    pub(crate) fn candidates(&self, sections: &mut Vec<(f64, CrossSection)>) -> Vec<Candidate> {
        let (r, config) = (self.apple.radius, self.config);
        let rules = StripRules {
            width_max: WIDEST_CROSSING * config.branch_radius_max_m,
            piece: STRIP_LENGTH_M,
            bridge: STRIP_BRIDGE_PX,
            jump: depth_jump_m(self.sigma, JUMP_SIGMAS) as f32,
            step: 1,
        };
        let off = |p: &Point3<f64>| (p - self.apple.center).norm();
        let mut pieces = strips(self.shell, &rules, self.projection.pixel_m(1.0));
        let widths = config.branch_radius_min_m..=config.branch_radius_max_m;
        pieces.retain(|s| widths.contains(&s.half_width) && off(&s.middle) < STRIP_RANGE_RADII * r);
        pieces.sort_by(|a, b| off(&a.middle).total_cmp(&off(&b.middle)));
        pieces.truncate(MOST_STRIPS);
        let (inner, outer) = HYPOTHESIS_WINDOW;
        let range: DistanceRange = (
            inner * config.branch_near * r,
            outer * config.branch_far * r,
        );
        let hypotheses = line_hypotheses(&pieces, &self.apple.center, range, config.branch_guesses);
        let axes = hypotheses.iter().filter_map(|hypothesis| {
            let mut axis =
                BranchAxis::straight(&hypothesis.line, &self.apple.center, hypothesis.half_width)?;
            // Strips lie on the surface: the axis is π/4 of the radius behind it, on average over the width.
            axis.depth_offset[0] = std::f64::consts::FRAC_PI_4 * hypothesis.half_width;
            Some(axis)
        });
        let mut axes: Vec<BranchAxis> = axes.collect();
        let mut ranked = Vec::new();
        for pass in &PASSES {
            ranked = axes
                .iter()
                .filter_map(|axis| self.refine(*axis, pass, sections))
                .collect();
            keep_best(&mut ranked, pass.kept);
            axes = ranked.iter().map(|c: &Candidate| c.axis).collect();
        }
        ranked
            .retain(|c| c.distance > config.branch_near * r && c.distance < config.branch_far * r);
        ranked.retain(|c| c.distance - c.axis.radius > DEEPEST_RADII * r);
        self.compare(&mut ranked);
        ranked
    }

    /// Measures how much of each candidate's visible length one with a better score shows as well, and by how much the
    /// scores of those beside it are above its own: leaves and spurs grow beside branches. They come best first.
    fn compare(&self, ranked: &mut [Candidate]) {
        let reach = self.config.branch_reach * self.apple.radius;
        let step = PASSES[PASSES.len() - 1].step;
        let n = (reach / step) as usize;
        for k in 1..ranked.len() {
            let (better, rest) = ranked.split_at_mut(k);
            let candidate = &mut rest[0];
            let offset = candidate.foot - self.apple.center;
            candidate.support.outdone = BESIDE_RAD.map(|most| {
                let beside = |c: &&Candidate| (c.foot - self.apple.center).angle(&offset) < most;
                better
                    .iter()
                    .find(beside)
                    .map_or(0.0, |c| c.score - candidate.score)
            });
            let mut shared = 0;
            for number in 0..=2 * n {
                if !candidate.support.visible_sections.contains(number) {
                    continue;
                }
                let at = candidate.axis.at((number as f64 - n as f64) * step);
                let shows = |other: &Candidate| {
                    let along = other.axis.along(&at);
                    let near = (at - other.axis.at(along)).norm()
                        < SHARED_RADII * other.axis.radius + SHARED_M;
                    let place = (along / step).round() + n as f64;
                    near && place >= 0.0 && other.support.visible_sections.contains(place as usize)
                };
                if better.iter().any(shows) {
                    shared += 1;
                }
            }
            candidate.support.shared = f64::from(shared) * step;
        }
    }

    /// Adds the pixels that support a candidate.
    pub(crate) fn pixels(
        &self,
        candidate: &Candidate,
        sections: &mut Vec<(f64, CrossSection)>,
        pixels: &mut Vec<u32>,
    ) {
        let spacing = self.spacing(&candidate.axis, &PASSES[PASSES.len() - 1]);
        cross_sections(
            self.shell,
            self.projection,
            &candidate.axis,
            &spacing,
            sections,
            Some(pixels),
        );
        pixels.sort_unstable();
        pixels.dedup();
    }

    fn spacing(&self, axis: &BranchAxis, pass: &RefinementPass) -> SectionSpacing {
        SectionSpacing {
            reach: self.config.branch_reach * self.apple.radius,
            step: pass.step,
            tolerance: pass.tolerance
                + DEPTH_TOLERANCE_SIGMAS * self.sigma
                + DEPTH_TOLERANCE_RADII * axis.radius,
            growth: pass.growth,
        }
    }

    /// Fits an axis to its cross-sections and measures their support for it; `None` where it cannot be a branch.
    fn refine(
        &self,
        mut axis: BranchAxis,
        pass: &RefinementPass,
        sections: &mut Vec<(f64, CrossSection)>,
    ) -> Option<Candidate> {
        let r = self.apple.radius;
        let spacing = self.spacing(&axis, pass);
        cross_sections(self.shell, self.projection, &axis, &spacing, sections, None);
        let pixel = self.projection.pixel_m(axis.base.z);
        let fit = AxisFit {
            apple_radius: r,
            bend_sd_per_m: self.config.branch_bend_sd_per_m,
            sigma: self.sigma,
            pixel,
        };
        let moved = fit.fit(&mut axis, sections)?;
        let radii = self.config.branch_radius_min_m..=self.config.branch_radius_max_m;
        if !radii.contains(&axis.radius) {
            return None;
        }
        let s = axis.nearest(&self.apple.center, FOOT_RANGE_RADII * r);
        let support = fit.support(&axis, &moved, sections, pass.step, s);
        let foot = axis.at(s);
        Some(Candidate {
            axis,
            foot,
            tangent: axis.tangent(s),
            distance: (foot - self.apple.center).norm(),
            support,
            score: support.score() / (2.0 * spacing.reach),
            foot_sd: moved.lateral.sd_at(s).hypot(moved.depth.sd_at(s)),
            rms: moved.depth.rms,
        })
    }
}

/// Standard deviations of a reading between neighbours on different things.
const JUMP_SIGMAS: f64 = 5.0;

/// Strips that line hypotheses are made from at most: the nearest ones.
const MOST_STRIPS: usize = 120;

/// Distance from the apple's centre up to which strips are used, radii of the apple.
const STRIP_RANGE_RADII: f64 = 3.3;

/// Widest crossing of a row of pixels with a branch, as a factor of the largest branch radius: its diameter, and 15 %
/// for noise and a slant.
const WIDEST_CROSSING: f64 = 2.3;

/// Length of the straight pieces that chains of crossings are cut into, metres.
const STRIP_LENGTH_M: f64 = 0.012;

/// Missing readings that a crossing bridges, pixels.
const STRIP_BRIDGE_PX: usize = 3;

/// Factors by which the window on the distance of the axis is widened for hypotheses, which are refined afterwards.
const HYPOTHESIS_WINDOW: (f64, f64) = (0.8, 1.2);

/// Distance along the axis within which its point nearest to the apple is sought, radii of the apple.
const FOOT_RANGE_RADII: f64 = 1.5;

/// Standard deviations of a reading that the difference in depth between axis and object may amount to.
const DEPTH_TOLERANCE_SIGMAS: f64 = 3.0;

/// Share of the branch's radius by which its surface may lie before or behind that of a cylinder.
const DEPTH_TOLERANCE_RADII: f64 = 0.4;

/// Least distance of a branch's surface from the apple's centre, radii of the apple: nothing passes through an apple. It
/// is less than 1 for errors of both fits; of 3000 candidates on the tuning scenes whose foot was right to 0.15 radii,
/// fewer than 0.3 % lie deeper.
const DEEPEST_RADII: f64 = 0.93;

/// Angles between the directions of two candidates up to which one is beside the other, radians (34° and 63°).
const BESIDE_RAD: [f64; 2] = [0.6, 1.1];

/// Distance from a candidate's axis at which a section of another one shows the same object: radii of the branch, …
const SHARED_RADII: f64 = 1.0;

/// … and metres.
const SHARED_M: f64 = 0.002;

/// Two candidates are the same branch where the cosine of the angle between their tangents exceeds this (10°) …
const SAME_BRANCH_COS: f64 = 0.985;

/// … and their feet are nearer to each other than this, metres, …
const SAME_BRANCH_FOOT_M: f64 = 0.003;

/// … and this share of the better one's radius.
const SAME_BRANCH_FOOT_RADII: f64 = 0.4;

/// Sorts by score and drops every candidate that is the same branch as a better one.
fn keep_best(candidates: &mut Vec<Candidate>, most: usize) {
    candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: Vec<Candidate> = Vec::with_capacity(most);
    for c in candidates.iter() {
        let alike = |k: &Candidate| {
            k.tangent.dot(&c.tangent).abs() > SAME_BRANCH_COS
                && (k.foot - c.foot).norm()
                    < SAME_BRANCH_FOOT_M + SAME_BRANCH_FOOT_RADII * k.axis.radius
        };
        if kept.len() < most && !kept.iter().any(alike) {
            kept.push(*c);
        }
    }
    *candidates = kept;
}
