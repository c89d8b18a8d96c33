use super::sampling::{Sampler, distinct};
use crate::{Draws, Estimator};

/// The best data first: PROSAC (Chum and Matas 2005, doi 10.1109/CVPR.2005.221).
///
/// The data are ranked by some quality (a match's similarity, a reading's
/// confidence). Samples are drawn from the n best, and n grows as fast as it would in
/// a uniform search of `growth` samples, sorted so that samples of better data come first. After
/// them every sample is equally likely.
///
/// How far n has grown depends on the iteration's number alone (section 2.1): with
/// T(m) = growth · Π 1/C(N, m) for the sample size m, `T(n + 1) = T(n) (n + 1)/(n + 1 − m)`, and
/// T′(m) = 1, `T′(n + 1) = T′(n) + ⌈T(n + 1) − T(n)⌉`, iteration t ≤ T′(N) takes the smallest n with
/// T′(n) ≥ t: the n-th best datum, and m − 1 of the n − 1 better ones (algorithm 1).
///
/// The stopping rule sees uniform samples where these are better, and so errs on the safe side.
#[derive(Clone, Debug, PartialEq)]
pub struct Prosac {
    order: Vec<usize>,
    /// T′(m), T′(m + 1), ..., T′(N).
    ends: Vec<u64>,
}

impl Prosac {
    /// Ranks the data by `quality`, the highest first; equal ones keep their order.
    ///
    /// `sample_size` is the estimator's; `growth` is the number of samples, T(N), after
    /// which the search becomes uniform (the authors take 200 000). A quality that is NaN ranks last.
    pub fn by_quality(quality: &[f64], sample_size: usize, growth: u64) -> Self {
        let mut order: Vec<usize> = (0..quality.len()).collect();
        let rank = |i: usize| {
            let q = quality[i];
            if q.is_nan() { f64::NEG_INFINITY } else { q }
        };
        order.sort_by(|&a, &b| rank(b).total_cmp(&rank(a)));
        Self {
            ends: ends(quality.len(), sample_size, growth),
            order,
        }
    }

    /// Data from the best to the worst.
    pub fn order(&self) -> &[usize] {
        &self.order
    }
}

/// T′(n) for n = m..=N.
fn ends(data: usize, sample_size: usize, growth: u64) -> Vec<u64> {
    if sample_size == 0 || data < sample_size {
        return Vec::new();
    }
    let m = sample_size as f64;
    let mut samples = (0..sample_size).fold(growth as f64, |t, i| {
        t * (m - i as f64) / (data as f64 - i as f64)
    });
    let mut end = 1_u64;
    let mut ends = vec![end];
    for n in sample_size..data {
        let next = samples * (n + 1) as f64 / ((n + 1) as f64 - m);
        // A whole number must not become the next one by its rounding.
        end = end.saturating_add((next - samples - 1e-9 * next).ceil() as u64);
        ends.push(end);
        samples = next;
    }
    ends
}

impl<E: Estimator> Sampler<E> for Prosac {
    /// Without a sample where the ranking is not of as many data as there are.
    fn sample(
        &self,
        estimator: &E,
        iteration: u64,
        draws: &mut Draws,
        sample: &mut [usize],
    ) -> bool {
        let data = self.order.len();
        if data != estimator.len() || data < sample.len() || sample.is_empty() {
            return false;
        }
        let step = self.ends.partition_point(|&end| end <= iteration);
        let (last, best) = if step < self.ends.len() {
            // The data of rank 0..best are better than the one that belongs to this step.
            let best = self.ends.len().abs_diff(data) + step;
            (Some(best), best)
        } else {
            (None, data)
        };
        let drawn = sample.len() - usize::from(last.is_some());
        if !distinct(draws, best, &mut sample[..drawn]) {
            return false;
        }
        if let (Some(last), Some(place)) = (last, sample.last_mut()) {
            *place = last;
        }
        for place in sample {
            *place = self.order[*place];
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::sampling::tests::Numbers;
    use super::*;

    fn samples(prosac: &Prosac, iterations: std::ops::Range<u64>) -> Vec<[usize; 3]> {
        iterations
            .map(|i| {
                let mut sample = [0; 3];
                let estimator = Numbers(prosac.order.len());
                assert!(prosac.sample(&estimator, i, &mut Draws::new(5, i), &mut sample));
                sample.sort_unstable();
                sample
            })
            .collect()
    }

    #[test]
    fn the_growth_is_that_of_the_paper() {
        // T(n) = growth C(n, m)/C(N, m): 4 of 4 with growth 40 and m = 3 gives T(3) = 10, T(4) = 40.
        assert_eq!(ends(4, 3, 40), [1, 31]);
        // By hand for N = 6, m = 2, growth 15: T(n) = C(n, 2) = 1, 3, 6, 10, 15.
        assert_eq!(ends(6, 2, 15), [1, 3, 6, 10, 15]);
        assert!(ends(2, 3, 40).is_empty());
    }

    #[test]
    fn samples_grow_from_the_best_data() {
        // Quality falls with the number: datum 0 is the best.
        let quality: Vec<f64> = (0..20).map(|i| -f64::from(i)).collect();
        let prosac = Prosac::by_quality(&quality, 3, 1140);
        let early = samples(&prosac, 0..1140);
        assert_eq!(early[0], [0, 1, 2]);
        assert!(early.iter().all(|s| s[0] < s[1] && s[1] < s[2]));
        for (t, sample) in early.iter().enumerate() {
            let n = prosac.ends.partition_point(|&end| end <= t as u64) + 3;
            assert_eq!(sample[2], n - 1, "the newest datum is always in");
        }
        // C(20, 3) = 1140: afterwards every sample occurs.
        let late = samples(&prosac, 1140..9000);
        let distinct: std::collections::BTreeSet<_> = late.into_iter().collect();
        assert!(distinct.len() > 1130);
    }

    #[test]
    fn quality_decides_and_nan_is_last() {
        let prosac = Prosac::by_quality(&[0.1, f64::NAN, 0.9, 0.5, 0.9], 3, 100);
        assert_eq!(prosac.order(), [2, 4, 3, 0, 1]);
        let of_others = Prosac::by_quality(&[1.0; 4], 3, 100);
        assert!(!of_others.sample(&Numbers(5), 0, &mut Draws::new(0, 0), &mut [0; 3]));
        assert!(!of_others.sample(&Numbers(0), 0, &mut Draws::new(0, 0), &mut [0; 3]));
    }
}
