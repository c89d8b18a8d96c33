use crate::Covariance;
use crate::triangle::{MAX_PARAMETERS, TRIANGLE, place};

/// The normal matrix `JᵀWJ` and the sum of squares of a model's residuals, added up row by row.
///
/// The engine makes one for the inliers of the final model, and
/// [`Estimator::linearize`](crate::Estimator::linearize) pushes their rows. It serves outside of the engine as well:
///
/// ```
/// use pomona_ransac::Linearization;
///
/// // The mean of four numbers: one parameter, on which every residual depends with slope −1.
/// let (numbers, mean) = ([1.0, 2.0, 4.0, 5.0], 3.0);
/// let mut rows = Linearization::new(1);
/// for number in numbers {
///     rows.push(number - mean, &[-1.0]);
/// }
/// // σ² = 10/3, and that of the mean is a quarter of it.
/// let sigma = rows.sigma().expect("more rows than parameters");
/// let covariance = rows.covariance(sigma).expect("a regular matrix");
/// assert!((covariance.get(0, 0).expect("in range") - 10.0 / 12.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    parameters: usize,
    rows: usize,
    weight: f64,
    squares: f64,
    /// Lower triangle of `JᵀWJ`.
    normal: [f64; TRIANGLE],
}

impl Linearization {
    /// No rows yet, of `parameters` columns.
    ///
    /// There is no covariance for 0 parameters, nor for more than [`MAX_PARAMETERS`].
    pub fn new(parameters: usize) -> Self {
        Self {
            parameters,
            rows: 0,
            weight: 1.0,
            squares: 0.0,
            normal: [0.0; TRIANGLE],
        }
    }

    /// Gives the rows pushed from here on this weight: the inverse of their variance, in units of
    /// the inverse of σ². Rows of weight 0 are left out and not counted.
    pub fn set_weight(&mut self, weight: f64) {
        self.weight = weight;
    }

    /// Adds a signed residual and its derivatives by the parameters.
    ///
    /// After a row of another length than the number of parameters, or one that is not
    /// finite, there is neither noise nor covariance.
    #[inline]
    pub fn push(&mut self, residual: f64, gradient: &[f64]) {
        if self.weight == 0.0 {
            return;
        }
        self.rows += 1;
        if gradient.len() != self.parameters || self.parameters > MAX_PARAMETERS {
            self.squares = f64::NAN;
            return;
        }
        self.squares += self.weight * residual * residual;
        let mut start = 0;
        for (row, &a) in gradient.iter().enumerate() {
            let weighted = self.weight * a;
            for (sum, &b) in self.normal[start..=start + row].iter_mut().zip(gradient) {
                *sum += weighted * b;
            }
            start += row + 1;
        }
    }

    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Standard deviation of a row of weight 1: σ² = Σ w r²/(rows − parameters).
    ///
    /// `None` where the rows are no more than the parameters, or not finite.
    pub fn sigma(&self) -> Option<f64> {
        let freedom = self.rows.checked_sub(self.parameters)?;
        if freedom == 0 {
            return None;
        }
        let sigma = (self.squares / freedom as f64).sqrt();
        sigma.is_finite().then_some(sigma)
    }

    /// The covariance σ² `(JᵀWJ)⁻¹` of the parameters of the least-squares model.
    ///
    /// `None` where the rows do not determine all parameters, or something is not finite.
    pub fn covariance(&self, sigma: f64) -> Option<Covariance> {
        let usable = (1..=MAX_PARAMETERS).contains(&self.parameters)
            && self.squares.is_finite()
            && (0.0..f64::INFINITY).contains(&sigma);
        if !usable {
            return None;
        }
        let factor = factorize(&self.normal, self.parameters)?;
        Covariance::new(self.parameters, &factor, sigma * sigma)
    }
}

/// The lower triangle L of A = L Lᵀ (Cholesky); `None` where A is singular to working precision.
///
/// A column's pivot is what its parameter's own sum of squares leaves once the parameters before it
/// are accounted for, and is compared with that sum: so the units of the parameters do not matter.
fn factorize(matrix: &[f64; TRIANGLE], size: usize) -> Option<[f64; TRIANGLE]> {
    // Squares of J: a relative error of 1e-16 in a pivot is one of 1e-8 in the parameter.
    const SINGULAR: f64 = 1e-13;
    let mut factor = [0.0; TRIANGLE];
    for row in 0..size {
        for column in 0..=row {
            let (of_row, of_column) = (place(row, 0), place(column, 0));
            let known: f64 = (0..column)
                .map(|k| factor[of_row + k] * factor[of_column + k])
                .sum();
            let left = matrix[of_row + column] - known;
            factor[of_row + column] = if column < row {
                left / factor[place(column, column)]
            } else if left > SINGULAR * matrix[of_row + row] && left.is_finite() {
                left.sqrt()
            } else {
                return None;
            };
        }
    }
    Some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_is_the_textbook_one() {
        let mut matrix = [0.0; TRIANGLE];
        // (4 12 −16; 12 37 −43; −16 −43 98) = L Lᵀ with L = (2; 6 1; −8 5 3).
        matrix[..6].copy_from_slice(&[4.0, 12.0, 37.0, -16.0, -43.0, 98.0]);
        let factor = factorize(&matrix, 3).unwrap();
        assert_eq!(factor[..6], [2.0, 6.0, 1.0, -8.0, 5.0, 3.0]);
    }

    #[test]
    fn units_do_not_make_a_matrix_singular_and_dependence_does() {
        let fill = |scale: f64, dependent: bool| {
            let mut rows = Linearization::new(2);
            for i in 0..10 {
                let x = f64::from(i);
                let other = if dependent { 3.0 * x } else { scale };
                rows.push(0.1, &[x, other]);
            }
            rows.covariance(1.0)
        };
        assert!(fill(1e-9, false).is_some() && fill(1e9, false).is_some());
        assert!(fill(1.0, true).is_none() && fill(0.0, false).is_none());
    }

    #[test]
    fn what_gives_no_covariance_says_so() {
        let mut rows = Linearization::new(2);
        rows.push(1.0, &[1.0, 0.0]);
        assert_eq!(rows.sigma(), None);
        rows.push(1.0, &[0.0, 1.0]);
        assert_eq!(rows.sigma(), None);
        rows.set_weight(0.0);
        rows.push(f64::NAN, &[]);
        rows.set_weight(0.5);
        rows.push(2.0, &[1.0, 1.0]);
        assert_eq!((rows.rows(), rows.sigma()), (3, Some(2.0)));
        assert!(rows.covariance(2.0).is_some());
        assert!(rows.covariance(f64::NAN).is_none() && rows.covariance(-1.0).is_none());
        rows.push(1.0, &[1.0]);
        assert!(rows.sigma().is_none() && rows.covariance(1.0).is_none());
        for size in [0, MAX_PARAMETERS + 1] {
            let mut rows = Linearization::new(size);
            (0..20).for_each(|_| rows.push(1.0, &vec![1.0; size]));
            assert!(rows.covariance(1.0).is_none());
        }
        let mut rows = Linearization::new(1);
        (0..3).for_each(|_| rows.push(1.0, &[f64::INFINITY]));
        assert!(rows.covariance(1.0).is_none());
    }
}
