//! Branches in the colour image: what a segmenter takes for wood, followed as lines in the image, brought into space
//! by the depth that there is, and the nearest of them chosen.
//!
//! 1. **Crossings** (`crossings`): where a row or a column of pixels crosses something narrow that may be wood.
//! 2. **Lines** (`line`): through crossings, by the RANSAC engine; the distance from the apple is a constraint, and all
//!    distinct lines are candidates, not the best alone.
//! 3. **Evidence** (`evidence`): by how much a candidate's band stands out from what lies beside it, where it is nearest
//!    to the apple.
//! 4. **Depth** (`depth`): from the readings on the band. Where there are none, wood in front of the apple lies on it,
//!    and other wood about as far off as the apple.
//! 5. **Nearest first** (`robust::nearest`): the probability that a candidate is wood and that none of the nearer ones is.

mod crossings;
mod depth;
mod evidence;
mod line;
mod view;

use super::apple::SeenApple;
use super::axis::BranchAxis;
use super::axis_fit::AxisSupport;
use super::branch::Candidate;
use super::confidence::without_candidate;
use super::nearest::{Place, Ranked, by_distance};
use crate::optics::window_of_sphere;
use crate::outcome::Status;
use crossings::Crossings;
use depth::Lifted;
use evidence::{Band, Evidence};
use line::{ImageLine, image_lines};
use pomona_geometry::Sphere;
use rand_chacha::ChaCha8Rng;
pub(crate) use view::WoodSearch;
use view::{MARGIN_RADII, REACH_RADII};

/// Ratio of a box's sides from which it is not that of a whole apple.
const MOST_ASPECT: f64 = 1.5;

/// Distance between the fitted centre and the middle of the box up to which the box shows the whole apple, radii of
/// the apple.
const MOST_SHIFT_RADII: f64 = 0.6;

/// Probability from which a pixel is wood when its readings are counted.
const SURE_WOOD: f64 = 0.5;

/// Shares of the pixels of wood about an apple with a reading up to which depth may miss branches, and from which it
/// sees them. Rendered scenes without gaps have 0.92 and more about nearly every apple, those of a sensor with gaps 0.76.
const MISSES_SHARE: f64 = 0.3;
const SEES_SHARE: f64 = 0.6;

/// A branch seen in colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WoodCandidate {
    pub(crate) candidate: Candidate,
    /// Probability that it is wood.
    pub(crate) wood: f64,
    /// By how much it stands out in the image.
    pub(crate) contrast: f64,
    /// Probability that it is the nearest wood.
    pub(crate) nearest: f64,
}

/// Probability of being wood from which a candidate that is not sure to be the nearest makes the answer ambiguous.
const AMBIGUOUS_WOOD: f64 = 0.5;

/// Why the likeliest candidate is not sure enough.
pub(crate) fn refusal(found: &SeenApple, ranked: &[WoodCandidate]) -> Status {
    if ranked.iter().any(|c| c.wood > AMBIGUOUS_WOOD) {
        Status::AmbiguousBranch
    } else {
        without_candidate(found)
    }
}

impl WoodSearch<'_> {
    /// The candidates, the likeliest to be the nearest wood first: lines of the colour image, and the axes that depth
    /// alone has found, judged by the same image.
    pub(crate) fn candidates(
        &self,
        by_depth: &[Ranked],
        rng: &mut ChaCha8Rng,
    ) -> Vec<WoodCandidate> {
        let Some(band) = self.band() else {
            return Vec::new();
        };
        let trust = self.trust_in_depth(&band);
        let widest = 2.0 * self.config.branch_radius_max_m / self.pixel();
        let crossings = Crossings::of(self.wood, band.window, widest);
        let lines = image_lines(&crossings, band.center, band.radius, rng);
        let of_lines = lines.iter().flat_map(|line| {
            let band = &band;
            let stretches = band.evidence(line).into_iter();
            stretches.filter_map(move |evidence| {
                let lifted = Lifted::new(self, band, line, &evidence, trust)?;
                let candidate = self.candidate(&lifted, &evidence)?;
                Some((candidate, evidence.probability(trust, None), evidence))
            })
        });
        let of_depth = by_depth.iter().filter_map(|found| {
            let candidate = found.candidate;
            let evidence = band.evidence_at_foot(&self.image_line(&band, &candidate)?);
            let wood = evidence.probability(trust, Some(found.wood));
            Some((candidate, wood, evidence))
        });
        let mut found: Vec<(Candidate, f64, Evidence)> = of_lines.chain(of_depth).collect();
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        let places: Vec<Place> = found
            .iter()
            .map(|(candidate, wood, _)| Place {
                offset: candidate.foot - self.apple.center,
                wood: *wood,
            })
            .collect();
        let ranked = by_distance(&places, self.apple.radius, self.config.nearest_first);
        ranked
            .into_iter()
            .map(|(k, nearest)| WoodCandidate {
                candidate: Candidate {
                    score: nearest,
                    ..found[k].0
                },
                wood: found[k].1,
                contrast: found[k].2.contrast,
                nearest,
            })
            .collect()
    }

    /// How much depth is worth about this apple, 0 to 1: by the share of the pixels of wood with a reading, and by how
    /// sharp the frame's depth is.
    fn trust_in_depth(&self, band: &Band<'_>) -> f64 {
        let window = band.window;
        let (mut read, mut all) = (0.0, 0.0);
        for v in window.y0..window.y1 {
            for u in window.x0..window.x1 {
                let p = (u as f64, v as f64);
                let weight = band.probability(p);
                if weight >= SURE_WOOD {
                    all += weight;
                    let at = (p.0 + band.shift.0, p.1 + band.shift.1);
                    if depth::reading(self.depth, at.0.round(), at.1.round()).is_some() {
                        read += weight;
                    }
                }
            }
        }
        let share = if all > 0.0 { read / all } else { 0.0 };
        let sees = (share - MISSES_SHARE) / (SEES_SHARE - MISSES_SHARE);
        sees.clamp(0.0, 1.0) * (1.0 - self.smear)
    }

    /// The part of the image about the apple.
    fn band(&self) -> Option<Band<'_>> {
        let (width, height) = (self.wood.width, self.wood.height);
        let around = Sphere {
            center: self.apple.center,
            radius: (REACH_RADII + MARGIN_RADII) * self.apple.radius,
        };
        let window = window_of_sphere(&around, self.projection.camera, width, height);
        let fitted = self.projection.project(&self.apple.center)?;
        let radius = self.apple.radius / self.pixel();
        let shift = self.registration(fitted, radius);
        Some(Band {
            wood: self.wood,
            window,
            center: (fitted.0 - shift.0, fitted.1 - shift.1),
            radius,
            shift,
        })
    }

    /// By how many pixels depth lies beside colour at this apple: the fitted centre less the middle of the box; nothing
    /// where the box cannot tell.
    fn registration(&self, fitted: (f64, f64), radius: f64) -> (f64, f64) {
        let b = self.bounds;
        let (width, height) = (b.x_max - b.x_min, b.y_max - b.y_min);
        let whole = b.x_min > 0.0
            && b.y_min > 0.0
            && b.x_max < self.wood.width as f64
            && b.y_max < self.wood.height as f64
            && width < MOST_ASPECT * height
            && height < MOST_ASPECT * width;
        // Edges are counted from the image's corner, pixels by their centres.
        let middle = (
            0.5 * (b.x_min + b.x_max) - 0.5,
            0.5 * (b.y_min + b.y_max) - 0.5,
        );
        let shift = (fitted.0 - middle.0, fitted.1 - middle.1);
        if whole && shift.0.hypot(shift.1) < MOST_SHIFT_RADII * radius {
            shift
        } else {
            (0.0, 0.0)
        }
    }

    /// Where the axis of a candidate lies in the colour image.
    fn image_line(&self, band: &Band<'_>, candidate: &Candidate) -> Option<ImageLine> {
        let step = candidate.tangent.into_inner() * (0.5 * self.apple.radius);
        let point = self.projection.project(&candidate.foot)?;
        let point = (point.0 - band.shift.0, point.1 - band.shift.1);
        let a = self.projection.project(&(candidate.foot - step))?;
        let b = self.projection.project(&(candidate.foot + step))?;
        let half_width = candidate.axis.radius / self.projection.pixel_m(candidate.foot.z);
        ImageLine::new(point, (b.0 - a.0, b.1 - a.1), half_width)
    }

    /// The line of the image in space; `None` where it cannot be a branch of this apple.
    fn candidate(&self, lifted: &Lifted, evidence: &Evidence) -> Option<Candidate> {
        let center = self.apple.center;
        let axis = BranchAxis::straight(&lifted.axis, &center, lifted.radius)?;
        let foot = lifted.foot;
        let distance = (foot - center).norm();
        if !(distance < REACH_RADII * self.apple.radius && distance > 0.0) {
            return None;
        }
        Some(Candidate {
            axis,
            foot,
            tangent: lifted.axis.direction,
            distance,
            support: AxisSupport {
                visible: evidence.length * self.pixel(),
                pixels: lifted.readings,
                ..AxisSupport::default()
            },
            score: 0.0,
            foot_sd: lifted.depth_sd,
            rms: lifted.rms,
        })
    }
}
