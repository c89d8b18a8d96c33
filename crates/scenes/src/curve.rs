use nalgebra::{Isometry3, Point3, Vector3};

/// A smooth centre line: a cubic Bézier curve, whose parameter runs from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Start, two handles, end.
    pub controls: [Point3<f64>; 4],
}

impl Curve {
    /// The straight way from `start` to `end`, at even speed.
    pub fn straight(start: Point3<f64>, end: Point3<f64>) -> Self {
        let along = end - start;
        Self {
            controls: [start, start + along / 3.0, start + along * (2.0 / 3.0), end],
        }
    }

    /// A bow that leaves `start` along `leaving` and ends at `end`, gently bent.
    ///
    /// Only the direction of `leaving` counts.
    pub fn bow(start: Point3<f64>, leaving: Vector3<f64>, end: Point3<f64>) -> Self {
        let chord = end - start;
        let handle = leaving.normalize() * (chord.norm() / 3.0);
        // The last handle lies a third of the way back from the end to the first one's tip.
        let last = end - (end - (start + handle)) / 2.0;
        Self {
            controls: [start, start + handle, last, end],
        }
    }

    /// A parabola with `middle` at parameter one half, where it runs along `tangent`;
    /// `length` is that of its flat middle, `bow` the way of both ends from the tangent.
    ///
    /// Only the direction of `tangent` counts; one without length gives a curve without length.
    pub fn through(
        middle: Point3<f64>,
        tangent: Vector3<f64>,
        length: f64,
        bow: Vector3<f64>,
    ) -> Self {
        let half = tangent.try_normalize(0.0).unwrap_or_default() * (0.5 * length);
        // A quadratic Bézier curve with the middle control at middle − bow, raised to a cubic.
        let (start, end, handle) = (middle - half + bow, middle + half + bow, middle - bow);
        let two_thirds = |from: Point3<f64>| from + (handle - from) * (2.0 / 3.0);
        Self {
            controls: [start, two_thirds(start), two_thirds(end), end],
        }
    }

    /// The point at parameter `s`.
    pub fn point(&self, s: f64) -> Point3<f64> {
        let r = 1.0 - s;
        let weights = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
        let sum = |acc: Vector3<f64>, (p, w): (&Point3<f64>, f64)| acc + p.coords * w;
        Point3::from(
            self.controls
                .iter()
                .zip(weights)
                .fold(Vector3::zeros(), sum),
        )
    }

    /// The derivative by the parameter: along the tangent.
    pub fn derivative(&self, s: f64) -> Vector3<f64> {
        let [a, b, c, d] = self.controls;
        let r = 1.0 - s;
        ((b - a) * (r * r) + (c - b) * (2.0 * r * s) + (d - c) * (s * s)) * 3.0
    }

    /// Length, metres, as the sum of 64 chords.
    pub fn length(&self) -> f64 {
        let nodes: Vec<_> = self.nodes(64).collect();
        nodes.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
    }

    /// Parameter of the point nearest to `target`.
    ///
    /// The nearest of 256 samples, then a bisection between its neighbours on the
    /// derivative of the squared distance, which keeps more digits than comparing distances.
    pub fn nearest(&self, target: &Point3<f64>) -> f64 {
        let squared = |s: f64| (self.point(s) - target).norm_squared();
        let samples = 256;
        let best = (0..=samples)
            .map(|i| f64::from(i) / f64::from(samples))
            .min_by(|a, b| squared(*a).total_cmp(&squared(*b)))
            .unwrap_or(0.0);
        let step = 1.0 / f64::from(samples);
        let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(1.0));
        let slope = |s: f64| (self.point(s) - target).dot(&self.derivative(s));
        if slope(low) >= 0.0 {
            return low;
        }
        if slope(high) <= 0.0 {
            return high;
        }
        while high - low > 1e-14 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if slope(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// `count + 1` points at even parameters, both ends among them.
    pub(crate) fn nodes(&self, count: usize) -> impl Iterator<Item = Point3<f64>> + '_ {
        (0..=count).map(move |i| self.point(i as f64 / count as f64))
    }

    pub(crate) fn transformed(&self, by: &Isometry3<f64>) -> Self {
        Self {
            controls: self.controls.map(|p| by * p),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_curve_is_the_segment() {
        let curve = Curve::straight(Point3::new(-1.0, 0.0, 2.0), Point3::new(3.0, 0.0, 2.0));
        assert!((curve.length() - 4.0).abs() < 1e-12);
        let s = curve.nearest(&Point3::new(0.0, 5.0, 2.0));
        assert!((s - 0.25).abs() < 1e-12);
        assert!((curve.point(s) - Point3::new(0.0, 0.0, 2.0)).norm() < 1e-12);
    }

    #[test]
    fn parabola_touches_its_tangent_in_the_middle() {
        let bow = Vector3::new(0.0, 0.03, 0.0);
        let curve = Curve::through(Point3::new(0.1, 0.2, 0.3), Vector3::x() * 7.0, 0.4, bow);
        assert!((curve.point(0.5) - Point3::new(0.1, 0.2, 0.3)).norm() < 1e-15);
        assert!((curve.derivative(0.5) - Vector3::x() * 0.4).norm() < 1e-15);
        assert!((curve.point(1.0) - Point3::new(0.3, 0.23, 0.3)).norm() < 1e-15);
    }

    #[test]
    fn nearest_point_stands_across_the_tangent() {
        let curve = Curve::bow(
            Point3::origin(),
            Vector3::new(1.0, -1.0, 0.2),
            Point3::new(0.5, 0.1, 0.1),
        );
        let target = Point3::new(0.2, 0.05, 0.0);
        let s = curve.nearest(&target);
        let gap = curve.point(s) - target;
        assert!(gap.dot(&curve.derivative(s).normalize()).abs() < 1e-9);
        for i in 0..=1000 {
            let other = curve.point(f64::from(i) / 1000.0) - target;
            assert!(other.norm() >= gap.norm() - 1e-12);
        }
    }

    #[test]
    fn ends_are_the_nearest_of_what_lies_beyond() {
        let curve = Curve::straight(Point3::origin(), Point3::new(1.0, 0.0, 0.0));
        assert_eq!(curve.nearest(&Point3::new(-2.0, 1.0, 0.0)), 0.0);
        assert_eq!(curve.nearest(&Point3::new(2.0, 1.0, 0.0)), 1.0);
    }
}
