//! Lines put together from strips.

use super::strips::Strip;
use nalgebra::{Point3, Vector3};
use pomona_geometry::Line;

/// A line that may be a branch's axis, before it is looked at closely.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineHypothesis {
    pub(crate) line: Line,
    pub(crate) half_width: f64,
    pub(crate) support: f64,
}

/// Bounds on the distance of a line from the apple's centre, metres.
pub(crate) type DistanceRange = (f64, f64);

/// The best supported lines through one strip or two, each unlike the ones before it.
pub(crate) fn line_hypotheses(
    strips: &[Strip],
    center: &Point3<f64>,
    reach: DistanceRange,
    most: usize,
) -> Vec<LineHypothesis> {
    let mut found: Vec<LineHypothesis> = Vec::new();
    let mut consider = |point: Point3<f64>, direction: Vector3<f64>, half_width: f64| {
        let Some(line) = Line::new(point, direction) else {
            return;
        };
        let distance = line.distance(center);
        if distance < reach.0 || distance > reach.1 {
            return;
        }
        let foot = line.foot(center);
        let mut support = 0.0;
        for s in strips {
            let along = (s.middle - foot).dot(&line.direction);
            let off = line.distance(&s.middle);
            let aligned = s.direction.dot(&line.direction).abs();
            let wide =
                (s.half_width / half_width.max(1e-4)).max(half_width / s.half_width.max(1e-4));
            if off < 0.004 + 0.4 * half_width && aligned > 0.93 && wide < 1.8 {
                support += s.length / (1.0 + (along / (3.0 * reach.1)).powi(2));
            }
        }
        // Wide things are less often branches than narrow ones.
        support /= 1.0 + (half_width / 0.012).powi(2);
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
            if gap < 0.01 {
                continue;
            }
            let way = between / gap;
            let wide = (a.half_width / b.half_width).max(b.half_width / a.half_width);
            if way.dot(&a.direction).abs() > 0.93
                && way.dot(&b.direction).abs() > 0.93
                && wide < 2.0
            {
                consider(a.middle, way, 0.5 * (a.half_width + b.half_width));
            }
        }
    }
    found.sort_by(|a, b| b.support.total_cmp(&a.support));
    let mut kept: Vec<LineHypothesis> = Vec::new();
    for hypothesis in found {
        let alike = |k: &LineHypothesis| {
            k.line.direction.dot(&hypothesis.line.direction).abs() > 0.98
                && (k.line.foot(center) - hypothesis.line.foot(center)).norm()
                    < 0.004 + 0.5 * k.half_width
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
