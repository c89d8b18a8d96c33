//! A look along a supposed branch: at each place of its axis, what the pixels across it show.
//!
//! Where a branch is, it shows with an end on either side, or something nearer hides it. Where the readings lie
//! behind the axis, or are none, there is no branch: a leaf that looks like one ends within its own length.

use super::axis::Axis;
use super::shell::{APPLE, NOTHING, Shell};
use crate::optics::Projection;

/// What the pixels across the axis show at one place.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Slice {
    /// Something at the axis' depth.
    Thing(Cut),
    /// Something nearer, or an apple.
    Hidden,
    /// Readings behind the axis, or none.
    Empty,
    /// Outside of the image.
    Outside,
}

/// A thing cut across, in metres from the axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// Its two ends.
    pub(crate) ends: (f64, f64),
    /// Whether each is its own: with something farther or nothing beyond.
    pub(crate) own: (bool, bool),
    /// How far behind the supposed axis its own lies.
    pub(crate) deep: f64,
    /// Pixels of it.
    pub(crate) pixels: usize,
}

impl Cut {
    /// Its width.
    pub(crate) fn width(&self) -> f64 {
        self.ends.1 - self.ends.0
    }

    /// Its middle, where the whole is `width` wide and one end may be hidden; `None` where both are.
    pub(crate) fn middle(&self, width: f64) -> Option<f64> {
        match self.own {
            (true, true) => Some(0.5 * (self.ends.0 + self.ends.1)),
            (true, false) => Some(self.ends.0 + 0.5 * width),
            (false, true) => Some(self.ends.1 - 0.5 * width),
            (false, false) => None,
        }
    }
}

/// How to walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    /// To either side of the base, metres.
    pub(crate) reach: f64,
    /// From one place to the next, metres.
    pub(crate) step: f64,
    /// Allowed difference in depth at the base, metres.
    pub(crate) tolerance: f64,
    /// And its growth along the axis.
    pub(crate) growth: f64,
}

/// The slices along an axis with their places; the indices of the pixels of things are added to `pixels`.
pub(crate) fn walk(
    shell: &Shell,
    projection: &Projection<'_>,
    axis: &Axis,
    pace: &Pace,
    out: &mut Vec<(f64, Slice)>,
    mut pixels: Option<&mut Vec<u32>>,
) {
    out.clear();
    let n = (pace.reach / pace.step) as i32;
    for k in -n..=n {
        let s = f64::from(k) * pace.step;
        let tolerance = pace.tolerance + pace.growth * s.abs();
        let slice = match Across::new(shell, projection, axis, s, tolerance) {
            Some(across) => across.slice(pixels.as_deref_mut()),
            None => Slice::Outside,
        };
        out.push((s, slice));
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    On,
    Near,
    Far,
    Nothing,
    Apple,
    Outside,
}

/// Most pixels looked at to either side.
const HALF_PIXELS: i32 = 48;

/// Missing readings that a thing goes on behind, pixels.
const BRIDGE_PX: i32 = 3;

/// The pixels across the axis at one place.
struct Across<'a> {
    shell: &'a Shell,
    /// Pixel of the axis in the patch, and one pixel's way across.
    at: (f64, f64),
    way: (f64, f64),
    /// Pixels per metre.
    scale: f64,
    /// Depth of the axis, and by how much a surface at the axis' radius lies before it along the ray.
    z: f64,
    rise: f64,
    /// Of the depth along the ray that of the distance from the axis.
    slant: f64,
    radius: f64,
    tolerance: f64,
}

impl<'a> Across<'a> {
    fn new(
        shell: &'a Shell,
        projection: &Projection<'_>,
        axis: &Axis,
        s: f64,
        tolerance: f64,
    ) -> Option<Self> {
        const ASIDE_M: f64 = 0.01;
        let a = axis.at(s);
        let (u, v) = projection.project(&a)?;
        let (u1, v1) = projection.project(&(a + axis.side * ASIDE_M))?;
        let (du, dv) = (u1 - u, v1 - v);
        let length = (du * du + dv * dv).sqrt();
        if !(length > 0.01 && length.is_finite()) {
            return None;
        }
        let ray = a.coords.normalize();
        // A branch that points at the camera is treated as if at 9 degrees to the ray.
        let sine = ray.cross(&axis.tangent(s)).norm().max(0.15);
        let origin = shell.patch.origin;
        Some(Self {
            shell,
            at: (u - origin.0 as f64 + 0.5, v - origin.1 as f64 + 0.5),
            way: (du / length, dv / length),
            scale: length / ASIDE_M,
            z: a.z,
            rise: ray.z / sine,
            slant: sine / ray.z,
            radius: axis.radius,
            tolerance,
        })
    }

    /// Depth of a round branch's surface `x` metres aside of its axis.
    fn surface(&self, x: f64) -> f64 {
        self.z - (self.radius * self.radius - x * x).max(0.0).sqrt() * self.rise
    }

    fn pixel(&self, k: i32) -> Option<usize> {
        let k = f64::from(k);
        let (x, y) = (self.at.0 + k * self.way.0, self.at.1 + k * self.way.1);
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (x, y) = (x as usize, y as usize);
        let patch = &self.shell.patch;
        (x < patch.width && y < patch.height).then_some(y * patch.width + x)
    }

    /// What pixel `k` aside shows, and how far it lies behind the supposed surface.
    fn mark(&self, k: i32) -> (Mark, f64) {
        let Some(i) = self.pixel(k) else {
            return (Mark::Outside, 0.0);
        };
        let z = f64::from(self.shell.patch.z[i]);
        if z == 0.0 {
            return (Mark::Nothing, 0.0);
        }
        let off = z - self.surface(f64::from(k) / self.scale);
        let mark = if off > self.tolerance {
            Mark::Far
        } else {
            match self.shell.seen[i] {
                APPLE => Mark::Apple,
                NOTHING if off > 0.0 => Mark::Far,
                _ if off < -self.tolerance => Mark::Near,
                _ => Mark::On,
            }
        };
        (mark, off)
    }

    fn slice(&self, pixels: Option<&mut Vec<u32>>) -> Slice {
        if self.mark(0).0 == Mark::Outside {
            return Slice::Outside;
        }
        let search = ((0.8 * self.radius * self.scale) as i32).max(1) + 1;
        let seed = (0..=search)
            .flat_map(|k| [k, -k])
            .find(|&k| self.mark(k).0 == Mark::On);
        let Some(seed) = seed else {
            return self.without_thing();
        };
        let most = ((2.4 * self.radius * self.scale) as i32 + 4).min(HALF_PIXELS);
        let (right, right_own) = self.end(seed, 1, most);
        let (left, left_own) = self.end(seed, -1, most);
        let centre = 0.5 * f64::from(left + right) / self.scale;
        // The middle of the thing tells its depth; towards its ends depths are mixed.
        let quarter = (0.35 * f64::from(right - left)).max(0.5);
        let mut sum = Sums::default();
        let mut count = 0;
        for k in left..=right {
            let (mark, off) = self.mark(k);
            if mark != Mark::On {
                continue;
            }
            count += 1;
            if (f64::from(k) - 0.5 * f64::from(left + right)).abs() <= quarter {
                // Against the roundness about the thing's own middle.
                let x = f64::from(k) / self.scale;
                sum.add(off + self.surface(x) - self.surface(x - centre));
            }
        }
        if let Some(pixels) = pixels {
            let on = (left..=right).filter(|&k| self.mark(k).0 == Mark::On);
            let index = |k| Some(self.shell.patch.image_index(self.pixel(k)?));
            pixels.extend(on.filter_map(index));
        }
        let Some(off) = sum.mean() else {
            return Slice::Empty;
        };
        Slice::Thing(Cut {
            ends: (
                (f64::from(left) - 0.5) / self.scale,
                (f64::from(right) + 0.5) / self.scale,
            ),
            own: (left_own, right_own),
            deep: off * self.slant,
            pixels: count,
        })
    }

    /// The last pixel of the thing from `seed` on, and whether it ends there by itself.
    fn end(&self, seed: i32, way: i32, most: i32) -> (i32, bool) {
        let (mut last, mut missing, mut k) = (seed, 0, seed);
        loop {
            k += way;
            if (k - seed).abs() > most || k.abs() > most {
                return (last, false);
            }
            match self.mark(k).0 {
                Mark::On => (last, missing) = (k, 0),
                Mark::Nothing if missing < BRIDGE_PX => missing += 1,
                Mark::Nothing | Mark::Far => return (last, true),
                Mark::Near | Mark::Apple | Mark::Outside => return (last, false),
            }
        }
    }

    /// What most of the middle shows where nothing lies at the axis' depth.
    fn without_thing(&self) -> Slice {
        let half = ((0.5 * self.radius * self.scale) as i32).max(1);
        let hidden = (-half..=half)
            .filter(|&k| matches!(self.mark(k).0, Mark::Near | Mark::Apple))
            .count() as i32;
        if hidden > half {
            Slice::Hidden
        } else {
            Slice::Empty
        }
    }
}

#[derive(Default)]
struct Sums {
    sum: f64,
    count: usize,
}

impl Sums {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}
