/// Squared distance of each pixel's centre from the nearest centre of a pixel that is set, in pixels, row by row;
/// infinite where none is set.
///
/// Column by column to the nearest in the column, then row by row the lower envelope of parabolas: Felzenszwalb and
/// Huttenlocher 2012, "Distance Transforms of Sampled Functions", doi 10.4086/toc.2012.v008a019.
pub(crate) fn squared_distances(
    [width, height]: [usize; 2],
    is_set: impl Fn(usize) -> bool,
) -> Vec<f64> {
    let mut squared = vec![f64::INFINITY; width * height];
    for u in 0..width {
        let mut sweep = |rows: &mut dyn Iterator<Item = usize>| {
            let mut distance = f64::INFINITY;
            for v in rows {
                let k = v * width + u;
                distance = if is_set(k) { 0.0 } else { distance + 1.0 };
                squared[k] = squared[k].min(distance * distance);
            }
        };
        sweep(&mut (0..height));
        sweep(&mut (0..height).rev());
    }
    let mut hull: Vec<Parabola> = Vec::new();
    for row in squared.chunks_exact_mut(width.max(1)) {
        hull.clear();
        for (u, &height) in row.iter().enumerate().filter(|(_, d)| d.is_finite()) {
            let mut next = Parabola {
                at: u as f64,
                height,
                from: f64::NEG_INFINITY,
            };
            while let Some(last) = hull.last() {
                next.from = last.meets(&next);
                if next.from > last.from {
                    break;
                }
                hull.pop();
                next.from = f64::NEG_INFINITY;
            }
            hull.push(next);
        }
        let mut lowest = 0;
        for (u, squared) in row.iter_mut().enumerate() {
            let u = u as f64;
            while hull.get(lowest + 1).is_some_and(|next| next.from <= u) {
                lowest += 1;
            }
            if let Some(parabola) = hull.get(lowest) {
                *squared = (u - parabola.at).powi(2) + parabola.height;
            }
        }
    }
    squared
}

/// Squared distances along a row from one place in it.
struct Parabola {
    at: f64,
    height: f64,
    /// From here on it is the lowest.
    from: f64,
}

impl Parabola {
    /// Where one further right becomes the lower one.
    fn meets(&self, right: &Self) -> f64 {
        let value = |p: &Self| p.height + p.at * p.at;
        (value(right) - value(self)) / (2.0 * (right.at - self.at))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn they_are_those_by_definition(
            width in 1_usize..14, height in 1_usize..14,
            set in proptest::collection::vec(proptest::bool::weighted(0.1), 14 * 14),
        ) {
            let found = squared_distances([width, height], |k| set[k]);
            for (k, found) in found.iter().enumerate() {
                let squared = |other: usize| {
                    let du = (k % width).abs_diff(other % width);
                    let dv = (k / width).abs_diff(other / width);
                    (du * du + dv * dv) as f64
                };
                let all = (0..width * height).filter(|other| set[*other]).map(squared);
                prop_assert_eq!(*found, all.fold(f64::INFINITY, f64::min), "{}", k);
            }
        }
    }
}
