use crate::Draws;
use rand_core::Rng;

/// A random order of the data, made once, so that the first few are a fair sample of all.
///
/// [`Statistical`](crate::Statistical) needs data in random order. The estimator is given the shuffled
/// copies of its arrays, and the inliers of the report are brought back:
///
/// ```
/// use pomona_ransac::Shuffle;
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
///
/// let x = [10.0, 11.0, 12.0, 13.0];
/// let shuffle = Shuffle::new(x.len(), &mut ChaCha8Rng::seed_from_u64(3));
/// let shuffled: Vec<f64> = shuffle.apply(&x);
///
/// // Positions in the shuffled array become those in the caller's own.
/// let mut inliers = vec![0, 2];
/// let values: Vec<f64> = inliers.iter().map(|&i| shuffled[i]).collect();
/// shuffle.restore(&mut inliers);
/// assert!(inliers.is_sorted() && inliers.iter().all(|&i| values.contains(&x[i])));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Shuffle {
    order: Vec<usize>,
}

impl Shuffle {
    /// An order of `len` data, each equally likely (Durstenfeld 1964, doi 10.1145/364520.364540).
    ///
    /// One number is taken from `rng`.
    pub fn new<R: Rng + ?Sized>(len: usize, rng: &mut R) -> Self {
        let mut shuffle = Self::default();
        shuffle.renew(len, rng);
        shuffle
    }

    /// Becomes another order, in the same memory where that is enough.
    ///
    /// One number is taken from `rng`, and the order is that of [`new`](Self::new).
    pub fn renew<R: Rng + ?Sized>(&mut self, len: usize, rng: &mut R) {
        let mut draws = Draws::new(rng.next_u64(), u64::MAX);
        self.order.clear();
        self.order.extend(0..len);
        let order = self.order.as_mut_slice();
        for last in (1..len).rev() {
            order.swap(last, draws.below(last + 1));
        }
    }

    /// The place that each shuffled datum had.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// The elements of `data` in shuffled order; those missing in a shorter slice are left out.
    pub fn apply<T: Copy>(&self, data: &[T]) -> Vec<T> {
        let mut out = Vec::new();
        self.apply_into(data, &mut out);
        out
    }

    /// Replaces `out` by the elements of `data` in shuffled order; those missing in a shorter slice are left out.
    pub fn apply_into<T: Copy>(&self, data: &[T], out: &mut Vec<T>) {
        out.clear();
        if data.len() < self.order.len() {
            out.extend(self.order.iter().filter_map(|&i| data.get(i).copied()));
        } else {
            out.extend(self.order.iter().map(|&i| data[i]));
        }
    }

    /// Turns positions in the shuffled data into ascending positions in the caller's.
    ///
    /// Positions past the end are dropped.
    pub fn restore(&self, positions: &mut Vec<usize>) {
        positions.retain_mut(|position| {
            let original = self.order.get(*position);
            *position = original.copied().unwrap_or_default();
            original.is_some()
        });
        positions.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_is_equally_likely() {
        // 6 orders of 3, 6000 trials: chi-squared with 5 degrees exceeds 20.5 once in a thousand.
        let mut counts = std::collections::BTreeMap::new();
        for seed in 0..6000 {
            let shuffle = Shuffle::new(3, &mut Draws::new(seed, 0));
            *counts.entry(shuffle.order).or_insert(0_i32) += 1;
        }
        let chi2: f64 = counts
            .values()
            .map(|&c| f64::from(c - 1000).powi(2) / 1000.0)
            .sum();
        assert!(counts.len() == 6 && chi2 < 20.5, "{counts:?}");
    }

    #[test]
    fn what_is_shuffled_comes_back() {
        let data: Vec<u32> = (0..100).collect();
        let shuffle = Shuffle::new(100, &mut Draws::new(1, 2));
        let shuffled = shuffle.apply(&data);
        assert_ne!(shuffled, data);
        let mut even: Vec<usize> = (0..100)
            .filter(|&i| shuffled[i].is_multiple_of(2))
            .collect();
        let mut into = vec![7];
        shuffle.apply_into(&data, &mut into);
        assert_eq!(into, shuffled);
        shuffle.apply_into(&data[..50], &mut into);
        assert!(into.len() == 50 && into.iter().all(|i| *i < 50));
        let mut again = Shuffle::new(7, &mut Draws::new(5, 5));
        again.renew(100, &mut Draws::new(1, 2));
        assert_eq!(again, shuffle);
        even.push(100);
        shuffle.restore(&mut even);
        assert_eq!(even, (0..100).step_by(2).collect::<Vec<_>>());
    }
}
