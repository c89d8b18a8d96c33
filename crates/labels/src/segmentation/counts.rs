use super::truth::Truth;
use serde::Serialize;

/// Thresholds of the curve: 0.01, 0.02, … 0.99.
pub(crate) const LEVELS: usize = 99;

/// The probability of the threshold of this number.
pub(crate) fn level(number: usize) -> f64 {
    (number + 1) as f64 / (LEVELS + 1) as f64
}

/// How many thresholds a probability reaches.
fn reached(p: f32) -> usize {
    // The same comparison as `p >= level`, in the precision of the probabilities.
    let guess = ((f64::from(p) * (LEVELS + 1) as f64).floor().max(0.0) as usize).min(LEVELS);
    let at_least = |count: usize| count == 0 || f64::from(p) >= level(count - 1);
    (0..=2)
        .map(|back| (guess + 1).min(LEVELS).saturating_sub(back))
        .find(|count| at_least(*count))
        .unwrap_or(0)
}

/// Wood of some width.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct WidthClass {
    /// In words.
    pub name: &'static str,
    /// Smallest width in pixels that belongs to it.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub from_px: f64,
    /// Width from which on it does not; absent for the widest.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub to_px: Option<f64>,
}

/// The classes of width: a stroke's width is twice its half width there.
pub(crate) const WIDTHS: [WidthClass; 5] = [
    width_class("under 3 px", 0.0, Some(3.0)),
    width_class("3 to 4 px", 3.0, Some(4.0)),
    width_class("4 to 8 px", 4.0, Some(8.0)),
    width_class("8 to 16 px", 8.0, Some(16.0)),
    width_class("16 px and more", 16.0, None),
];

/// From this class on, wood is at least 4 pixels wide.
pub(crate) const WIDE: usize = 2;

const fn width_class(name: &'static str, from_px: f64, to_px: Option<f64>) -> WidthClass {
    WidthClass {
        name,
        from_px,
        to_px,
    }
}

/// Bins of the calibration.
pub(crate) const BINS: usize = 10;

/// What was counted in one image, for every threshold: sums of it over images give every figure.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PixelCounts {
    /// For each width class the length of centre lines by the number of thresholds that are reached near them.
    pub(crate) lines: [Vec<f64>; WIDTHS.len()],
    /// Length of posts by the number of thresholds reached on their centre lines.
    pub(crate) posts: Vec<f64>,
    /// Pixels near wood by the number of thresholds reached.
    pub(crate) near: Vec<u64>,
    /// Pixels of wood by the number of thresholds reached.
    pub(crate) wood: Vec<u64>,
    /// Pixels that count by the number of thresholds reached.
    pub(crate) all: Vec<u64>,
    /// Pixels, those of them that are wood, and the sum of probabilities, by bins of the probability.
    pub(crate) calibration: [(u64, u64, f64); BINS],
}

impl PixelCounts {
    /// Counts nothing.
    pub(crate) fn zero() -> Self {
        let none = || vec![0.0; LEVELS + 1];
        Self {
            lines: std::array::from_fn(|_| none()),
            posts: none(),
            near: vec![0; LEVELS + 1],
            wood: vec![0; LEVELS + 1],
            all: vec![0; LEVELS + 1],
            calibration: [(0, 0, 0.0); BINS],
        }
    }

    /// Counts the probabilities of wood `p` of an image, row by row; an unseen pixel, NaN, has none.
    pub(crate) fn of(truth: &Truth, p: &[f32], tolerance: f64) -> Self {
        let mut counts = Self::zero();
        let count_of: Vec<u8> = p
            .iter()
            .map(|p| if p.is_nan() { 0 } else { reached(*p) as u8 })
            .collect();
        for (k, &count) in count_of.iter().enumerate() {
            if truth.ignored[k] {
                continue;
            }
            let count = usize::from(count);
            counts.all[count] += 1;
            counts.near[count] += u64::from(truth.near[k]);
            counts.wood[count] += u64::from(truth.wood[k]);
            if !truth.unsure[k] && !p[k].is_nan() {
                let bin = ((p[k] * BINS as f32) as usize).min(BINS - 1);
                let (pixels, wood, sum) = &mut counts.calibration[bin];
                *pixels += 1;
                *wood += u64::from(truth.wood[k]);
                *sum += f64::from(p[k]);
            }
        }
        let disc = disc(tolerance);
        for sample in &truth.wood_samples {
            let place = [sample.point.x, sample.point.y];
            let best = highest_near(truth.size, &count_of, place, tolerance, &disc);
            let width = 2.0 * sample.point.half_width;
            let class = WIDTHS.iter().rposition(|class| width >= class.from_px);
            counts.lines[class.unwrap_or(0)][best] += sample.length;
        }
        for sample in &truth.post_samples {
            counts.posts[usize::from(count_of[truth.pixel(sample)])] += sample.length;
        }
        counts
    }

    /// Adds another image's counts, `times` times.
    pub(crate) fn add(&mut self, other: &Self, times: u64) {
        let real = |sum: &mut Vec<f64>, more: &[f64]| {
            for (sum, more) in sum.iter_mut().zip(more) {
                *sum += times as f64 * more;
            }
        };
        let whole = |sum: &mut Vec<u64>, more: &[u64]| {
            for (sum, more) in sum.iter_mut().zip(more) {
                *sum += times * more;
            }
        };
        for (sum, more) in self.lines.iter_mut().zip(&other.lines) {
            real(sum, more);
        }
        real(&mut self.posts, &other.posts);
        whole(&mut self.near, &other.near);
        whole(&mut self.wood, &other.wood);
        whole(&mut self.all, &other.all);
        for (sum, more) in self.calibration.iter_mut().zip(&other.calibration) {
            sum.0 += times * more.0;
            sum.1 += times * more.1;
            sum.2 += times as f64 * more.2;
        }
    }
}

/// Of what is counted by the number of thresholds reached, the sum that reaches the threshold of this number.
pub(crate) fn reaching<T: Copy + std::iter::Sum>(counts: &[T], threshold: usize) -> T {
    counts[threshold + 1..].iter().copied().sum()
}

/// Offsets from a pixel to those whose centres may be within `tolerance` of a point in it.
fn disc(tolerance: f64) -> Vec<[i64; 2]> {
    let reach = tolerance.ceil() as i64 + 1;
    let range = -reach..=reach;
    range
        .clone()
        .flat_map(|dv| range.clone().map(move |du| [du, dv]))
        .filter(|[du, dv]| {
            let beyond = |d: i64| (d.abs() as f64 - 0.5).max(0.0);
            beyond(*du).hypot(beyond(*dv)) <= tolerance
        })
        .collect()
}

/// The most thresholds that are reached by the pixel that holds a point, and by those whose centres are within
/// `tolerance` of it.
fn highest_near(
    [width, height]: [usize; 2],
    count_of: &[u8],
    [x, y]: [f64; 2],
    tolerance: f64,
    disc: &[[i64; 2]],
) -> usize {
    let inside = |at: i64, size: usize| (0..size as i64).contains(&at);
    let best = disc.iter().filter_map(|[du, dv]| {
        let (u, v) = (x.floor() as i64 + du, y.floor() as i64 + dv);
        let (dx, dy) = (u as f64 + 0.5 - x, v as f64 + 0.5 - y);
        let is_near = [*du, *dv] == [0, 0] || dx * dx + dy * dy <= tolerance * tolerance;
        (is_near && inside(u, width) && inside(v, height))
            .then(|| count_of[v as usize * width + u as usize])
    });
    usize::from(best.max().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_reached_are_those_not_above() {
        for number in 0..LEVELS {
            let p = level(number) as f32;
            let count = reached(p);
            let expected = (0..LEVELS).filter(|n| f64::from(p) >= level(*n)).count();
            assert_eq!(count, expected, "{p}");
        }
        assert_eq!((reached(0.0), reached(0.005), reached(1.0)), (0, 0, LEVELS));
    }

    #[test]
    fn widths_are_covered_without_a_gap() {
        for pair in WIDTHS.windows(2) {
            assert_eq!(pair[0].to_px, Some(pair[1].from_px));
        }
        assert_eq!(WIDTHS[WIDE].from_px, 4.0);
    }
}
