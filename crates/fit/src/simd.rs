//! Loops over blocks of coordinates, compiled once for each instruction set and chosen at run time.
//!
//! The loops are plain: the compiler vectorises them for the widest set that `pulp` finds. It
//! never contracts a multiplication and an addition into one rounding and never changes the order of a
//! sum, so every path computes the same numbers to the last bit. What that costs and yields is in
//! `docs/performance.md`.

mod kernel;
mod shell;

pub(crate) use kernel::Kernel;
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

/// How many of them are listed without asking whether there are as many.
const GROUP: usize = 8;

/// Multiplied by eight bytes that are 0 or 1, it gathers them in the highest byte, a bit for each.
const BITS: u64 = 0x0102_0408_1020_4080;

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
        let Self {
            block,
            first,
            kernel,
            out,
        } = self;
        let (x, y, z) = even(block);
        let (xs, x_rest) = x.as_chunks::<CHUNK>();
        let (ys, y_rest) = y.as_chunks::<CHUNK>();
        let (zs, z_rest) = z.as_chunks::<CHUNK>();
        for (k, ((x, y), z)) in xs.iter().zip(ys).zip(zs).enumerate() {
            list(x, y, z, kernel, first + k * CHUNK, out);
        }
        if !x_rest.is_empty() {
            // What is no number is never held.
            let [x, y, z] = [x_rest, y_rest, z_rest].map(|rest| {
                let mut chunk = [T::from_f64(f64::NAN); CHUNK];
                chunk[..rest.len()].copy_from_slice(rest);
                chunk
            });
            list(&x, &y, &z, kernel, first + xs.len() * CHUNK, out);
        }
    }
}

/// Appends the points of a chunk that the kernel holds; its length is known, so that no point is left over
/// for a slow loop.
#[inline(always)]
fn list<T: Coordinate>(
    x: &[T; CHUNK],
    y: &[T; CHUNK],
    z: &[T; CHUNK],
    kernel: impl Kernel<T>,
    start: usize,
    out: &mut Vec<usize>,
) {
    let mut held = [0_u8; CHUNK];
    for i in 0..CHUNK {
        held[i] = u8::from(kernel.holds(x[i], y[i], z[i]));
    }
    let mut mask = 0;
    for (g, group) in held.as_chunks::<GROUP>().0.iter().enumerate() {
        mask |= (u64::from_le_bytes(*group).wrapping_mul(BITS) >> 56) << (g * GROUP);
    }
    let count = mask.count_ones() as usize;
    let mut found = [0; CHUNK];
    // So many at a time, whether there are as many or not: few branches to mispredict.
    for slots in found
        .as_chunks_mut::<GROUP>()
        .0
        .iter_mut()
        .take(count.div_ceil(GROUP))
    {
        for slot in slots {
            *slot = start + mask.trailing_zeros() as usize;
            mask &= mask.wrapping_sub(1);
        }
    }
    out.extend_from_slice(&found[..count]);
}

#[cfg(test)]
mod tests;
