//! By how much a line of the image stands out as wood from what lies beside it.

use super::line::ImageLine;
use super::view::{MARGIN_RADII, REACH_RADII};
use pomona_cloud::{GrayImage, PixelWindow};
use std::ops::Range;

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
    /// Length of the whole stretch on which it shows, pixels.
    pub(crate) length: f64,
}

/// Length of the piece that is looked at, radii of the apple.
const PIECE_RADII: f64 = 1.2;

/// Contrast from which a place of a line shows as wood.
const SHOWS: f64 = 0.12;

/// Share of its greatest contrast with which a stretch ends: masks fade out along stalks and leaves' edges.
const END_SHARE: f64 = 0.6;

/// What a stretch bridges of what does not show, radii of the apple.
const BRIDGE_RADII: f64 = 0.4;

/// Shortest stretch that is a candidate: radii of the apple, and pixels.
const LEAST_STRETCH_RADII: f64 = 0.3;
const LEAST_STRETCH_PX: f64 = 5.0;

/// Share of the probability beside a band that is taken from that on it.
const FLANK_SHARE: f64 = 0.7;

/// Share of the half width that counts as the band's inside.
const INSIDE: f64 = 0.8;

/// Distance of the flanks from the edge, and their least width, pixels.
const FLANK_GAP_PX: f64 = 1.0;
const FLANK_PX: f64 = 2.0;

/// Log odds that a candidate is wood where depth is not to be trusted: constant, …
///
/// These two were fitted by `crates/segment/training/fit_wood.py` to 1358 candidates about 300 apples in 25 photographs
/// on which the segmenter was not trained, whose wood was drawn by eye. Other figures (length, width, distance from the
/// apple, the square of the contrast) tell little more: the log loss over photographs left out goes from 0.514 to 0.504.
const ODDS: f64 = -2.13;

/// … and for each unit of contrast.
const ODDS_CONTRAST: f64 = 6.31;

/// Where depth is trusted, for what it has not found.
const ODDS_NOT_IN_DEPTH: f64 = -12.0;

/// Where depth is not trusted, for what it has found and colour does not show.
const ODDS_NOT_SHOWN: f64 = -4.0;

/// Largest log odds that depth adds in either direction.
const MOST_ODDS_OF_DEPTH: f64 = 8.0;

/// Distance from the apple's centre below which wood lies in front of the apple, radii of the apple.
pub(crate) const IN_FRONT_RADII: f64 = 0.85;

impl Evidence {
    /// Probability that it is wood, by colour and by depth that is worth `trust`. `by_depth` is the probability by depth
    /// alone of an axis that depth has found.
    pub(crate) fn probability(&self, trust: f64, by_depth: Option<f64>) -> f64 {
        let by_color = ODDS + ODDS_CONTRAST * self.contrast;
        let odds_of_depth = by_depth.map_or(ODDS_NOT_IN_DEPTH, |wood| {
            let odds = (wood / (1.0 - wood).max(1e-12)).max(1e-12).ln();
            odds.clamp(-MOST_ODDS_OF_DEPTH, MOST_ODDS_OF_DEPTH)
        });
        let not_shown = if self.length > 0.0 {
            0.0
        } else {
            ODDS_NOT_SHOWN
        };
        let odds = by_color + trust * odds_of_depth + (1.0 - trust) * not_shown;
        1.0 / (1.0 + (-odds).exp())
    }
}

/// The stretches of a profile that show, those less than `bridge` places apart as one, each as far as it shows
/// [`END_SHARE`] of its greatest contrast.
fn stretches(profile: &[f64], bridge: usize) -> impl Iterator<Item = Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for (k, _) in profile.iter().enumerate().filter(|(_, c)| **c >= SHOWS) {
        match found.last_mut() {
            Some(last) if k < last.end + bridge.max(1) => last.end = k + 1,
            _ => found.push(k..k + 1),
        }
    }
    found.into_iter().map(|stretch| {
        let places = &profile[stretch.clone()];
        let most = places.iter().copied().fold(0.0, f64::max);
        let ends = |c: &f64| *c >= END_SHARE * most;
        let first = places.iter().position(ends).unwrap_or(0);
        let last = places.iter().rposition(ends).unwrap_or(0);
        stretch.start + first..stretch.start + last + 1
    })
}

impl Band<'_> {
    /// The evidence of each stretch of a line that shows as wood and reaches the apple's surroundings.
    pub(crate) fn evidence(&self, line: &ImageLine) -> Vec<Evidence> {
        let nearest = line.along_to(self.center);
        let reach = ((REACH_RADII + MARGIN_RADII) * self.radius).ceil() as i32;
        let profile: Vec<f64> = (-reach..=reach)
            .map(|k| self.contrast(line, nearest + f64::from(k)))
            .collect();
        let bridge = (BRIDGE_RADII * self.radius).ceil() as usize;
        let least = (LEAST_STRETCH_RADII * self.radius).max(LEAST_STRETCH_PX);
        let stretches = stretches(&profile, bridge);
        let place = |k: usize| nearest + k as f64 - f64::from(reach);
        let found = stretches.filter_map(|stretch| {
            let length = stretch.len() as f64;
            let (first, last) = (place(stretch.start), place(stretch.end - 1));
            let foot = nearest.clamp(first, last);
            let evidence = self.at(&profile, &stretch, foot - place(0));
            let evidence = Evidence {
                middle: evidence.middle + place(0),
                foot,
                distance: self.distance(line, foot),
                ..evidence
            };
            (length >= least && evidence.distance < REACH_RADII).then_some(evidence)
        });
        found.collect()
    }

    /// The same for a line whose foot is known: what shows about it.
    pub(crate) fn evidence_at_foot(&self, line: &ImageLine) -> Evidence {
        let nearest = line.along_to(self.center);
        let half = (PIECE_RADII * self.radius).ceil() as i32;
        let profile: Vec<f64> = (-half..=half)
            .map(|k| self.contrast(line, nearest + f64::from(k)))
            .collect();
        // Leaves may hide the foot itself: the best piece about it.
        let pieces = (0..profile.len()).map(|k| self.at(&profile, &(0..profile.len()), k as f64));
        let best = pieces.max_by(|a, b| a.contrast.total_cmp(&b.contrast));
        let contrast = best.map_or(0.0, |piece| piece.contrast);
        let bridge = (BRIDGE_RADII * self.radius).ceil() as usize;
        let about = |stretch: &Range<usize>| {
            stretch.start <= half as usize + bridge && half as usize <= stretch.end + bridge
        };
        let shown = stretches(&profile, bridge).find(about);
        Evidence {
            contrast,
            middle: nearest,
            foot: nearest,
            distance: self.distance(line, nearest),
            length: shown.map_or(0.0, |stretch| stretch.len() as f64),
        }
    }

    /// The piece of `stretch` nearest to `foot`; places count along `profile`.
    fn at(&self, profile: &[f64], stretch: &Range<usize>, foot: f64) -> Evidence {
        let most = (PIECE_RADII * self.radius).ceil().max(1.0) as usize;
        let count = most.min(stretch.len());
        let before = (foot - 0.5 * count as f64).max(stretch.start as f64) as usize;
        let start = before.min(stretch.end - count);
        let piece = &profile[start..start + count];
        Evidence {
            contrast: piece.iter().sum::<f64>() / count.max(1) as f64,
            middle: start as f64 + 0.5 * count as f64,
            foot,
            distance: 0.0,
            length: stretch.len() as f64,
        }
    }

    /// Distance of a place of a line from the apple's centre, radii of the apple.
    fn distance(&self, line: &ImageLine, s: f64) -> f64 {
        let p = line.at(s, 0.0);
        (p.0 - self.center.0).hypot(p.1 - self.center.1) / self.radius
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

#[cfg(test)]
mod tests {
    use super::*;

    /// An image with a horizontal band of wood in the given columns, about an apple at (80, 100) of radius 20.
    fn evidence(columns: Range<usize>, v: usize) -> Vec<Evidence> {
        let (width, height) = (160, 140);
        let mut wood = GrayImage {
            width,
            height,
            values: vec![0; width * height],
        };
        for row in v - 2..=v + 2 {
            for u in columns.clone() {
                wood.values[row * width + u] = 200;
            }
        }
        let band = Band {
            wood: &wood,
            window: PixelWindow::full(width, height),
            center: (80.0, 100.0),
            radius: 20.0,
            shift: (0.0, 0.0),
        };
        let line = ImageLine::new((30.0, v as f64), (1.0, 0.0), 2.5).unwrap();
        band.evidence(&line)
    }

    #[test]
    fn wood_that_passes_has_its_foot_beside_the_apple() {
        let found = evidence(20..140, 70);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].foot - 50.0).abs() < 1.0 && (found[0].distance - 1.5).abs() < 0.05);
        assert!(
            found[0].contrast > 0.6 && found[0].length > 100.0,
            "{found:?}"
        );
    }

    #[test]
    fn wood_that_ends_has_its_foot_at_its_end() {
        let found = evidence(20..60, 70);
        assert_eq!(found.len(), 1, "{found:?}");
        // Column 59, 29 from the line's own point; (21, 30) pixels from the apple.
        assert!((found[0].foot - 29.0).abs() < 2.0, "{found:?}");
        assert!((found[0].distance - 1.83).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn a_narrow_gap_is_bridged_and_a_leaf_cuts_in_two() {
        let profile = |gap: usize| -> Vec<f64> {
            (0..60)
                .map(|k| {
                    if (20..20 + gap).contains(&k) {
                        0.0
                    } else {
                        0.5
                    }
                })
                .collect()
        };
        assert_eq!(stretches(&profile(3), 5).count(), 1);
        assert_eq!(stretches(&profile(9), 5).count(), 2);
    }

    #[test]
    fn what_depth_alone_shows_is_hardly_wood_where_depth_is_not_trusted() {
        let blank = Evidence {
            contrast: 0.0,
            middle: 0.0,
            foot: 0.0,
            distance: 1.2,
            length: 0.0,
        };
        assert!(blank.probability(0.0, Some(0.99)) < 0.01);
        assert!(blank.probability(1.0, Some(0.99)) > 0.5);
    }
}
