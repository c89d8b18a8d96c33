//! Line hypotheses from strips: through one, or joining two.
//!
//! Constants that name no source were set by hand, like those of [`branch`](super::branch).

use super::strips::Strip;
use nalgebra::{Point3, Vector3};
use pomona_geometry::Line;

/// A line that may be the axis of a branch, before it is refined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineHypothesis {
    pub(crate) line: Line,
    pub(crate) half_width: f64,
    pub(crate) support: f64,
}

/// Distance from a line within which a strip supports it, metres, …
const SUPPORT_DISTANCE_M: f64 = 0.004;

/// … and as a share of the branch's half width.
const SUPPORT_DISTANCE_SHARE: f64 = 0.4;

/// Cosine of the largest angle between a line and a strip that supports it (22°): pieces of 12 mm are short, and
/// branches bend.
const ALIGNED_COS: f64 = 0.93;

/// Largest ratio of the widths of a line and of a strip that supports it.
const SUPPORT_WIDTH_RATIO: f64 = 1.8;

/// Largest ratio of the widths of two strips that are joined.
const JOIN_WIDTH_RATIO: f64 = 2.0;

/// Least distance between two strips that are joined, metres: nearer ones give no direction.
const JOIN_GAP_M: f64 = 0.01;

/// Distance along the line at which a strip counts half, as a factor of the largest distance of a branch.
const SUPPORT_RANGE: f64 = 3.0;

/// Half width at which a line counts half, metres: wide objects are less often branches than narrow ones.
const TYPICAL_HALF_WIDTH_M: f64 = 0.012;

/// Half width below which ratios of widths are not computed, metres.
const LEAST_HALF_WIDTH_M: f64 = 1e-4;

/// Two hypotheses are the same where the cosine of their angle exceeds this (11°) …
const SAME_LINE_COS: f64 = 0.98;

/// … and their feet are nearer than this, metres, …
const SAME_LINE_FOOT_M: f64 = 0.004;

/// … and this share of the better one's half width.
const SAME_LINE_FOOT_SHARE: f64 = 0.5;

/// Bounds on the distance of a line from the apple's centre, metres.
pub(crate) type DistanceRange = (f64, f64);

/// The best supported lines through one strip or two, each unlike the ones before it.
pub(crate) fn line_hypotheses(
    strips: &[Strip],
    center: &Point3<f64>,
    range: DistanceRange,
    most: usize,
) -> Vec<LineHypothesis> {
    let mut found: Vec<LineHypothesis> = Vec::new();
    let mut consider = |point: Point3<f64>, direction: Vector3<f64>, half_width: f64| {
        let Some(line) = Line::new(point, direction) else {
            return;
        };
        let distance = line.distance(center);
        if distance < range.0 || distance > range.1 {
            return;
        }
        let foot = line.foot(center);
        let mut support = 0.0;
        for s in strips {
            let along = (s.middle - foot).dot(&line.direction);
            let off = line.distance(&s.middle);
            let aligned = s.direction.dot(&line.direction).abs();
            let wide = (s.half_width / half_width.max(LEAST_HALF_WIDTH_M))
                .max(half_width / s.half_width.max(LEAST_HALF_WIDTH_M));
            if off < SUPPORT_DISTANCE_M + SUPPORT_DISTANCE_SHARE * half_width
                && aligned > ALIGNED_COS
                && wide < SUPPORT_WIDTH_RATIO
            {
                support += s.length / (1.0 + (along / (SUPPORT_RANGE * range.1)).powi(2));
            }
        }
        support /= 1.0 + (half_width / TYPICAL_HALF_WIDTH_M).powi(2);
        found.push(LineHypothesis {
            line,
            half_width,
            support,
        });
    };
    for (i, a) in strips.iter().enumerate() {
        consider(a.middle, a.direction, a.half_width);
        for b in &strips[i + 1..] {
            let between = b.middle - a.middle;
            let gap = between.norm();
            if gap < JOIN_GAP_M {
                continue;
            }
            let direction = between / gap;
            let wide = (a.half_width / b.half_width).max(b.half_width / a.half_width);
            if direction.dot(&a.direction).abs() > ALIGNED_COS
                && direction.dot(&b.direction).abs() > ALIGNED_COS
                && wide < JOIN_WIDTH_RATIO
            {
                consider(a.middle, direction, 0.5 * (a.half_width + b.half_width));
            }
        }
    }
    found.sort_by(|a, b| b.support.total_cmp(&a.support));
    let mut kept: Vec<LineHypothesis> = Vec::new();
    for hypothesis in found {
        let alike = |k: &LineHypothesis| {
            k.line.direction.dot(&hypothesis.line.direction).abs() > SAME_LINE_COS
                && (k.line.foot(center) - hypothesis.line.foot(center)).norm()
                    < SAME_LINE_FOOT_M + SAME_LINE_FOOT_SHARE * k.half_width
        };
        if !kept.iter().any(alike) {
            kept.push(hypothesis);
            if kept.len() == most {
                break;
            }
        }
    }
    kept
}
