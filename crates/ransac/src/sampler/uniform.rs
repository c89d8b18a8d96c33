use super::sampling::{Sampler, distinct};
use crate::{Draws, Estimator};

/// Every sample is equally likely.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uniform;

impl<E: Estimator> Sampler<E> for Uniform {
    fn sample(&self, estimator: &E, _: u64, draws: &mut Draws, sample: &mut [usize]) -> bool {
        distinct(draws, estimator.len(), sample)
    }
}

#[cfg(test)]
mod tests {
    use super::super::sampling::tests::Numbers;
    use super::*;

    #[test]
    fn samples_are_distinct_and_every_one_occurs() {
        // 20 triples out of 6; each is missed with probability (19/20)^2000 < 1e-44.
        let mut seen = std::collections::BTreeSet::new();
        for i in 0..2000 {
            let mut s = [0; 3];
            assert!(Uniform.sample(&Numbers(6), i, &mut Draws::new(3, i), &mut s));
            s.sort_unstable();
            assert!(s[0] < s[1] && s[1] < s[2] && s[2] < 6);
            seen.insert(s);
        }
        assert_eq!(seen.len(), 20);
    }

    #[test]
    fn every_datum_is_equally_likely() {
        // 4000 trials of 3 in 8: each datum 1500 ± 31 (one sigma); five sigma fail once in 1e6.
        let mut counts = [0_i32; 8];
        for i in 0..4000 {
            let mut s = [0; 3];
            Uniform.sample(&Numbers(8), i, &mut Draws::new(9, i), &mut s);
            for k in s {
                counts[k] += 1;
            }
        }
        assert!(counts.iter().all(|c| (c - 1500).abs() < 155), "{counts:?}");
    }

    #[test]
    fn too_few_data_give_no_sample() {
        assert!(!Uniform.sample(&Numbers(2), 0, &mut Draws::new(0, 0), &mut [0; 3]));
        let mut all = [0; 3];
        assert!(Uniform.sample(&Numbers(3), 0, &mut Draws::new(0, 0), &mut all));
        all.sort_unstable();
        assert_eq!(all, [0, 1, 2]);
    }
}
