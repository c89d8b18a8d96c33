//! What is asked of one setting's value.

use crate::Range;
use std::fmt;

/// By how much the norm of a unit vector or quaternion may differ from 1: what is lost where only four digits are copied.
const UNIT_TOLERANCE: f64 = 1e-3;

/// What is asked of one setting's value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Rule {
    /// Nothing but its type.
    Any,
    /// The number, or each number of a list, is within a range.
    Numbers(Range),
    /// The numbers are a vector of norm 1, to within a thousandth.
    Unit,
    /// The numbers are a vector whose norm is within a range.
    Norm(Range),
}

/// Any value of the setting's type.
pub const fn any() -> Rule {
    Rule::Any
}

/// Numbers from `least` to `most`, both included.
pub const fn within(least: f64, most: f64) -> Rule {
    at_least(least).at_most(most)
}

/// Numbers from `least` on.
pub const fn at_least(least: f64) -> Rule {
    Rule::Numbers(Range {
        least,
        least_allowed: true,
        most: f64::INFINITY,
        most_allowed: false,
    })
}

/// Numbers greater than `least`.
pub const fn above(least: f64) -> Rule {
    Rule::Numbers(Range {
        least,
        least_allowed: false,
        most: f64::INFINITY,
        most_allowed: false,
    })
}

/// Numbers less than `most`.
pub const fn below(most: f64) -> Rule {
    Rule::Numbers(Range {
        least: f64::NEG_INFINITY,
        least_allowed: false,
        most,
        most_allowed: false,
    })
}

/// Vectors and quaternions of norm 1, to within a thousandth.
pub const fn unit() -> Rule {
    Rule::Unit
}

/// Vectors at most this long.
pub const fn norm_at_most(most: f64) -> Rule {
    Rule::Norm(Range {
        least: 0.0,
        least_allowed: true,
        most,
        most_allowed: true,
    })
}

impl Rule {
    /// The same, and at most `most`.
    #[must_use]
    pub const fn at_most(self, most: f64) -> Self {
        self.up_to(most, true)
    }

    /// The same, and less than `most`.
    #[must_use]
    pub const fn below(self, most: f64) -> Self {
        self.up_to(most, false)
    }

    const fn up_to(self, most: f64, most_allowed: bool) -> Self {
        match self {
            Self::Numbers(range) => Self::Numbers(Range {
                most,
                most_allowed,
                ..range
            }),
            Self::Norm(range) => Self::Norm(Range {
                most,
                most_allowed,
                ..range
            }),
            Self::Any | Self::Unit => self,
        }
    }

    /// The range of each number, where there is one.
    pub fn range(&self) -> Option<Range> {
        match self {
            Self::Numbers(range) => Some(*range),
            Self::Any | Self::Unit | Self::Norm(_) => None,
        }
    }

    /// Whether it allows these numbers.
    pub fn allows(&self, numbers: &[f64]) -> bool {
        let norm = || numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
        match self {
            Self::Any => numbers.iter().all(|x| x.is_finite()),
            Self::Numbers(range) => numbers.iter().all(|&x| range.contains(x)),
            Self::Unit => (norm() - 1.0).abs() <= UNIT_TOLERANCE,
            Self::Norm(range) => range.contains(norm()),
        }
    }
}

/// In words that follow 'it must be'.
impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Any => f.write_str("finite"),
            Self::Numbers(range) => range.fmt(f),
            Self::Unit => f.write_str("of norm 1; copy all digits"),
            Self::Norm(range) => write!(f, "of a norm {range}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_are_those_of_all_numbers_together() {
        assert!(unit().allows(&[0.6, 0.0, -0.8]));
        assert!(unit().allows(&[0.6, 0.0, 0.0, 0.8]));
        assert!(!unit().allows(&[1.0, 1.0]) && !unit().allows(&[f64::NAN, 1.0]));
        assert!(norm_at_most(2.0).allows(&[0.0, -2.0]) && !norm_at_most(2.0).allows(&[1.5, 1.5]));
        assert!(any().allows(&[]) && !any().allows(&[f64::INFINITY]));
        assert_eq!(norm_at_most(2.0).to_string(), "of a norm from 0 to 2");
    }
}
