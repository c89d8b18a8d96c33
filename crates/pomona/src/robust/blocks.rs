use crate::optics::DepthPatch;
use nalgebra::Point3;

/// Points that are each the mean of a square block of readings.
///
/// Averages carry less noise than readings, so that a leaf can be told from an apple by its shape.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks {
    pub(crate) x: Vec<f32>,
    pub(crate) y: Vec<f32>,
    pub(crate) z: Vec<f32>,
    /// `DepthNoise` of each, as a share of that of one reading.
    pub(crate) share: Vec<f32>,
}

/// Columns x0..x1 of rows y0..y1 of a patch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Area {
    pub(crate) x0: usize,
    pub(crate) y0: usize,
    pub(crate) x1: usize,
    pub(crate) y1: usize,
}

impl Area {
    /// The area without a share of its width and height on each side.
    pub(crate) fn shrunk(self, share: f64) -> Self {
        let cut = |low: usize, high: usize| ((high - low) as f64 * share.clamp(0.0, 0.45)) as usize;
        let (dx, dy) = (cut(self.x0, self.x1), cut(self.y0, self.y1));
        Self {
            x0: self.x0 + dx,
            y0: self.y0 + dy,
            x1: self.x1 - dx,
            y1: self.y1 - dy,
        }
    }
}

impl Blocks {
    pub(crate) fn len(&self) -> usize {
        self.x.len()
    }

    pub(crate) fn get(&self, i: usize) -> Point3<f64> {
        Point3::new(
            f64::from(self.x[i]),
            f64::from(self.y[i]),
            f64::from(self.z[i]),
        )
    }

    /// Replaces the points by those of `area`, in blocks of `side` pixels; returns the number of readings.
    ///
    /// Only readings without a jump of depth to one of their four neighbours count: at the edges of things
    /// cameras mix depths. Blocks with less than two fifths of such readings are left out.
    pub(crate) fn fill(
        &mut self,
        patch: &DepthPatch,
        area: Area,
        side: usize,
        jump: impl Fn(f32) -> f32,
    ) -> usize {
        for column in [&mut self.x, &mut self.y, &mut self.z, &mut self.share] {
            column.clear();
        }
        let (w, h) = (patch.width, patch.height);
        let least = (side * side * 2).div_ceil(5);
        let mut readings = 0;
        for by in (area.y0..area.y1).step_by(side) {
            for bx in (area.x0..area.x1).step_by(side) {
                let (mut sum, mut n) = ([0.0f32; 3], 0usize);
                for y in by..(by + side).min(area.y1) {
                    for x in bx..(bx + side).min(area.x1) {
                        let i = y * w + x;
                        let z = patch.z[i];
                        if z == 0.0 {
                            continue;
                        }
                        readings += 1;
                        let limit = jump(z);
                        let near = |other: f32| other == 0.0 || (other - z).abs() < limit;
                        let smooth = (x == 0 || near(patch.z[i - 1]))
                            && (x + 1 >= w || near(patch.z[i + 1]))
                            && (y == 0 || near(patch.z[i - w]))
                            && (y + 1 >= h || near(patch.z[i + w]));
                        if smooth {
                            let (rx, ry) = patch.ray(x, y);
                            sum[0] += rx * z;
                            sum[1] += ry * z;
                            sum[2] += z;
                            n += 1;
                        }
                    }
                }
                if n >= least {
                    let k = 1.0 / n as f32;
                    self.x.push(sum[0] * k);
                    self.y.push(sum[1] * k);
                    self.z.push(sum[2] * k);
                    self.share.push(k.sqrt());
                }
            }
        }
        readings
    }

    /// Every so many of the points that about `most` remain.
    pub(crate) fn thinned(&self, most: usize) -> Self {
        let step = self.len().div_ceil(most.max(1)).max(1);
        let every = |v: &[f32]| v.iter().step_by(step).copied().collect();
        Self {
            x: every(&self.x),
            y: every(&self.y),
            z: every(&self.z),
            share: every(&self.share),
        }
    }
}
