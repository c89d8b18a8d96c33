//! By how much a line of the image stands out as wood from what lies beside it.

use super::line::ImageLine;
use super::view::{MARGIN_RADII, REACH_RADII};
use pomona_cloud::{GrayImage, PixelWindow};

/// The image about an apple. Pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Band<'a> {
    pub(crate) wood: &'a GrayImage,
    pub(crate) window: PixelWindow,
    /// The apple's centre.
    pub(crate) center: (f64, f64),
    /// Its radius.
    pub(crate) radius: f64,
    /// By how much depth lies beside colour.
    pub(crate) shift: (f64, f64),
}

/// What the image says about a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evidence {
    /// Mean probability of wood on the band less a share of that beside it, on the piece that shows best.
    pub(crate) contrast: f64,
    /// Middle of that piece: length along the line from its point.
    pub(crate) middle: f64,
    /// Point of the line, or of its visible end, nearest to the apple: length along the line from its point.
    pub(crate) foot: f64,
    /// Distance of that point from the apple's centre, radii of the apple.
    pub(crate) distance: f64,
    /// Length of the piece, pixels.
    pub(crate) length: f64,
}

/// Length of the piece that is looked at, radii of the apple.
const PIECE_RADII: f64 = 1.2;

/// How far beyond the middle of a visible piece a line is taken to go on behind leaves, radii of the apple.
const EXTENSION_RADII: f64 = 0.7;

/// Share of the probability beside a band that is taken from that on it.
const FLANK_SHARE: f64 = 0.7;

/// Share of the half width that counts as the band's inside.
const INSIDE: f64 = 0.8;

/// Distance of the flanks from the edge, and their least width, pixels.
const FLANK_GAP_PX: f64 = 1.0;
const FLANK_PX: f64 = 2.0;

/// Log odds that a candidate is wood: constant, …
///
/// These four and [`super::depth::DEPTH_SHARE`] were set by hand: on the labelled orchard frames, of which they decide
/// little (44 to 50 % of the answers are right over a wide range), and on the tuning scenes.
const ODDS: f64 = -2.0;

/// … for each unit of contrast, …
const ODDS_CONTRAST: f64 = 16.0;

/// … in front of the apple, where hardly any wood is and stalk and calyx are, …
const ODDS_IN_FRONT: f64 = -1.0;

/// … where depth is to be trusted for each unit by which the score of an axis that depth has found exceeds a least one,
/// …
const ODDS_DEPTH_SCORE: f64 = 6.0;
const LEAST_DEPTH_SCORE: f64 = 0.5;

/// … and there for what depth has not found.
const ODDS_NOT_IN_DEPTH: f64 = -12.0;

/// Distance from the apple's centre below which wood lies in front of the apple, radii of the apple.
pub(crate) const IN_FRONT_RADII: f64 = 0.85;

impl Evidence {
    /// Probability that it is wood, where depth is worth `trust`; `depth_score` is the score of its axis by depth, where
    /// depth has found it.
    pub(crate) fn probability(&self, trust: f64, depth_score: Option<f64>) -> f64 {
        let in_front = if self.distance < IN_FRONT_RADII {
            ODDS_IN_FRONT
        } else {
            0.0
        };
        let by_depth = depth_score.map_or(ODDS_NOT_IN_DEPTH, |score| {
            ODDS_DEPTH_SCORE * (score - LEAST_DEPTH_SCORE)
        });
        let odds = ODDS + ODDS_CONTRAST * self.contrast + in_front + trust * by_depth;
        1.0 / (1.0 + (-odds).exp())
    }
}

impl Band<'_> {
    /// The evidence of a line at its best piece; `None` where it does not reach the apple's surroundings.
    pub(crate) fn evidence(&self, line: &ImageLine) -> Option<Evidence> {
        let nearest = line.along_to(self.center);
        let reach = (REACH_RADII + MARGIN_RADII) * self.radius;
        self.best(line, nearest, reach)
    }

    /// The same for a line whose foot is known: of pieces about its foot alone.
    pub(crate) fn evidence_at_foot(&self, line: &ImageLine) -> Option<Evidence> {
        let nearest = line.along_to(self.center);
        self.best(line, nearest, EXTENSION_RADII * self.radius)
    }

    fn best(&self, line: &ImageLine, nearest: f64, range: f64) -> Option<Evidence> {
        let half = (0.5 * PIECE_RADII * self.radius).max(1.0).round() as i32;
        let most = range.round() as i32;
        // Contrast of each place from −most − half on, and its running sum.
        let mut sums = vec![0.0];
        let mut sum = 0.0;
        for k in -most - half..=most + half {
            sum += self.contrast(line, nearest + f64::from(k));
            sums.push(sum);
        }
        let length = 2 * half + 1;
        let extension = EXTENSION_RADII * self.radius;
        let mut best: Option<Evidence> = None;
        for k in -most..=most {
            let first = (k + most) as usize;
            let contrast = (sums[first + length as usize] - sums[first]) / f64::from(length);
            let s = f64::from(k);
            let off = s - s.clamp(-extension, extension);
            let foot = nearest + off;
            let p = line.at(foot, 0.0);
            let distance = (p.0 - self.center.0).hypot(p.1 - self.center.1) / self.radius;
            let evidence = Evidence {
                contrast,
                middle: nearest + s,
                foot,
                distance,
                length: f64::from(length),
            };
            let better = best.is_none_or(|b| {
                // Of equal ones that nearest to the foot.
                let difference = evidence.probability(0.0, None) - b.probability(0.0, None);
                difference > 0.0 || (difference == 0.0 && off.abs() < (b.foot - nearest).abs())
            });
            if distance < REACH_RADII && better {
                best = Some(evidence);
            }
        }
        best
    }

    /// Probability of wood on the band less that beside it, at one place along it.
    fn contrast(&self, line: &ImageLine, s: f64) -> f64 {
        let inside = INSIDE * line.half_width;
        let on = self.mean(line, s, -inside, inside);
        let near = line.half_width + FLANK_GAP_PX;
        let far = near + line.half_width.max(FLANK_PX);
        let beside = 0.5 * (self.mean(line, s, near, far) + self.mean(line, s, -far, -near));
        on - FLANK_SHARE * beside
    }

    /// Mean probability of wood from `from` to `to` aside.
    fn mean(&self, line: &ImageLine, s: f64, from: f64, to: f64) -> f64 {
        let steps = (to - from).ceil().max(1.0);
        let n = steps as i32;
        let sum: f64 = (0..n)
            .map(|k| {
                let aside = from + (f64::from(k) + 0.5) / steps * (to - from);
                self.probability(line.at(s, aside))
            })
            .sum();
        sum / steps
    }

    /// Probability of wood at a place; 0 outside of the image.
    pub(crate) fn probability(&self, p: (f64, f64)) -> f64 {
        let (u, v) = (p.0.round(), p.1.round());
        if !(u >= 0.0 && v >= 0.0) {
            return 0.0;
        }
        let value = self.wood.get(u as usize, v as usize);
        value.map_or(0.0, |value| f64::from(value) / 255.0)
    }
}
