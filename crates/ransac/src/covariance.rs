use crate::triangle::{MAX_PARAMETERS, TRIANGLE, place};

/// How far a model's parameters may be off: their covariance matrix.
///
/// The parameters are those of [`Estimator::linearize`](crate::Estimator::linearize), in its order and units. It is kept
/// as the Cholesky factor L of `JᵀWJ` = L Lᵀ and the variance σ², so that neither the matrix nor
/// its inverse loses digits to the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    size: usize,
    factor: [f64; TRIANGLE],
    variance: f64,
}

impl Covariance {
    /// `None` where an entry of the matrix overflows.
    pub(crate) fn new(size: usize, factor: &[f64; TRIANGLE], variance: f64) -> Option<Self> {
        let covariance = Self {
            size,
            factor: *factor,
            variance,
        };
        let finite = (0..size)
            .filter_map(|i| covariance.get(i, i))
            .all(f64::is_finite);
        finite.then_some(covariance)
    }

    /// How many parameters there are.
    pub fn size(&self) -> usize {
        self.size
    }

    /// An entry of the matrix; `None` outside of it.
    pub fn get(&self, row: usize, column: usize) -> Option<f64> {
        let unit = |index: usize| {
            let mut e = [0.0; MAX_PARAMETERS];
            e[index] = 1.0;
            self.descend(e)
        };
        (row < self.size && column < self.size)
            .then(|| self.variance * dot(&unit(row), &unit(column)))
    }

    /// Standard deviation of a parameter; `None` where there is no such.
    pub fn standard_deviation(&self, parameter: usize) -> Option<f64> {
        self.get(parameter, parameter).map(f64::sqrt)
    }

    /// Variance of a quantity with these derivatives by the parameters, gᵀ C g; `None` where there
    /// are not as many as parameters.
    pub fn variance_of(&self, gradient: &[f64]) -> Option<f64> {
        let g = self.descend(self.padded(gradient)?);
        Some(self.variance * dot(&g, &g))
    }

    /// Squared distance dᵀ C⁻¹ d of a deviation from the model, in standard deviations; `None` where it
    /// has not as many entries as there are parameters.
    ///
    /// A true deviation has a χ² distribution with [`size`](Self::size) degrees of freedom, as far as
    /// the noise is Gaussian and the data many. Without any noise it is 0 or infinite.
    pub fn mahalanobis_squared(&self, deviation: &[f64]) -> Option<f64> {
        let d = self.padded(deviation)?;
        let squared: f64 = (0..self.size)
            .map(|column| {
                let along: f64 = (column..self.size)
                    .map(|row| self.factor[place(row, column)] * d[row])
                    .sum();
                along * along
            })
            .sum();
        Some(if squared == 0.0 {
            0.0
        } else {
            squared / self.variance
        })
    }

    /// The covariance of standard deviations `factor` times as large; a factor that is
    /// not finite changes nothing.
    ///
    /// For noise that is known better than the residuals tell it, or neighbouring data that err alike.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        if factor.is_finite() {
            self.variance *= factor * factor;
        }
        self
    }

    fn padded(&self, values: &[f64]) -> Option<[f64; MAX_PARAMETERS]> {
        let mut padded = [0.0; MAX_PARAMETERS];
        padded.get_mut(..self.size)?.copy_from_slice(
            values
                .get(..self.size)
                .filter(|_| values.len() == self.size)?,
        );
        Some(padded)
    }

    /// L⁻¹ v.
    fn descend(&self, mut v: [f64; MAX_PARAMETERS]) -> [f64; MAX_PARAMETERS] {
        for row in 0..self.size {
            let known: f64 = (0..row).map(|k| self.factor[place(row, k)] * v[k]).sum();
            v[row] = (v[row] - known) / self.factor[place(row, row)];
        }
        v
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use crate::Linearization;

    #[test]
    fn a_lines_covariance_is_the_textbook_one() {
        // y = a + b x at x = 0, 1, 2, 3 and σ = 2: Var a = σ² Σx²/(n Sxx), Var b = σ²/Sxx,
        // Cov = −σ² x̄/Sxx, with Sxx = 5.
        let mut rows = Linearization::new(2);
        (0..4).for_each(|i| rows.push(0.0, &[1.0, f64::from(i)]));
        let c = rows.covariance(2.0).unwrap();
        let close = |value: Option<f64>, expected: f64| {
            assert!((value.unwrap() - expected).abs() < 1e-12, "{value:?}");
        };
        close(c.get(0, 0), 4.0 * 14.0 / 20.0);
        close(c.get(1, 1), 4.0 / 5.0);
        close(c.get(0, 1), -4.0 * 1.5 / 5.0);
        close(c.get(1, 0), -4.0 * 1.5 / 5.0);
        close(c.standard_deviation(1), (4.0_f64 / 5.0).sqrt());
        // The line's height at x = 1.5: the mean of four.
        close(c.variance_of(&[1.0, 1.5]), 1.0);
        // JᵀJ = (4 6; 6 14).
        close(
            c.mahalanobis_squared(&[1.0, -1.0]),
            (4.0 - 12.0 + 14.0) / 4.0,
        );
        close(c.clone().scaled(3.0).get(1, 1), 9.0 * 4.0 / 5.0);
        assert_eq!(c.clone().scaled(f64::NAN), c);
        assert_eq!((c.size(), c.get(2, 0), c.get(0, 2)), (2, None, None));
        assert_eq!(
            (c.variance_of(&[1.0]), c.mahalanobis_squared(&[1.0; 3])),
            (None, None)
        );
    }

    #[test]
    fn without_noise_nothing_deviates() {
        let mut rows = Linearization::new(1);
        (0..3).for_each(|_| rows.push(0.0, &[1.0]));
        let c = rows.covariance(rows.sigma().unwrap()).unwrap();
        assert_eq!(c.get(0, 0), Some(0.0));
        assert_eq!(c.mahalanobis_squared(&[0.0]), Some(0.0));
        assert_eq!(c.mahalanobis_squared(&[0.1]), Some(f64::INFINITY));
    }
}
