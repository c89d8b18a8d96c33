//! The branch: lines looked at closely, refined and ranked.

use super::axis::{Axis, Parabola, Sample, powers};
use super::lines::{Reach, guesses};
use super::shell::Shell;
use super::strips::{StripRules, strips};
use super::walk::{Pace, Slice, walk};
use crate::config::RobustConfig;
use crate::optics::{Projection, depth_jump_m};
use nalgebra::{Point3, Unit, Vector3};
use pomona_geometry::Sphere;

/// What a walk along an axis found, as lengths in metres.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Shows, as wide as the whole and at its place.
    pub(crate) shown: f64,
    /// Of that, on the side of the foot on which less shows.
    pub(crate) shown_lesser_side: f64,
    /// Something else of its depth shows.
    pub(crate) odd: f64,
    /// Nothing is there.
    pub(crate) empty: f64,
    /// Something nearer hides it.
    pub(crate) hidden: f64,
    /// Pixels that show it.
    pub(crate) pixels: usize,
}

impl Tally {
    /// What candidates are ranked by. What is not there counts most against a candidate, then what is not like
    /// a branch; what is hidden hardly counts.
    fn score(&self) -> f64 {
        self.shown + self.shown_lesser_side - 1.4 * self.empty - 0.8 * self.odd - 0.1 * self.hidden
    }
}

/// A branch candidate after refinement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    pub(crate) axis: Axis,
    /// Point of the axis nearest to the apple's centre.
    pub(crate) foot: Point3<f64>,
    pub(crate) tangent: Unit<Vector3<f64>>,
    /// Of the foot from the centre.
    pub(crate) distance: f64,
    pub(crate) tally: Tally,
    /// The tally's score as a share of the length looked at.
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
struct Round {
    step: f64,
    tolerance: f64,
    growth: f64,
    kept: usize,
}

/// Coarse looks at many lines, then fine ones at few.
const ROUNDS: [Round; 5] = [
    Round {
        step: 0.004,
        tolerance: 0.004,
        growth: 0.10,
        kept: 14,
    },
    Round {
        step: 0.004,
        tolerance: 0.002,
        growth: 0.06,
        kept: 8,
    },
    Round {
        step: 0.003,
        tolerance: 0.001,
        growth: 0.03,
        kept: 4,
    },
    Round {
        step: 0.003,
        tolerance: 0.001,
        growth: 0.02,
        kept: 4,
    },
    Round {
        step: 0.002,
        tolerance: 0.001,
        growth: 0.02,
        kept: 4,
    },
];

impl Search<'_> {
    /// The branches about the apple, best first.
    pub(crate) fn candidates(&self, slices: &mut Vec<(f64, Slice)>) -> Vec<Candidate> {
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
        let reach: Reach = (0.8 * config.branch_near * r, 1.2 * config.branch_far * r);
        let guesses = guesses(&pieces, &self.apple.center, reach, config.branch_guesses);
        let axes = guesses.iter().filter_map(|guess| {
            let mut axis = Axis::straight(&guess.line, &self.apple.center, guess.half_width)?;
            // Strips lie on the surface: the axis is half a thickness behind, on average over the width.
            axis.depthways[0] = std::f64::consts::FRAC_PI_4 * guess.half_width;
            Some(axis)
        });
        let mut axes: Vec<Axis> = axes.collect();
        let mut ranked = Vec::new();
        for round in &ROUNDS {
            ranked = axes
                .iter()
                .filter_map(|axis| self.refine(*axis, round, slices))
                .collect();
            keep_best(&mut ranked, round.kept);
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
        slices: &mut Vec<(f64, Slice)>,
        pixels: &mut Vec<u32>,
    ) {
        let pace = self.pace(&candidate.axis, &ROUNDS[ROUNDS.len() - 1]);
        walk(
            self.shell,
            self.projection,
            &candidate.axis,
            &pace,
            slices,
            Some(pixels),
        );
        pixels.sort_unstable();
        pixels.dedup();
    }

    fn pace(&self, axis: &Axis, round: &Round) -> Pace {
        Pace {
            reach: self.config.branch_reach * self.apple.radius,
            step: round.step,
            tolerance: round.tolerance + 3.0 * self.sigma + 0.4 * axis.radius,
            growth: round.growth,
        }
    }

    /// Walks along an axis, moves it to what shows, and counts what speaks for it.
    fn refine(
        &self,
        mut axis: Axis,
        round: &Round,
        slices: &mut Vec<(f64, Slice)>,
    ) -> Option<Candidate> {
        let r = self.apple.radius;
        let pace = self.pace(&axis, round);
        walk(self.shell, self.projection, &axis, &pace, slices, None);
        let pixel = self.projection.pixel_m(axis.base.z);
        let moved = self.fit(&mut axis, slices, pixel)?;
        let radii = self.config.branch_radius_min_m..=self.config.branch_radius_max_m;
        if !radii.contains(&axis.radius) {
            return None;
        }
        let s = axis.nearest(&self.apple.center, 1.5 * r);
        let tally = self.count(&axis, &moved, slices, round.step, s, pixel);
        let foot = axis.at(s);
        Some(Candidate {
            axis,
            foot,
            tangent: axis.tangent(s),
            distance: (foot - self.apple.center).norm(),
            tally,
            score: tally.score() / (2.0 * pace.reach),
            foot_sd: moved.side.sd_at(s).hypot(moved.deep.sd_at(s)),
            rms: moved.deep.rms,
        })
    }

    /// Scale of the depths of slices about the axis.
    fn deep_scale(&self) -> f64 {
        0.4 * self.sigma + 0.0005
    }

    /// Moves the axis to the middle of the slices, and its radius to half of their width.
    fn fit(&self, axis: &mut Axis, slices: &[(f64, Slice)], pixel: f64) -> Option<Moved> {
        const FIRST_CUTS: [f64; 4] = [20.0, 8.0, 3.0, 3.0];
        let cuts = |slices: &'_ [(f64, Slice)]| {
            let cuts = slices.iter().filter_map(|(s, slice)| match slice {
                Slice::Thing(cut) => Some((*s, *cut)),
                _ => None,
            });
            cuts.collect::<Vec<_>>()
        };
        let cuts = cuts(slices);
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
        axis.sideways += side.coefficients;
        axis.depthways += deep.coefficients;
        Some(Moved { side, deep })
    }

    fn count(
        &self,
        axis: &Axis,
        moved: &Moved,
        slices: &[(f64, Slice)],
        step: f64,
        foot: f64,
        pixel: f64,
    ) -> Tally {
        let mut tally = Tally::default();
        let width = 2.0 * axis.radius;
        let (mut before, mut after) = (0.0, 0.0);
        for (s, slice) in slices {
            let cut = match slice {
                Slice::Thing(cut) => cut,
                Slice::Hidden => {
                    tally.hidden += step;
                    continue;
                }
                Slice::Empty => {
                    tally.empty += step / (1.0 + (s / (EMPTY_NEAR * self.apple.radius)).powi(4));
                    continue;
                }
                Slice::Outside => continue,
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
                tally.pixels += cut.pixels;
                *(if *s < foot { &mut before } else { &mut after }) += share * step;
            } else {
                tally.odd += step;
            }
        }
        tally.shown = before + after;
        tally.shown_lesser_side = f64::min(before, after);
        tally
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
