//! A look along a supposed branch: at each place of its axis, what the pixels across it show.
//!
//! Where a branch is, it shows with an end on either side, or something nearer hides it. Where the readings lie
//! behind the axis, or are none, there is no branch: a leaf that looks like one ends within its own length.

use super::axis::BranchAxis;
use super::shell::{APPLE, NOTHING, Shell};
use crate::optics::Projection;

/// What the pixels across the axis show at one place.
#[derive(Clone, Copy, Debug)]
pub(crate) enum CrossSection {
    /// Something at the axis' depth.
    Object(ObjectSection),
    /// Something nearer, or an apple.
    Occluded,
    /// Readings behind the axis, or none.
    Empty,
    /// Outside of the image.
    OutsideImage,
}

/// The section of an object, metres from the axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObjectSection {
    /// Its two edges.
    pub(crate) edges: (f64, f64),
    /// Whether each edge is the object's silhouette: with something farther or no reading next to it.
    pub(crate) silhouette: (bool, bool),
    /// Distance of its axis behind the supposed one.
    pub(crate) depth_behind_axis: f64,
    /// Pixels that show it.
    pub(crate) pixels: usize,
    /// How round it is in depth.
    pub(crate) roundness: Roundness,
}

impl ObjectSection {
    /// Its width.
    pub(crate) fn width(&self) -> f64 {
        self.edges.1 - self.edges.0
    }

    /// Whether both edges are visible.
    pub(crate) fn both_edges(&self) -> bool {
        self.silhouette == (true, true)
    }

    /// Its centre, where the whole is `width` wide and one edge may be hidden; `None` where both are.
    pub(crate) fn center(&self, width: f64) -> Option<f64> {
        match self.silhouette {
            (true, true) => Some(0.5 * (self.edges.0 + self.edges.1)),
            (true, false) => Some(self.edges.0 + 0.5 * width),
            (false, true) => Some(self.edges.1 - 0.5 * width),
            (false, false) => None,
        }
    }
}

/// Readings across an object, compared with the depth of something round and of something flat.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Roundness {
    /// Sum of the products of the readings and of the depths of something round, each less its mean, m².
    pub(crate) product: f64,
    /// Sum of the squares of the latter, m².
    pub(crate) square: f64,
}

/// How to `cross_sections`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SectionSpacing {
    /// To either side of the base, metres.
    pub(crate) reach: f64,
    /// From one place to the next, metres.
    pub(crate) step: f64,
    /// Allowed difference in depth at the base, metres.
    pub(crate) tolerance: f64,
    /// And its growth along the axis.
    pub(crate) growth: f64,
}

/// The sections along an axis with their places; the indices of the pixels of things are added to `pixels`.
pub(crate) fn cross_sections(
    shell: &Shell,
    projection: &Projection<'_>,
    axis: &BranchAxis,
    spacing: &SectionSpacing,
    out: &mut Vec<(f64, CrossSection)>,
    mut pixels: Option<&mut Vec<u32>>,
) {
    out.clear();
    let n = (spacing.reach / spacing.step) as i32;
    for k in -n..=n {
        let s = f64::from(k) * spacing.step;
        let tolerance = spacing.tolerance + spacing.growth * s.abs();
        let section = match SectionLine::new(shell, projection, axis, s, tolerance) {
            Some(line) => line.section(pixels.as_deref_mut()),
            None => CrossSection::OutsideImage,
        };
        out.push((s, section));
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum PixelRelation {
    /// At the depth of the supposed branch's surface.
    OnSurface,
    InFront,
    Behind,
    NoReading,
    Apple,
    Outside,
}

/// Most pixels looked at to either side.
const HALF_PIXELS: i32 = 48;

/// Missing readings that a thing goes on behind, pixels.
const BRIDGE_PX: i32 = 3;

/// The pixels across the axis at one place.
struct SectionLine<'a> {
    shell: &'a Shell,
    /// Pixel of the axis in the patch, and one pixel's way across.
    at: (f64, f64),
    step: (f64, f64),
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

impl<'a> SectionLine<'a> {
    fn new(
        shell: &'a Shell,
        projection: &Projection<'_>,
        axis: &BranchAxis,
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
            step: (du / length, dv / length),
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
        let (x, y) = (self.at.0 + k * self.step.0, self.at.1 + k * self.step.1);
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (x, y) = (x as usize, y as usize);
        let patch = &self.shell.patch;
        (x < patch.width && y < patch.height).then_some(y * patch.width + x)
    }

    /// What pixel `k` aside shows, and how far it lies behind the supposed surface.
    fn relation(&self, k: i32) -> (PixelRelation, f64) {
        let Some(i) = self.pixel(k) else {
            return (PixelRelation::Outside, 0.0);
        };
        let z = f64::from(self.shell.patch.z[i]);
        if z == 0.0 {
            return (PixelRelation::NoReading, 0.0);
        }
        let off = z - self.surface(f64::from(k) / self.scale);
        let relation = if off > self.tolerance {
            PixelRelation::Behind
        } else {
            match self.shell.seen[i] {
                APPLE => PixelRelation::Apple,
                NOTHING if off > 0.0 => PixelRelation::Behind,
                _ if off < -self.tolerance => PixelRelation::InFront,
                _ => PixelRelation::OnSurface,
            }
        };
        (relation, off)
    }

    fn section(&self, pixels: Option<&mut Vec<u32>>) -> CrossSection {
        if self.relation(0).0 == PixelRelation::Outside {
            return CrossSection::OutsideImage;
        }
        let search = ((0.8 * self.radius * self.scale) as i32).max(1) + 1;
        let seed = (0..=search)
            .flat_map(|k| [k, -k])
            .find(|&k| self.relation(k).0 == PixelRelation::OnSurface);
        let Some(seed) = seed else {
            return self.without_object();
        };
        let most = ((2.4 * self.radius * self.scale) as i32 + 4).min(HALF_PIXELS);
        let (right, right_silhouette) = self.edge(seed, 1, most);
        let (left, left_silhouette) = self.edge(seed, -1, most);
        let centre = 0.5 * f64::from(left + right) / self.scale;
        // The middle of the thing tells its depth; towards its ends depths are mixed.
        let quarter = (0.35 * f64::from(right - left)).max(0.5);
        let mut sum = Sums::default();
        let mut count = 0;
        let (mut z_sum, mut round_sum, mut product, mut square) = (0.0, 0.0, 0.0, 0.0);
        for k in left..=right {
            let (relation, off) = self.relation(k);
            if relation != PixelRelation::OnSurface {
                continue;
            }
            count += 1;
            let x = f64::from(k) / self.scale;
            // Of something round about the thing's own middle, and what was read.
            let round = self.surface(x - centre) - self.z;
            let z = off + self.surface(x) - self.z;
            z_sum += z;
            round_sum += round;
            product += z * round;
            square += round * round;
            if (f64::from(k) - 0.5 * f64::from(left + right)).abs() <= quarter {
                // Against the roundness about the thing's own middle.
                sum.add(z - round);
            }
        }
        if let Some(pixels) = pixels {
            let on = (left..=right).filter(|&k| self.relation(k).0 == PixelRelation::OnSurface);
            let index = |k| Some(self.shell.patch.image_index(self.pixel(k)?));
            pixels.extend(on.filter_map(index));
        }
        let Some(off) = sum.mean() else {
            return CrossSection::Empty;
        };
        CrossSection::Object(ObjectSection {
            edges: (
                (f64::from(left) - 0.5) / self.scale,
                (f64::from(right) + 0.5) / self.scale,
            ),
            silhouette: (left_silhouette, right_silhouette),
            depth_behind_axis: off * self.slant,
            pixels: count,
            roundness: Roundness {
                product: product - z_sum * round_sum / count as f64,
                square: square - round_sum * round_sum / count as f64,
            },
        })
    }

    /// The last pixel of the thing from `seed` on, and whether it ends there by itself.
    fn edge(&self, seed: i32, way: i32, most: i32) -> (i32, bool) {
        let (mut last, mut missing, mut k) = (seed, 0, seed);
        loop {
            k += way;
            if (k - seed).abs() > most || k.abs() > most {
                return (last, false);
            }
            match self.relation(k).0 {
                PixelRelation::OnSurface => (last, missing) = (k, 0),
                PixelRelation::NoReading if missing < BRIDGE_PX => missing += 1,
                PixelRelation::NoReading | PixelRelation::Behind => return (last, true),
                PixelRelation::InFront | PixelRelation::Apple | PixelRelation::Outside => {
                    return (last, false);
                }
            }
        }
    }

    /// What most of the middle shows where nothing lies at the axis' depth.
    fn without_object(&self) -> CrossSection {
        let half = ((0.5 * self.radius * self.scale) as i32).max(1);
        let hidden = (-half..=half)
            .filter(|&k| {
                matches!(
                    self.relation(k).0,
                    PixelRelation::InFront | PixelRelation::Apple
                )
            })
            .count() as i32;
        if hidden > half {
            CrossSection::Occluded
        } else {
            CrossSection::Empty
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
