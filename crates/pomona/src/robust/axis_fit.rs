//! Fitting an axis to its cross-sections, and what they say about it.
//!
//! Constants that name no source were set by hand, like those of [`branch`](super::branch).

use super::axis::{BranchAxis, Observation, Parabola, powers};
use super::cross_section::{CrossSection, ObjectSection, Roundness};
use super::section_set::SectionSet;

/// Cut-offs of the robust weight for each step of a parabola's fit, standard deviations: wide first, since the
/// hypothesis may be off by its tolerance.
const CUTOFFS: [f64; 4] = [20.0, 8.0, 3.0, 3.0];

/// Fewest sections with both edges whose median width is taken alone.
const LEAST_WHOLE_SECTIONS: usize = 3;

/// Distance from the foot at which a section counts half in a fit, radii of the apple.
const FIT_RANGE_RADII: f64 = 1.8;

/// Relative difference of widths that are taken for equal.
const WIDTH_TOLERANCE: f64 = 0.3;

/// The same in pixels, in addition: for a fit, and for the support.
const FIT_WIDTH_PX: f64 = 1.2;
const SUPPORT_WIDTH_PX: f64 = 1.5;

/// Weight in the lateral fit of a section with one edge, or of another width.
const ONE_EDGE_WEIGHT: f64 = 0.3;

/// Its weight in the fit of the depths.
const ONE_EDGE_DEPTH_WEIGHT: f64 = 0.4;

/// Least width, as a share of the branch's, with which a section that has one edge is used.
const LEAST_WIDTH: f64 = 0.3;

/// Standard deviation of a section's depth: as a share of a reading's, which several pixels average, …
const SECTION_DEPTH_SIGMAS: f64 = 0.4;

/// … and of the branch's surface, metres.
const SECTION_DEPTH_SD_M: f64 = 0.0005;

/// Standard deviation of a section's centre: pixels, …
const SECTION_LATERAL_PX: f64 = 0.4;

/// … and metres.
const SECTION_LATERAL_SD_M: f64 = 0.0003;

/// Radii of the apple at which an empty section counts half: farther off a branch may end.
const EMPTY_RANGE_RADII: f64 = 2.2;

/// Distance of an edge or centre from its place that is tolerated, beside a pixel, radii of the branch.
const EDGE_TOLERANCE: f64 = 0.2;

/// Distance in depth that is tolerated: radii of the branch, …
const DEPTH_TOLERANCE: f64 = 0.1;

/// … and standard deviations of a section's depth.
const DEPTH_TOLERANCE_SDS: f64 = 3.0;

/// What a section counts with one edge in place, the other being lost in something beside it.
const ONE_EDGE_SHARE: f64 = 0.4;

/// Distance from the foot within which the support is that at the foot, radii of the apple.
const FOOT_STRETCH_RADII: f64 = 0.6;

/// Weight of empty length in the score: a branch that is not there.
const EMPTY_PENALTY: f64 = 1.4;

/// Weight of atypical length: something of its depth that has not its width.
const ATYPICAL_PENALTY: f64 = 0.8;

/// Weight of occluded length, which says little.
const OCCLUDED_PENALTY: f64 = 0.1;

/// Lengths of an axis by what its cross-sections show, metres.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AxisSupport {
    /// The branch, as wide as the whole and in its place.
    pub(crate) visible: f64,
    /// Of that, on the side of the foot on which less is visible.
    pub(crate) visible_shorter_side: f64,
    /// Something else at its depth.
    pub(crate) atypical: f64,
    /// Nothing.
    pub(crate) empty: f64,
    /// Something nearer.
    pub(crate) occluded: f64,
    /// Pixels that show the branch.
    pub(crate) pixels: usize,
    /// Of the visible length, that with both edges in place.
    pub(crate) whole: f64,
    /// Empty length on the side of the foot with less of it.
    pub(crate) empty_shorter_side: f64,
    /// Visible length about the foot, within `FOOT_STRETCH_RADII`.
    pub(crate) visible_at_foot: f64,
    /// Empty and atypical length there.
    pub(crate) missing_at_foot: f64,
    /// Sum of the squares of the relative differences of the widths from the branch's, times their lengths.
    pub(crate) uneven: f64,
    /// How round the visible sections are.
    pub(crate) roundness: Roundness,
    /// Longest stretch of the visible length without a gap.
    pub(crate) longest: f64,
    /// Number of such stretches.
    pub(crate) stretches: usize,
    /// Width of a pixel at the axis, metres.
    pub(crate) pixel: f64,
    /// Which of the sections are visible, the first ones of them.
    pub(crate) visible_sections: SectionSet,
    /// Visible length that a candidate with a better score shows as well.
    pub(crate) shared: f64,
    /// By how much the best score of the candidates in nearly the same direction is above its own, and of those in a
    /// similar one.
    pub(crate) outdone: [f64; 2],
}

impl AxisSupport {
    /// What candidates are ranked by. Empty sections are penalised most, then those unlike a branch; occluded ones
    /// hardly at all.
    pub(crate) fn score(&self) -> f64 {
        self.visible + self.visible_shorter_side
            - EMPTY_PENALTY * self.empty
            - ATYPICAL_PENALTY * self.atypical
            - OCCLUDED_PENALTY * self.occluded
    }

    /// Length that was inspected.
    pub(crate) fn inspected(&self) -> f64 {
        self.visible + self.atypical + self.empty + self.occluded
    }
}

/// By how much an axis was moved by a fit.
pub(crate) struct AxisShift {
    pub(crate) lateral: Parabola,
    pub(crate) depth: Parabola,
}

/// The scales of a fit. Metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisFit {
    pub(crate) apple_radius: f64,
    /// Standard deviation of a branch's bend.
    pub(crate) bend_sd_per_m: f64,
    /// Standard deviation of a reading at the apple's depth.
    pub(crate) sigma: f64,
    /// Width of a pixel at the axis.
    pub(crate) pixel: f64,
}

impl AxisFit {
    /// Standard deviation of a section's depth about the axis, metres.
    fn depth_sd(&self) -> f64 {
        SECTION_DEPTH_SIGMAS * self.sigma + SECTION_DEPTH_SD_M
    }

    /// Moves the axis to the centres of the sections and sets its radius to half of their median width.
    ///
    /// `None` where too few sections show an object.
    pub(crate) fn fit(
        &self,
        axis: &mut BranchAxis,
        sections: &[(f64, CrossSection)],
    ) -> Option<AxisShift> {
        let objects: Vec<(f64, ObjectSection)> = sections
            .iter()
            .filter_map(|(s, section)| match section {
                CrossSection::Object(object) => Some((*s, *object)),
                _ => None,
            })
            .collect();
        let whole = objects.iter().filter(|(_, object)| object.both_edges());
        let mut widths: Vec<f64> = whole.map(|(_, object)| object.width()).collect();
        // With fewer than this many whole sections, the width so far counts as well.
        widths.resize(widths.len().max(LEAST_WHOLE_SECTIONS), 2.0 * axis.radius);
        let middle = widths.len() / 2;
        let (_, width, _) = widths.select_nth_unstable_by(middle, f64::total_cmp);
        let width = *width;
        axis.radius = 0.5 * width;

        let (mut lateral, mut depth) = (Vec::new(), Vec::new());
        for (s, object) in &objects {
            let near = 1.0 / (1.0 + (s / (FIT_RANGE_RADII * self.apple_radius)).powi(4));
            let like = (object.width() - width).abs()
                < WIDTH_TOLERANCE * width + FIT_WIDTH_PX * self.pixel;
            let both = object.both_edges();
            let weight = if both && like {
                near
            } else {
                ONE_EDGE_WEIGHT * near
            };
            let enough = if both {
                like
            } else {
                object.width() > LEAST_WIDTH * width
            };
            if let Some(value) = object.center(width).filter(|_| enough) {
                lateral.push(Observation {
                    s: *s,
                    value,
                    weight,
                });
            }
            if like || object.width() < width {
                depth.push(Observation {
                    s: *s,
                    value: object.depth_behind_axis,
                    weight: if both && like {
                        near
                    } else {
                        ONE_EDGE_DEPTH_WEIGHT * near
                    },
                });
            }
        }
        let bend = self.bend_sd_per_m;
        let depth = Parabola::fit(&depth, bend, self.depth_sd(), &CUTOFFS)?;
        let lateral_sd = SECTION_LATERAL_PX * self.pixel + SECTION_LATERAL_SD_M;
        let lateral = Parabola::fit(&lateral, bend, lateral_sd, &CUTOFFS)?;
        axis.lateral += lateral.coefficients;
        axis.depth_offset += depth.coefficients;
        Some(AxisShift { lateral, depth })
    }

    /// What the sections, `step` metres apart, say about the fitted axis; `foot` parts its two sides.
    pub(crate) fn support(
        &self,
        axis: &BranchAxis,
        moved: &AxisShift,
        sections: &[(f64, CrossSection)],
        step: f64,
        foot: f64,
    ) -> AxisSupport {
        let mut support = AxisSupport::default();
        let (mut before, mut after) = (0.0, 0.0);
        let mut empty = (0.0, 0.0);
        let width = 2.0 * axis.radius;
        for (number, (s, section)) in sections.iter().enumerate() {
            let at_foot = (s - foot).abs() < FOOT_STRETCH_RADII * self.apple_radius;
            let object = match section {
                CrossSection::Object(object) => object,
                CrossSection::Occluded => {
                    support.occluded += step;
                    continue;
                }
                CrossSection::Empty => {
                    support.empty +=
                        step / (1.0 + (s / (EMPTY_RANGE_RADII * self.apple_radius)).powi(4));
                    *(if *s < foot {
                        &mut empty.0
                    } else {
                        &mut empty.1
                    }) += step;
                    if at_foot {
                        support.missing_at_foot += step;
                    }
                    continue;
                }
                CrossSection::OutsideImage => continue,
            };
            let share = self.typical_share(axis, moved, *s, object);
            if share > 0.0 {
                support.pixels += object.pixels;
                support.visible_sections.insert(number);
                *(if *s < foot { &mut before } else { &mut after }) += share * step;
                if at_foot {
                    support.visible_at_foot += share * step;
                }
                support.roundness.product += object.roundness.product;
                support.roundness.square += object.roundness.square;
                if object.both_edges() {
                    support.whole += share * step;
                    support.uneven += step * (object.width() / width - 1.0).powi(2);
                }
            } else {
                support.atypical += step;
                if at_foot {
                    support.missing_at_foot += step;
                }
            }
        }
        support.visible = before + after;
        support.visible_shorter_side = f64::min(before, after);
        support.empty_shorter_side = f64::min(empty.0, empty.1);
        support.pixel = self.pixel;
        let (stretches, longest) = support.visible_sections.stretches();
        (support.stretches, support.longest) = (stretches, longest as f64 * step);
        support
    }

    /// Share to which a section at `s` is one of this branch: 1 with both edges in place, less with one, 0 with none.
    fn typical_share(
        &self,
        axis: &BranchAxis,
        moved: &AxisShift,
        s: f64,
        object: &ObjectSection,
    ) -> f64 {
        let (width, pixel) = (2.0 * axis.radius, self.pixel);
        let p = powers(s);
        let lateral = moved.lateral.coefficients.dot(&p);
        let depth = (object.depth_behind_axis - moved.depth.coefficients.dot(&p)).abs();
        let near = EDGE_TOLERANCE * axis.radius + pixel;
        let (left, right) = object.edges;
        let edges = (
            object.silhouette.0 && (left + axis.radius - lateral).abs() < near,
            object.silhouette.1 && (right - axis.radius - lateral).abs() < near,
        );
        let depth_limit = DEPTH_TOLERANCE * axis.radius + DEPTH_TOLERANCE_SDS * self.depth_sd();
        let as_wide = if object.both_edges() {
            (object.width() - width).abs() < WIDTH_TOLERANCE * width + SUPPORT_WIDTH_PX * pixel
        } else {
            object.width() < width + SUPPORT_WIDTH_PX * pixel
        };
        let center = object.center(width).map_or(0.0, |center| center - lateral);
        if as_wide && center.abs() < near && depth < depth_limit {
            1.0
        } else if (edges.0 || edges.1) && depth < 2.0 * depth_limit {
            ONE_EDGE_SHARE
        } else {
            0.0
        }
    }
}
