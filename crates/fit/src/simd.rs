//! Loops over blocks of coordinates, compiled once for each instruction set and chosen at run time.
//!
//! The loops are plain: the compiler vectorises them for the widest set that `pulp` finds. It
//! never contracts a multiplication and an addition into one rounding and never changes the order of a
//! sum, so every path computes the same numbers to the last bit. What that costs and yields is in
//! `docs/performance.md`.

mod shell;

pub(crate) use shell::{Radial, Shell};

use crate::Coordinate;
use pulp::{Arch, Simd, WithSimd};

/// Three slices of coordinates, of one length.
pub(crate) type Block<'a, T> = (&'a [T], &'a [T], &'a [T]);

/// How many sums a gain is collected in: the points i with equal i mod 16 go into one, and the
/// sixteen are added in order. It is this order, and not the registers' width, that fixes the bits.
const LANES: usize = 16;

/// How many points are selected at a time.
const CHUNK: usize = 64;

/// How many of them are passed over at once if none is selected.
const GROUP: usize = 8;

/// A shape made ready to be compared with points at one threshold.
pub(crate) trait Kernel<T>: Copy {
    /// Whether a point lies within the threshold; never where something is NaN.
    fn holds(&self, x: T, y: T, z: T) -> bool;

    /// 1 − (residual/threshold)² of a point; above zero only by rounding where it does not hold, and
    /// then it is not used.
    fn gain(&self, x: T, y: T, z: T) -> T;
}

/// How many points of a block `kernel` holds.
#[inline]
pub(crate) fn count<T: Coordinate>(block: Block<'_, T>, kernel: impl Kernel<T>) -> usize {
    Arch::new().dispatch(Count { block, kernel }) as usize
}

/// Sum of the gains of the points of a block that `kernel` holds.
pub(crate) fn gain<T: Coordinate>(block: Block<'_, T>, kernel: impl Kernel<T>) -> f64 {
    Arch::new().dispatch(Gain { block, kernel })
}

/// Appends `first` + i for each point i of a block that `kernel` holds.
pub(crate) fn select<T: Coordinate>(
    block: Block<'_, T>,
    first: usize,
    kernel: impl Kernel<T>,
    out: &mut Vec<usize>,
) {
    Arch::new().dispatch(Select {
        block,
        first,
        kernel,
        out,
    });
}

/// The slices cut to one length, which the compiler then knows.
#[inline(always)]
fn even<T>((x, y, z): Block<'_, T>) -> Block<'_, T> {
    let n = x.len().min(y.len()).min(z.len());
    (&x[..n], &y[..n], &z[..n])
}

struct Count<'a, T, K> {
    block: Block<'a, T>,
    kernel: K,
}

impl<T: Coordinate, K: Kernel<T>> WithSimd for Count<'_, T, K> {
    type Output = u32;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> u32 {
        let (x, y, z) = even(self.block);
        let mut count = 0;
        for i in 0..x.len() {
            count += u32::from(self.kernel.holds(x[i], y[i], z[i]));
        }
        count
    }
}

struct Gain<'a, T, K> {
    block: Block<'a, T>,
    kernel: K,
}

impl<T: Coordinate, K: Kernel<T>> Gain<'_, T, K> {
    #[inline(always)]
    fn of(&self, x: T, y: T, z: T) -> T {
        let zero = T::from_f64(0.0);
        let gain = self.kernel.gain(x, y, z);
        let gain = if gain > zero { gain } else { zero };
        if self.kernel.holds(x, y, z) {
            gain
        } else {
            zero
        }
    }
}

impl<T: Coordinate, K: Kernel<T>> WithSimd for Gain<'_, T, K> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let (x, y, z) = even(self.block);
        let mut sums = [T::from_f64(0.0); LANES];
        let (xs, x_rest) = x.as_chunks::<LANES>();
        let (ys, y_rest) = y.as_chunks::<LANES>();
        let (zs, z_rest) = z.as_chunks::<LANES>();
        for ((x, y), z) in xs.iter().zip(ys).zip(zs) {
            for i in 0..LANES {
                sums[i] += self.of(x[i], y[i], z[i]);
            }
        }
        for (i, sum) in sums.iter_mut().enumerate().take(x_rest.len()) {
            *sum += self.of(x_rest[i], y_rest[i], z_rest[i]);
        }
        sums.iter().map(|sum| sum.to_f64()).sum()
    }
}

struct Select<'a, T, K> {
    block: Block<'a, T>,
    first: usize,
    kernel: K,
    out: &'a mut Vec<usize>,
}

impl<T: Coordinate, K: Kernel<T>> WithSimd for Select<'_, T, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (x, y, z) = even(self.block);
        let chunks = x.chunks(CHUNK).zip(y.chunks(CHUNK)).zip(z.chunks(CHUNK));
        let mut found = [0; CHUNK];
        for (k, ((x, y), z)) in chunks.enumerate() {
            let mut held = [0_u8; CHUNK];
            for i in 0..x.len() {
                held[i] = u8::from(self.kernel.holds(x[i], y[i], z[i]));
            }
            // Written whether it holds or not, and kept only if it does: no branch to mispredict.
            let mut length = 0;
            for (g, group) in held.as_chunks::<GROUP>().0.iter().enumerate() {
                // Few points of a scene are inliers: most groups are passed over whole.
                if u64::from_ne_bytes(*group) == 0 {
                    continue;
                }
                let start = self.first + k * CHUNK + g * GROUP;
                for (i, holds) in group.iter().enumerate() {
                    found[length % CHUNK] = start + i;
                    length += usize::from(*holds);
                }
            }
            self.out.extend_from_slice(&found[..length]);
        }
    }
}

#[cfg(test)]
mod tests;
