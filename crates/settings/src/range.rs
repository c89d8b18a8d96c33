use std::fmt;

/// An interval of numbers, each end of which belongs to it or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end; −∞ for none.
    pub least: f64,
    /// Whether the lower end is allowed.
    pub least_allowed: bool,
    /// Upper end; ∞ for none.
    pub most: f64,
    /// Whether the upper end is allowed.
    pub most_allowed: bool,
}

impl Range {
    /// Whether `x` lies within; never where it is not finite.
    pub fn contains(&self, x: f64) -> bool {
        let over = x > self.least || (self.least_allowed && x == self.least);
        let under = x < self.most || (self.most_allowed && x == self.most);
        x.is_finite() && over && under
    }

    /// The lower end, where there is one.
    pub fn lower(&self) -> Option<f64> {
        Some(self.least).filter(|x| x.is_finite())
    }

    /// The upper end, where there is one.
    pub fn upper(&self) -> Option<f64> {
        Some(self.most).filter(|x| x.is_finite())
    }
}

/// In words that follow 'it must be'.
impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let least = self.lower().map(number);
        let most = self.upper().map(number);
        let over = if self.least_allowed {
            "at least"
        } else {
            "over"
        };
        let under = if self.most_allowed {
            "at most"
        } else {
            "under"
        };
        match (least, most) {
            (Some(least), Some(most)) if self.least_allowed && self.most_allowed => {
                write!(f, "from {least} to {most}")
            }
            (Some(least), Some(most)) => write!(f, "{over} {least} and {under} {most}"),
            (Some(least), None) => write!(f, "{over} {least}"),
            (None, Some(most)) => write!(f, "{under} {most}"),
            (None, None) => f.write_str("a finite number"),
        }
    }
}

/// `x` without superfluous zeros; in powers of ten where there would be many.
fn number(x: f64) -> String {
    if x != 0.0 && x.abs() < 1e-3 {
        format!("{x:e}")
    } else {
        x.to_string()
    }
}

#[cfg(test)]
mod tests {
    use crate::rule::{above, at_least, below, within};

    #[test]
    fn ends_belong_to_it_or_not() {
        let half = above(0.0).at_most(1.0).range().unwrap();
        for (x, inside) in [
            (0.0, false),
            (1e-300, true),
            (1.0, true),
            (1.0 + 1e-15, false),
            (f64::NAN, false),
        ] {
            assert_eq!(half.contains(x), inside, "{x}");
        }
        assert!(!above(0.0).range().unwrap().contains(f64::INFINITY));
        assert!(within(-1.0, 1.0).range().unwrap().contains(-1.0));
    }

    #[test]
    fn it_says_what_it_allows() {
        for (rule, words) in [
            (above(0.0).at_most(1.0), "over 0 and at most 1"),
            (above(0.0).below(1.0), "over 0 and under 1"),
            (within(1.0, 1e7), "from 1 to 10000000"),
            (at_least(1e-12).at_most(0.1), "from 1e-12 to 0.1"),
            (at_least(4.0), "at least 4"),
            (below(0.25), "under 0.25"),
        ] {
            assert_eq!(rule.range().unwrap().to_string(), words);
        }
    }
}
