use rand_core::TryRng;
use std::convert::Infallible;

/// The random numbers of one iteration: a generator keyed by (seed, iteration) and nothing else.
///
/// `SplitMix64` (Steele, Lea and Flood 2014, doi 10.1145/2660193.2660195), whose start
/// is the seed and the iteration mixed twice over. Making one costs a few
/// multiplications, which a search that makes one for each of its iterations needs.
/// It implements the generator traits of `rand_core`, so a sampler can use what `rand` offers.
#[derive(Clone, Debug)]
pub struct Draws {
    state: u64,
}

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Draws {
    /// The generator of one iteration.
    pub fn new(seed: u64, iteration: u64) -> Self {
        let key = mix(iteration.wrapping_mul(GOLDEN).wrapping_add(GOLDEN));
        Self {
            state: mix(seed.wrapping_add(GOLDEN) ^ key),
        }
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(GOLDEN);
        mix(self.state)
    }

    /// A number in `0..end`; 0 for an empty range.
    ///
    /// The high half of a 64 × 64 bit product: no number is favoured by more than `end` / 2⁶⁴.
    pub fn below(&mut self, end: usize) -> usize {
        ((u128::from(self.bits()) * end as u128) >> 64) as usize
    }
}

impl TryRng for Draws {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok((self.bits() >> 32) as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.bits())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(8) {
            chunk.copy_from_slice(&self.bits().to_le_bytes()[..chunk.len()]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_alone_decides() {
        let take = |seed, iteration| Draws::new(seed, iteration).bits();
        assert_eq!(take(1, 2), take(1, 2));
        let mut seen: Vec<u64> = (0..50)
            .flat_map(|s| (0..50).map(move |i| take(s, i)))
            .collect();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 2500);
    }

    #[test]
    fn below_is_uniform_over_iterations() {
        // Chi-squared with 9 degrees of freedom exceeds 27.9 once in a thousand; the seed is fixed.
        let mut counts = [0_u32; 10];
        for iteration in 0..100_000 {
            counts[Draws::new(42, iteration).below(10)] += 1;
        }
        let chi2: f64 = counts
            .iter()
            .map(|&c| (f64::from(c) - 1e4).powi(2) / 1e4)
            .sum();
        assert!(chi2 < 27.9, "{counts:?}");
        assert_eq!(Draws::new(0, 0).below(0), 0);
    }

    #[test]
    fn successive_draws_of_neighbouring_iterations_do_not_repeat_each_other() {
        let mut a = Draws::new(0, 0);
        let first: Vec<u64> = (0..100).map(|_| a.bits()).collect();
        for iteration in 1..200 {
            let mut b = Draws::new(0, iteration);
            assert!((0..100).all(|_| !first.contains(&b.bits())));
        }
    }
}
