use std::cmp::Ordering;

/// Numbers with a total order, so that sorting and selecting cannot fail.
pub trait TotalOrder: Copy {
    /// The order of `self` and `other`.
    fn total_order(&self, other: &Self) -> Ordering;
}

impl TotalOrder for f64 {
    fn total_order(&self, other: &Self) -> Ordering {
        self.total_cmp(other)
    }
}

impl TotalOrder for f32 {
    fn total_order(&self, other: &Self) -> Ordering {
        self.total_cmp(other)
    }
}

impl TotalOrder for u16 {
    fn total_order(&self, other: &Self) -> Ordering {
        self.cmp(other)
    }
}

/// The `p`-quantile, linear between neighbours: the value at the place `(n − 1) p` of the sorted values, from 0.
///
/// Type 7 of Hyndman and Fan 1996. Reorders `values`; linear time. `None` for no values and for a `p` outside 0..=1.
pub fn quantile(values: &mut [f64], p: f64) -> Option<f64> {
    let place = place(values.len(), p)?;
    let low = place.floor() as usize;
    let (_, &mut lower, above) = values.select_nth_unstable_by(low, f64::total_cmp);
    let fraction = place - low as f64;
    if fraction == 0.0 {
        return Some(lower);
    }
    let higher = above.iter().copied().min_by(f64::total_cmp)?;
    Some(lower + (higher - lower) * fraction)
}

/// [`quantile`] of values that ascend already.
pub fn quantile_of_sorted(sorted: &[f64], p: f64) -> Option<f64> {
    let place = place(sorted.len(), p)?;
    let (lower, higher) = (
        sorted[place.floor() as usize],
        sorted[place.ceil() as usize],
    );
    let fraction = place.fract();
    Some(if fraction == 0.0 {
        lower
    } else {
        lower + (higher - lower) * fraction
    })
}

/// The value at the place `(n − 1) p` of the sorted values or, between two, the lower one: NumPy's `method="lower"`.
///
/// Reorders `values`; linear time. `None` for no values and for a `p` outside 0..=1.
pub fn lower_quantile<T: TotalOrder>(values: &mut [T], p: f64) -> Option<T> {
    let place = place(values.len(), p)?;
    Some(nth(values, place.floor() as usize))
}

/// The value nearest to the place `(n − 1) p` of the sorted values; halfway between two, the higher one.
///
/// Unlike [`quantile`] it is one of the values even where some are infinite. Reorders `values`; linear time. `None`
/// for no values and for a `p` outside 0..=1.
pub fn nearest_quantile<T: TotalOrder>(values: &mut [T], p: f64) -> Option<T> {
    let place = place(values.len(), p)?;
    Some(nth(values, place.round() as usize))
}

/// The least value that more than a share `p` of the values do not exceed, the largest for `p = 1`: the place
/// `⌊n p⌋` of the sorted values.
///
/// Type 1 of Hyndman and Fan 1996 but for `n p` a whole number, where that takes the value before it. Reorders
/// `values`; linear time. `None` for no values and for a `p` outside 0..=1.
pub fn inverse_cdf<T: TotalOrder>(values: &mut [T], p: f64) -> Option<T> {
    place(values.len(), p)?;
    let place = (values.len() as f64 * p).floor() as usize;
    Some(nth(values, place.min(values.len() - 1)))
}

/// The middle value, or the mean of the two in the middle.
///
/// Reorders `values`; linear time. `None` for no values.
pub fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len().checked_sub(1)? / 2;
    let even = values.len().is_multiple_of(2);
    let (_, &mut lower, above) = values.select_nth_unstable_by(middle, f64::total_cmp);
    if !even {
        return Some(lower);
    }
    let higher = above.iter().copied().min_by(f64::total_cmp)?;
    Some(f64::midpoint(lower, higher))
}

/// The middle value, or the lower of the two in the middle.
///
/// Reorders `values`; linear time. `None` for no values.
pub fn lower_median<T: TotalOrder>(values: &mut [T]) -> Option<T> {
    let middle = values.len().checked_sub(1)? / 2;
    Some(nth(values, middle))
}

/// The middle value, or the higher of the two in the middle.
///
/// Reorders `values`; linear time. `None` for no values.
pub fn upper_median<T: TotalOrder>(values: &mut [T]) -> Option<T> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| nth(values, middle))
}

/// Place of the `p`-quantile among `n` sorted values, counted from 0.
fn place(n: usize, p: f64) -> Option<f64> {
    let last = n.checked_sub(1)?;
    (0.0..=1.0).contains(&p).then_some(p * last as f64)
}

fn nth<T: TotalOrder>(values: &mut [T], place: usize) -> T {
    *values.select_nth_unstable_by(place, T::total_order).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn by_their_definitions() {
        // R: quantile(c(1, 2, 4, 8), 0.4, type = 7) is 2.4.
        let sample = || [4.0, 1.0, 8.0, 2.0];
        assert!((quantile(&mut sample(), 0.4).unwrap() - 2.4).abs() < 1e-12);
        assert_eq!(median(&mut sample()), Some(3.0));
        assert_eq!(lower_median(&mut sample()), Some(2.0));
        assert_eq!(upper_median(&mut sample()), Some(4.0));
        // numpy.quantile([1, 2, 4, 8], 0.6, method="lower") is 2; the place is 1.8.
        assert_eq!(lower_quantile(&mut sample(), 0.6), Some(2.0));
        assert_eq!(nearest_quantile(&mut sample(), 0.6), Some(4.0));
        // One half of the values is at most 2; more than that are at most 4.
        assert_eq!(inverse_cdf(&mut sample(), 0.5), Some(4.0));
        assert_eq!(inverse_cdf(&mut sample(), 0.49), Some(2.0));
        assert_eq!(inverse_cdf(&mut sample(), 1.0), Some(8.0));
    }

    #[test]
    fn of_nothing_and_of_no_share_there_is_none() {
        assert_eq!(median(&mut []), None);
        assert_eq!(upper_median::<u16>(&mut []), None);
        assert_eq!(lower_median::<f32>(&mut []), None);
        assert_eq!(quantile_of_sorted(&[], 0.5), None);
        for p in [-0.1, 1.1, f64::NAN] {
            assert_eq!(quantile(&mut [1.0], p), None);
            assert_eq!(quantile_of_sorted(&[1.0], p), None);
            assert_eq!(lower_quantile(&mut [1_u16], p), None);
            assert_eq!(nearest_quantile(&mut [1.0_f32], p), None);
            assert_eq!(inverse_cdf(&mut [1.0], p), None);
        }
    }

    #[test]
    fn infinities_and_nan_keep_their_places() {
        let infinity = f64::INFINITY;
        assert_eq!(
            nearest_quantile(&mut [infinity, 1.0, infinity], 0.95),
            Some(infinity)
        );
        assert_eq!(
            quantile(&mut [infinity, 1.0, infinity], 0.5),
            Some(infinity)
        );
        assert_eq!(median(&mut [f64::NAN, 1.0, 2.0]), Some(2.0));
    }

    proptest! {
        #[test]
        fn selecting_gives_what_sorting_gives(values in prop::collection::vec(-50..50_i8, 1..40), p in 0.0..=1.0_f64) {
            let values: Vec<f64> = values.into_iter().map(f64::from).collect();
            let mut sorted = values.clone();
            sorted.sort_by(f64::total_cmp);
            let n = sorted.len();
            let mut scratch = values.clone();
            prop_assert_eq!(quantile(&mut scratch, p), quantile_of_sorted(&sorted, p));
            prop_assert_eq!(lower_quantile(&mut scratch, p), Some(sorted[(p * (n - 1) as f64) as usize]));
            prop_assert_eq!(nearest_quantile(&mut scratch, p), Some(sorted[(p * (n - 1) as f64).round() as usize]));
            prop_assert_eq!(median(&mut scratch), Some(f64::midpoint(sorted[(n - 1) / 2], sorted[n / 2])));
            prop_assert_eq!(lower_median(&mut scratch), Some(sorted[(n - 1) / 2]));
            prop_assert_eq!(upper_median(&mut scratch), Some(sorted[n / 2]));
            scratch.sort_by(f64::total_cmp);
            prop_assert_eq!(scratch, sorted);
        }

        #[test]
        fn more_than_a_share_does_not_exceed_the_inverse(
            values in prop::collection::vec(0..9_u16, 1..40), p in 0.0..0.999_f64,
        ) {
            let found = inverse_cdf(&mut values.clone(), p).unwrap();
            let share = |bound: u16| values.iter().filter(|&&v| v <= bound).count() as f64 / values.len() as f64;
            prop_assert!(share(found) > p - 1e-12);
            prop_assert!(found == 0 || share(found - 1) <= p + 1e-12);
        }

        #[test]
        fn quantiles_ascend_with_the_share(
            values in prop::collection::vec(-1e3..1e3_f64, 1..40), p in 0.0..=1.0_f64, q in 0.0..=1.0_f64,
        ) {
            let (low, high) = (p.min(q), p.max(q));
            let at = |p| quantile(&mut values.clone(), p).unwrap();
            prop_assert!(at(low) <= at(high));
        }
    }
}
