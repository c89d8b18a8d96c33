use nalgebra::SVector;

/// Pascal's triangle.
const BINOMIAL: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// Position, velocity and acceleration at one time, in a unit and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const D: usize> {
    /// Position.
    pub position: SVector<f64, D>,
    /// Velocity, per second.
    pub velocity: SVector<f64, D>,
    /// Acceleration, per second squared.
    pub acceleration: SVector<f64, D>,
}

impl<const D: usize> State<D> {
    /// At rest at `position`.
    pub fn at_rest(position: SVector<f64, D>) -> Self {
        Self {
            position,
            velocity: SVector::zeros(),
            acceleration: SVector::zeros(),
        }
    }
}

/// A polynomial of degree five in time: p(t) = Σ cₖ tᵏ, with t from 0 to its duration in seconds.
///
/// It is the curve of least squared jerk between two states (Flash and Hogan 1985,
/// doi `10.1523/JNEUROSCI.05-07-01688.1985`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quintic<const D: usize> {
    /// c₀ to c₅; cₖ has the unit of the position per secondᵏ.
    pub coefficients: [SVector<f64, D>; 6],
    /// Duration in seconds, positive.
    pub duration_s: f64,
}

impl<const D: usize> Quintic<D> {
    /// The quintic from one state to another in `duration_s` seconds, or `None` unless that is
    /// finite and positive and all numbers are finite.
    pub fn between(start: &State<D>, end: &State<D>, duration_s: f64) -> Option<Self> {
        let t = duration_s;
        let gap = end.position - start.position;
        let (v0, v1) = (start.velocity * t, end.velocity * t);
        let (a0, a1) = (start.acceleration * (t * t), end.acceleration * (t * t));
        // The six conditions at τ = t / duration of 0 and 1, solved.
        let unscaled = [
            start.position,
            v0,
            a0 * 0.5,
            gap * 10.0 - v0 * 6.0 - v1 * 4.0 - a0 * 1.5 + a1 * 0.5,
            gap * -15.0 + v0 * 8.0 + v1 * 7.0 + a0 * 1.5 - a1,
            gap * 6.0 - (v0 + v1) * 3.0 + (a1 - a0) * 0.5,
        ];
        let mut scale = 1.0;
        let coefficients = unscaled.map(|c| {
            let scaled = c * scale;
            scale /= t;
            scaled
        });
        let finite = coefficients.iter().all(|c| c.iter().all(|x| x.is_finite()));
        (t.is_finite() && t > 0.0 && finite).then_some(Self {
            coefficients,
            duration_s,
        })
    }

    /// Position, velocity and acceleration at a time; before 0 and after the end it goes on as
    /// a polynomial does.
    pub fn at(&self, time_s: f64) -> State<D> {
        let c = &self.coefficients;
        let t = time_s;
        let mut state = State::at_rest(c[5]);
        // Horner's scheme, for the polynomial and its two derivatives at once.
        for coefficient in c[..5].iter().rev() {
            state.acceleration = state.acceleration * t + state.velocity * 2.0;
            state.velocity = state.velocity * t + state.position;
            state.position = state.position * t + coefficient;
        }
        state
    }

    /// The position alone at a time.
    pub(crate) fn position(&self, time_s: f64) -> SVector<f64, D> {
        let [rest @ .., last] = &self.coefficients;
        rest.iter().rev().fold(*last, |sum, c| sum * time_s + c)
    }

    /// A bound on the speed from one time to another, in the unit of the position per second.
    ///
    /// The velocity's Bernstein coefficients over the interval hold it in their convex hull
    /// (Farouki 2012, Section 3.1, doi 10.1016/j.cagd.2012.03.001); the bound is the largest of
    /// their norms, never less than the speed, and the tighter the shorter the interval.
    pub fn speed_bound(&self, from_s: f64, to_s: f64) -> f64 {
        let c = &self.coefficients;
        let mut power = [c[1], c[2] * 2.0, c[3] * 3.0, c[4] * 4.0, c[5] * 5.0];
        // Taylor shift to from_s, then scale to the unit interval.
        for i in 0..4 {
            for j in (i..4).rev() {
                let next = power[j + 1];
                power[j] += next * from_s;
            }
        }
        let (width, mut scale) = (to_s - from_s, 1.0);
        for p in &mut power {
            *p *= scale;
            scale *= width;
        }
        let mut largest: f64 = 0.0;
        for row in &BINOMIAL {
            let mut b = SVector::<f64, D>::zeros();
            for k in 0..5 {
                b += power[k] * (row[k] / BINOMIAL[4][k]);
            }
            largest = largest.max(b.norm());
        }
        largest
    }

    /// A bound on the speed over the whole duration, from `parts` equal intervals.
    pub(crate) fn largest_speed(&self, parts: usize) -> f64 {
        let step = self.duration_s / parts as f64;
        (0..parts)
            .map(|i| self.speed_bound(i as f64 * step, (i + 1) as f64 * step))
            .fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector1, Vector2};
    use proptest::prelude::*;

    fn numbers() -> impl Strategy<Value = [f64; 2]> {
        prop::array::uniform2(-2.0..2.0f64)
    }

    fn state() -> impl Strategy<Value = State<2>> {
        (numbers(), numbers(), numbers()).prop_map(|(p, v, a)| State {
            position: Vector2::from(p),
            velocity: Vector2::from(v),
            acceleration: Vector2::from(a),
        })
    }

    proptest! {
        #[test]
        fn ends_are_met(start in state(), end in state(), t in 0.05..20.0f64) {
            let q = Quintic::between(&start, &end, t).unwrap();
            for (found, wanted) in [(q.at(0.0), start), (q.at(t), end)] {
                prop_assert!((found.position - wanted.position).norm() < 1e-9);
                prop_assert!((found.velocity - wanted.velocity).norm() < 1e-9 / t.min(1.0));
                prop_assert!((found.acceleration - wanted.acceleration).norm() < 1e-9 / t.min(1.0).powi(2));
            }
        }

        #[test]
        fn derivatives_are_those_of_the_position(start in state(), end in state(), share in 0.1..0.9f64) {
            let q = Quintic::between(&start, &end, 2.0).unwrap();
            let (t, h) = (2.0 * share, 1e-5);
            let (before, here, after) = (q.at(t - h), q.at(t), q.at(t + h));
            let velocity = (after.position - before.position) / (2.0 * h);
            let acceleration = (after.velocity - before.velocity) / (2.0 * h);
            prop_assert!((velocity - here.velocity).norm() < 1e-6);
            prop_assert!((acceleration - here.acceleration).norm() < 1e-6);
        }

        #[test]
        fn speed_stays_within_its_bound(start in state(), end in state(), a in 0.0..1.0f64, w in 0.01..1.0f64) {
            let q = Quintic::between(&start, &end, 1.5).unwrap();
            let (from, to) = (a, (a + w).min(1.5));
            let bound = q.speed_bound(from, to);
            for i in 0..=50 {
                let t = from + (to - from) * f64::from(i) / 50.0;
                prop_assert!(q.at(t).velocity.norm() <= bound + 1e-9);
            }
        }
    }

    #[test]
    fn rest_to_rest_is_the_minimum_jerk_curve() {
        let (a, b) = (Vector1::new(0.0), Vector1::new(1.0));
        let q = Quintic::between(&State::at_rest(a), &State::at_rest(b), 1.0).unwrap();
        let wanted = [0.0, 0.0, 0.0, 10.0, -15.0, 6.0];
        assert!(q.coefficients.iter().zip(wanted).all(|(c, w)| c.x == w));
        assert!((q.at(0.5).velocity.x - 1.875).abs() < 1e-15);
        assert!((q.largest_speed(64) - 1.875).abs() < 1e-2);
    }

    #[test]
    fn no_time_no_curve() {
        let rest = State::at_rest(Vector1::new(0.0));
        for t in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Quintic::between(&rest, &rest, t).is_none());
        }
        let wild = State::at_rest(Vector1::new(f64::NAN));
        assert!(Quintic::between(&rest, &wild, 1.0).is_none());
    }
}
