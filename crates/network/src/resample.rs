/// Largest reduction at which an axis is interpolated, in old pixels for each new one. Beyond 2, bilinear
/// interpolation, which reads two pixels, would skip some; there an axis is averaged over areas.
const LARGEST_INTERPOLATED_REDUCTION: f64 = 2.0;

/// How an image is resampled along one axis: for each new pixel, the old pixels and their weights.
pub(crate) struct Resampling {
    /// For each new pixel: its first old one, its first weight, and how many they are.
    spans: Vec<(usize, usize, usize)>,
    weights: Vec<f32>,
}

impl Resampling {
    /// From `old` pixels to `new` ones, both at least 1; pixels are areas, and both rows of them span the same length.
    pub(crate) fn new(old: usize, new: usize) -> Self {
        let ratio = old as f64 / new as f64;
        let mut resampling = Self {
            spans: Vec::with_capacity(new),
            weights: Vec::with_capacity(2 * new),
        };
        for i in 0..new {
            if ratio > LARGEST_INTERPOLATED_REDUCTION {
                resampling.average(i as f64 * ratio, (i + 1) as f64 * ratio, old);
            } else {
                resampling.interpolate((i as f64 + 0.5) * ratio - 0.5, old);
            }
        }
        resampling
    }

    /// The old pixels and weights of a new pixel.
    pub(crate) fn taps(&self, i: usize) -> impl Iterator<Item = (usize, f32)> {
        let (first, start, count) = self.spans[i];
        (first..).zip(self.weights[start..start + count].iter().copied())
    }

    /// The new pixels from old ones whose values are `step` numbers apart.
    pub(crate) fn mix(&self, old: &[f32], step: usize, new: &mut [f32]) {
        for (new, &(first, start, count)) in new.iter_mut().zip(&self.spans) {
            let old = &old[first * step..];
            *new = match self.weights[start..start + count] {
                [only] => only * old[0],
                [here, next] => here * old[0] + next * old[step],
                ref weights => {
                    let mixed = weights.iter().zip(old.iter().step_by(step));
                    mixed.map(|(weight, old)| weight * old).sum()
                }
            };
        }
    }

    /// Between the two centres beside `centre`, which counts from the centre of the first pixel.
    fn interpolate(&mut self, centre: f64, old: usize) {
        let centre = centre.clamp(0.0, (old - 1) as f64);
        let first = centre as usize;
        let share = (centre - first as f64) as f32;
        let start = self.weights.len();
        self.weights.push(1.0 - share);
        if share > 0.0 && first + 1 < old {
            self.weights.push(share);
        }
        self.spans.push((first, start, self.weights.len() - start));
    }

    /// Over the pixels from `begin` to `end`, each by the part that lies between.
    fn average(&mut self, begin: f64, end: f64, old: usize) {
        let first = (begin as usize).min(old - 1);
        let last = (end.ceil() as usize).clamp(first + 1, old);
        let start = self.weights.len();
        for k in first..last {
            let part = end.min((k + 1) as f64) - begin.max(k as f64);
            self.weights.push((part.max(0.0) / (end - begin)) as f32);
        }
        self.spans.push((first, start, last - first));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Weights add up to one, and a ramp of brightness stays one: each new pixel gets the brightness at its
        /// centre, but for the half pixel at each end where there is nothing to interpolate with. An average counts
        /// a pixel of which it covers a part p as if it were all there: at most p(1 - p)/2 on one side, an eighth
        /// of a pixel over the number of pixels averaged.
        #[test]
        fn a_ramp_stays_a_ramp(old in 1_usize..3000, new in 1_usize..1000) {
            let resampling = Resampling::new(old, new);
            let ratio = old as f64 / new as f64;
            for i in 0..new {
                let total: f32 = resampling.taps(i).map(|(_, w)| w).sum();
                prop_assert!((total - 1.0).abs() < 1e-4, "{total}");
                prop_assert!(resampling.taps(i).all(|(k, w)| k < old && (0.0..=1.0).contains(&w)));
                let mean: f64 = resampling.taps(i).map(|(k, w)| k as f64 * f64::from(w)).sum();
                let centre = ((i as f64 + 0.5) * ratio - 0.5).clamp(0.0, (old - 1) as f64);
                let parts = if ratio > LARGEST_INTERPOLATED_REDUCTION { 0.125 / ratio } else { 0.0 };
                let rounding = 1e-6 * (1.0 + centre);
                prop_assert!((mean - centre).abs() < parts + rounding, "{mean} {centre}");
            }
        }
    }

    #[test]
    fn areas_lose_no_pixel() {
        let resampling = Resampling::new(10, 3);
        let mut sums = [0.0; 10];
        for i in 0..3 {
            for (k, w) in resampling.taps(i) {
                sums[k] += w;
            }
        }
        for sum in sums {
            assert!((sum - 0.3).abs() < 1e-6, "{sums:?}");
        }
    }
}
