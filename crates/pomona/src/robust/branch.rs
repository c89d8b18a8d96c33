//! The branch: lines looked at closely, refined and ranked.

use super::axis::{BranchAxis, Parabola, Sample, powers};
use super::line_hypothesis::{DistanceRange, line_hypotheses};
use super::shell::Shell;
use super::strips::{StripRules, strips};
use super::cross_section::{SectionSpacing, CrossSection, cross_sections};
use crate::config::RobustConfig;
use crate::optics::{Projection, depth_jump_m};
use nalgebra::{Point3, Unit, Vector3};
use pomona_geometry::Sphere;

/// What a cross_sections along an axis found, as lengths in metres.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AxisSupport {
    /// Shows, as wide as the whole and at its place.
    pub(crate) visible: f64,
    /// Of that, on the side of the foot on which less shows.
    pub(crate) visible_shorter_side: f64,
    /// Something else of its depth shows.
    pub(crate) atypical: f64,
    /// Nothing is there.
    pub(crate) empty: f64,
    /// Something nearer hides it.
    pub(crate) hidden: f64,
    /// Pixels that show it.
    pub(crate) pixels: usize,
}

impl AxisSupport {
    /// What candidates are ranked by. What is not there counts most against a candidate, then what is not like
    /// a branch; what is hidden hardly counts.
    fn score(&self) -> f64 {
        self.visible + self.visible_shorter_side - 1.4 * self.empty - 0.8 * self.atypical - 0.1 * self.hidden
    }
}

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
    /// The support's score as a share of the length looked at.
    pub(crate) score: f64,
    /// Standard deviation of the foot across the axis, metres.
    pub(crate) foot_sd: f64,
    /// Root mean square of the depths about the axis' surface, metres.
    pub(crate) rms: f64,
}

/// What candidates are looked at with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search<'a> {
    pub(crate) shell: &'a Shell,
    pub(crate) projection: &'a Projection<'a>,
    pub(crate) apple: Sphere,
    /// Standard deviation of a reading at the apple's depth.
    pub(crate) sigma: f64,
    pub(crate) config: &'a RobustConfig,
}

/// One look: how far apart places are, and by how much depths may differ.
struct RefinementPass {
    step: f64,
    tolerance: f64,
    growth: f64,
    kept: usize,
}

/// Coarse looks at many lines, then fine ones at few.
const PASSES: [RefinementPass; 5] = [
    RefinementPass {
        step: 0.004,
        tolerance: 0.004,
        growth: 0.10,
        kept: 14,
    },
    RefinementPass {
        step: 0.004,
        tolerance: 0.002,
        growth: 0.06,
        kept: 8,
    },
    RefinementPass {
        step: 0.003,
        tolerance: 0.001,
        growth: 0.03,
        kept: 4,
    },
    RefinementPass {
        step: 0.003,
        tolerance: 0.001,
        growth: 0.02,
        kept: 4,
    },
    RefinementPass {
        step: 0.002,
        tolerance: 0.001,
        growth: 0.02,
        kept: 4,
    },
];

impl Search<'_> {
    /// The branches about the apple, best first.
    pub(crate) fn candidates(&self, sections: &mut Vec<(f64, CrossSection)>) -> Vec<Candidate> {
        let (r, config) = (self.apple.radius, self.config);
        let rules = StripRules {
            width_max: 2.3 * config.branch_radius_max_m,
            piece: 0.012,
            bridge: 3,
            jump: depth_jump_m(self.sigma, JUMP_SIGMAS) as f32,
            step: 1,
        };
        let off = |p: &Point3<f64>| (p - self.apple.center).norm();
        let mut pieces = strips(self.shell, &rules, self.projection.pixel_m(1.0));
        let widths = config.branch_radius_min_m..=config.branch_radius_max_m;
        pieces.retain(|s| widths.contains(&s.half_width) && off(&s.middle) < 3.3 * r);
        pieces.sort_by(|a, b| off(&a.middle).total_cmp(&off(&b.middle)));
        pieces.truncate(MOST_STRIPS);
        let reach: DistanceRange = (0.8 * config.branch_near * r, 1.2 * config.branch_far * r);
        let line_hypotheses = line_hypotheses(&pieces, &self.apple.center, reach, config.branch_guesses);
        let axes = line_hypotheses.iter().filter_map(|hypothesis| {
            let mut axis = BranchAxis::straight(&hypothesis.line, &self.apple.center, hypothesis.half_width)?;
            // Strips lie on the surface: the axis is half a thickness behind, on average over the width.
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
        ranked
    }

    /// Adds the pixels that show a candidate.
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
            tolerance: pass.tolerance + 3.0 * self.sigma + 0.4 * axis.radius,
            growth: pass.growth,
        }
    }

    /// Walks along an axis, moves it to what shows, and counts what speaks for it.
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
        let moved = self.fit(&mut axis, sections, pixel)?;
        let radii = self.config.branch_radius_min_m..=self.config.branch_radius_max_m;
        if !radii.contains(&axis.radius) {
            return None;
        }
        let s = axis.nearest(&self.apple.center, 1.5 * r);
        let support = self.count(&axis, &moved, sections, pass.step, s, pixel);
        let foot = axis.at(s);
        Some(Candidate {
            axis,
            foot,
            tangent: axis.tangent(s),
            distance: (foot - self.apple.center).norm(),
            support,
            score: support.score() / (2.0 * spacing.reach),
            foot_sd: moved.side.sd_at(s).hypot(moved.deep.sd_at(s)),
            rms: moved.deep.rms,
        })
    }

    /// Scale of the depths of sections about the axis.
    fn deep_scale(&self) -> f64 {
        0.4 * self.sigma + 0.0005
    }

    /// Moves the axis to the middle of the sections, and its radius to half of their width.
    fn fit(&self, axis: &mut BranchAxis, sections: &[(f64, CrossSection)], pixel: f64) -> Option<Moved> {
        const FIRST_CUTS: [f64; 4] = [20.0, 8.0, 3.0, 3.0];
        let cuts = |sections: &'_ [(f64, CrossSection)]| {
            let cuts = sections.iter().filter_map(|(s, section)| match section {
                CrossSection::Object(cut) => Some((*s, *cut)),
                _ => None,
            });
            cuts.collect::<Vec<_>>()
        };
        let cuts = cuts(sections);
        let whole = cuts.iter().filter(|(_, cut)| cut.own == (true, true));
        let mut widths: Vec<f64> = whole.map(|(_, cut)| cut.width()).collect();
        // Where too little shows with both ends, the width that it was thought to have counts as well.
        widths.resize(widths.len().max(3), 2.0 * axis.radius);
        let middle = widths.len() / 2;
        let (_, width, _) = widths.select_nth_unstable_by(middle, f64::total_cmp);
        let width = *width;
        axis.radius = 0.5 * width;

        let (mut side, mut deep) = (Vec::new(), Vec::new());
        for (s, cut) in &cuts {
            let near = 1.0 / (1.0 + (s / (1.8 * self.apple.radius)).powi(4));
            let like = (cut.width() - width).abs() < 0.3 * width + 1.2 * pixel;
            let both = cut.own == (true, true);
            let weight = if both && like { near } else { 0.3 * near };
            let enough = if both {
                like
            } else {
                cut.width() > 0.3 * width
            };
            if let Some(value) = cut.middle(width).filter(|_| enough) {
                side.push(Sample {
                    s: *s,
                    value,
                    weight,
                });
            }
            if like || cut.width() < width {
                deep.push(Sample {
                    s: *s,
                    value: cut.deep,
                    weight: if both && like { near } else { 0.4 * near },
                });
            }
        }
        let bend = self.config.branch_bend_sd_per_m;
        let deep = Parabola::fit(&deep, bend, self.deep_scale(), &FIRST_CUTS)?;
        let side = Parabola::fit(&side, bend, 0.4 * pixel + 0.0003, &FIRST_CUTS)?;
        axis.lateral += side.coefficients;
        axis.depth_offset += deep.coefficients;
        Some(Moved { side, deep })
    }

    fn count(
        &self,
        axis: &BranchAxis,
        moved: &Moved,
        sections: &[(f64, CrossSection)],
        step: f64,
        foot: f64,
        pixel: f64,
    ) -> AxisSupport {
        let mut support = AxisSupport::default();
        let width = 2.0 * axis.radius;
        let (mut before, mut after) = (0.0, 0.0);
        for (s, section) in sections {
            let cut = match section {
                CrossSection::Object(cut) => cut,
                CrossSection::Hidden => {
                    support.hidden += step;
                    continue;
                }
                CrossSection::Empty => {
                    support.empty += step / (1.0 + (s / (EMPTY_NEAR * self.apple.radius)).powi(4));
                    continue;
                }
                CrossSection::Outside => continue,
            };
            let p = powers(*s);
            let aside = moved.side.coefficients.dot(&p);
            let deep = (cut.deep - moved.deep.coefficients.dot(&p)).abs();
            let near = 0.2 * axis.radius + pixel;
            let ends = (
                cut.own.0 && (cut.ends.0 + axis.radius - aside).abs() < near,
                cut.own.1 && (cut.ends.1 - axis.radius - aside).abs() < near,
            );
            let deep_limit = 0.1 * axis.radius + 3.0 * self.deep_scale();
            let both = cut.own == (true, true);
            let like = if both {
                (cut.width() - width).abs() < 0.3 * width + 1.5 * pixel
            } else {
                cut.width() < width + 1.5 * pixel
            };
            let middle = cut.middle(width).map_or(0.0, |m| m - aside);
            let share = if like && middle.abs() < near && deep < deep_limit {
                1.0
            } else if (ends.0 || ends.1) && deep < 2.0 * deep_limit {
                HALF_SHOWN
            } else {
                0.0
            };
            if share > 0.0 {
                support.pixels += cut.pixels;
                *(if *s < foot { &mut before } else { &mut after }) += share * step;
            } else {
                support.atypical += step;
            }
        }
        support.visible = before + after;
        support.visible_shorter_side = f64::min(before, after);
        support
    }
}

/// Standard deviations of a reading between neighbours on different things.
const JUMP_SIGMAS: f64 = 5.0;

/// Radii of the apple within which it counts fully that nothing is there: farther off a branch may end.
const EMPTY_NEAR: f64 = 2.2;

/// What a length counts for on which one end shows at its place and the other is lost in something beside it.
const HALF_SHOWN: f64 = 0.4;

/// Most strips that lines are put together from: the nearest ones.
const MOST_STRIPS: usize = 120;

/// By how much an axis was moved.
struct Moved {
    side: Parabola,
    deep: Parabola,
}

/// Sorts by score and drops what is like something better.
fn keep_best(candidates: &mut Vec<Candidate>, most: usize) {
    candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: Vec<Candidate> = Vec::with_capacity(most);
    for c in candidates.iter() {
        let alike = |k: &Candidate| {
            k.tangent.dot(&c.tangent).abs() > 0.985
                && (k.foot - c.foot).norm() < 0.003 + 0.4 * k.axis.radius
        };
        if kept.len() < most && !kept.iter().any(alike) {
            kept.push(*c);
        }
    }
    *candidates = kept;
}
