use serde::{Deserialize, Serialize};

/// Two-sided 95 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// A share of a whole with its 95 % Wilson interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Proportion {
    /// How many.
    pub count: usize,
    /// Of how many.
    pub of: usize,
    /// `count / of`; 0 where `of` is 0.
    pub share: f64,
    /// Lower end of the interval; 0 where `of` is 0.
    pub low: f64,
    /// Upper end of the interval; 1 where `of` is 0.
    pub high: f64,
}

impl Proportion {
    /// `count` of `of`, with the score interval of Wilson (1927), J. Am. Stat. Assoc. 22, 209–212.
    pub fn new(count: usize, of: usize) -> Self {
        if of == 0 {
            return Self {
                count,
                of,
                share: 0.0,
                low: 0.0,
                high: 1.0,
            };
        }
        let (n, z2) = (of as f64, NORMAL_95 * NORMAL_95);
        let p = count as f64 / n;
        let middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
        let half = NORMAL_95 / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
        // At 0 and at 1 the closed form gives the bound itself, but for rounding.
        let low = if count == 0 {
            0.0
        } else {
            (middle - half).max(0.0)
        };
        let high = if count == of {
            1.0
        } else {
            (middle + half).min(1.0)
        };
        Self {
            count,
            of,
            share: p,
            low,
            high,
        }
    }

    /// The share of `values` that `holds` is true for.
    pub fn of(values: &[f64], holds: impl Fn(f64) -> bool) -> Self {
        Self::new(values.iter().filter(|&&v| holds(v)).count(), values.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-4
    }

    #[test]
    fn wilson_intervals_as_published() {
        // Newcombe 1998, Stat. Med. 17, table I, method 3: 81/263, 15/148, 0/20, 1/29.
        for (count, of, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let share = Proportion::new(count, of);
            assert!(
                close(share.low, low) && close(share.high, high),
                "{share:?}"
            );
        }
        assert_eq!(Proportion::new(7, 7).high, 1.0);
        assert_eq!(Proportion::new(0, 0).share, 0.0);
    }

    proptest! {
        #[test]
        fn the_ends_are_where_the_score_test_rejects(count in 0..200_usize, more in 0..200_usize) {
            let of = count + more;
            prop_assume!(of > 0);
            let p = Proportion::new(count, of);
            prop_assert!(0.0 <= p.low && p.low <= p.share && p.share <= p.high && p.high <= 1.0);
            let score = |bound: f64| (p.share - bound).abs() / (bound * (1.0 - bound) / of as f64).sqrt();
            for bound in [p.low, p.high].into_iter().filter(|b| (1e-9..1.0 - 1e-9).contains(b)) {
                prop_assert!((score(bound) - NORMAL_95).abs() < 1e-6);
            }
        }
    }
}
