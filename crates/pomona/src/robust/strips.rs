//! Pieces of strips in the depth image: where a row or a column of pixels crosses something narrow.
//!
//! The crossing of a row with a branch has an end on either side, and its middle lies over the branch's axis
//! whatever the noise of the depth. Crossings that follow each other from row to row make a chain, and pieces of
//! chains are short straight strips: with place, direction and width, from which lines are put together.

use super::shell::{APPLE, NOTHING, Shell};
use crate::optics::DepthPatch;
use nalgebra::{Point3, Vector3};

/// A short straight piece of something narrow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strip {
    /// Middle of the piece, on the visible surface.
    pub(crate) middle: Point3<f64>,
    /// Unit direction.
    pub(crate) direction: Vector3<f64>,
    /// Half of its width across, metres.
    pub(crate) half_width: f64,
    /// Its length, metres.
    pub(crate) length: f64,
}

/// Bounds on what counts as narrow, and as one piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StripRules {
    /// Widest crossing, metres.
    pub(crate) width_max: f64,
    /// Length of a piece, metres.
    pub(crate) piece: f64,
    /// Missing readings that a crossing bridges, pixels.
    pub(crate) bridge: usize,
    /// Jump of depth that ends a crossing, metres.
    pub(crate) jump: f32,
    /// Rows or columns from one to the next.
    pub(crate) step: usize,
}

#[derive(Clone, Copy, Debug)]
struct Crossing {
    line: usize,
    middle: f32,
    width: f32,
    z: f32,
}

#[derive(Clone, Debug, Default)]
struct Chain {
    crossings: Vec<Crossing>,
}

/// Strips of the surroundings, from rows and from columns.
pub(crate) fn strips(shell: &Shell, rules: &StripRules, pixel_per_z: f64) -> Vec<Strip> {
    let mut out = Vec::new();
    for transposed in [false, true] {
        collect(shell, rules, pixel_per_z, transposed, &mut out);
    }
    out
}

fn collect(
    shell: &Shell,
    rules: &StripRules,
    pixel_per_z: f64,
    transposed: bool,
    out: &mut Vec<Strip>,
) {
    let patch = &shell.patch;
    let (lines, across) = if transposed {
        (patch.width, patch.height)
    } else {
        (patch.height, patch.width)
    };
    let index = |line: usize, k: usize| {
        if transposed {
            k * patch.width + line
        } else {
            line * patch.width + k
        }
    };
    let mut chains: Vec<Chain> = Vec::new();
    let mut active: Vec<usize> = Vec::new();
    let mut crossings: Vec<Crossing> = Vec::new();
    for line in (0..lines).step_by(rules.step) {
        crossings.clear();
        crossings_of(
            line,
            across,
            shell,
            rules,
            pixel_per_z,
            &index,
            &mut crossings,
        );
        active.retain(|&c| {
            chains[c]
                .crossings
                .last()
                .is_some_and(|l| l.line + 3 * rules.step + 2 >= line)
        });
        for crossing in &crossings {
            let mut best: Option<(usize, f32)> = None;
            for &c in &active {
                let Some(last) = chains[c].crossings.last() else {
                    continue;
                };
                if last.line == line {
                    continue;
                }
                let off = (last.middle - crossing.middle).abs();
                let wide = last.width.max(crossing.width);
                let rows = (line - last.line) as f32;
                let fits = off <= 1.5 * rows + 0.25 * wide
                    && (last.z - crossing.z).abs() < rules.jump
                    && wide <= 2.0 * last.width.min(crossing.width) + 2.0;
                if fits && best.is_none_or(|(_, o)| off < o) {
                    best = Some((c, off));
                }
            }
            if let Some((c, _)) = best {
                chains[c].crossings.push(*crossing);
            } else {
                active.push(chains.len());
                chains.push(Chain {
                    crossings: vec![*crossing],
                });
            }
        }
    }
    for chain in &chains {
        pieces(chain, patch, rules, pixel_per_z, transposed, out);
    }
}

fn crossings_of(
    line: usize,
    across: usize,
    shell: &Shell,
    rules: &StripRules,
    pixel_per_z: f64,
    index: &impl Fn(usize, usize) -> usize,
    out: &mut Vec<Crossing>,
) {
    let z_of = |k: usize| shell.patch.z[index(line, k)];
    let seen = |k: usize| shell.seen[index(line, k)];
    let mut k = 0;
    while k < across {
        if seen(k) != super::shell::THING {
            k += 1;
            continue;
        }
        let start = k;
        let (mut end, mut sum, mut count, mut last) = (k, z_of(k), 1u32, z_of(k));
        let mut j = k + 1;
        while j < across {
            match seen(j) {
                NOTHING if j - end <= rules.bridge => {}
                super::shell::THING => {
                    let z = z_of(j);
                    if (z - last).abs() > rules.jump {
                        break;
                    }
                    last = z;
                    end = j;
                    sum += z;
                    count += 1;
                }
                _ => break,
            }
            j += 1;
        }
        k = end + 1;
        let z = sum / count as f32;
        let width = (end - start + 1) as f32;
        let metres = f64::from(width) * f64::from(z) * pixel_per_z;
        if start == 0 || end + 1 >= across || metres > rules.width_max || count < 2 {
            continue;
        }
        // An end behind something nearer, or at an apple, is not the thing's own.
        let own_end = |k: usize| {
            let s = seen(k);
            s != APPLE && (s == NOTHING || z_of(k) > z + rules.jump * 0.5)
        };
        let ends = usize::from(own_end(start - 1)) + usize::from(own_end(end + 1));
        if ends == 0 {
            continue;
        }
        out.push(Crossing {
            line,
            middle: 0.5 * (start + end) as f32,
            width,
            z,
        });
    }
}

/// Cuts a chain into straight pieces.
fn pieces(
    chain: &Chain,
    patch: &DepthPatch,
    rules: &StripRules,
    pixel_per_z: f64,
    transposed: bool,
    out: &mut Vec<Strip>,
) {
    let c = &chain.crossings;
    let mut start = 0;
    while start + 4 <= c.len() {
        let mut end = start;
        while end + 1 < c.len() && span(&c[start], &c[end], pixel_per_z) < rules.piece {
            end += 1;
        }
        let part = &c[start..=end];
        if part.len() >= 4
            && span(&c[start], &c[end], pixel_per_z) > 0.5 * rules.piece
            && let Some(strip) = straight(part, patch, pixel_per_z, transposed)
        {
            out.push(strip);
        }
        start = end.max(start + 1);
    }
}

fn span(a: &Crossing, b: &Crossing, pixel_per_z: f64) -> f64 {
    let scale = f64::from(a.z) * pixel_per_z;
    let rows = (b.line - a.line) as f64 * scale;
    let aside = f64::from(b.middle - a.middle) * scale;
    (rows * rows + aside * aside).sqrt()
}

/// Straight lines through the middles and depths of a piece, over the row.
fn straight(
    part: &[Crossing],
    patch: &DepthPatch,
    pixel_per_z: f64,
    transposed: bool,
) -> Option<Strip> {
    let n = part.len() as f64;
    let mean = |f: &dyn Fn(&Crossing) -> f64| part.iter().map(f).sum::<f64>() / n;
    let line = mean(&|c| c.line as f64);
    let middle = mean(&|c| f64::from(c.middle));
    let z = mean(&|c| f64::from(c.z));
    let width = mean(&|c| f64::from(c.width));
    let (mut xx, mut xm, mut xz) = (0.0, 0.0, 0.0);
    for c in part {
        let x = c.line as f64 - line;
        xx += x * x;
        xm += x * (f64::from(c.middle) - middle);
        xz += x * (f64::from(c.z) - z);
    }
    if xx == 0.0 {
        return None;
    }
    let (slope, deepening) = (xm / xx, xz / xx);
    let at = |t: f64| {
        let (u, v) = (middle + slope * t, line + t);
        let (u, v) = if transposed { (v, u) } else { (u, v) };
        let (rx, ry) = patch.ray_between(u, v)?;
        let z = z + deepening * t;
        Some(Point3::new(rx * z, ry * z, z))
    };
    let half = 0.5 * (part[part.len() - 1].line - part[0].line) as f64;
    let (a, b) = (at(-half)?, at(half)?);
    let along = b - a;
    let length = along.norm();
    let direction = along.try_normalize(1e-6)?;
    Some(Strip {
        middle: at(0.0)?,
        direction,
        half_width: 0.5 * width * z * pixel_per_z / (1.0 + slope * slope).sqrt(),
        length,
    })
}
