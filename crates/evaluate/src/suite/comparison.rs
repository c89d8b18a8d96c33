use crate::apple_row::AppleRow;
use pomona_statistics::Summary;
use serde::{Deserialize, Serialize};

/// Two methods on the same apples, which takes the scenes' own difficulty out of the difference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Comparison {
    /// Suite.
    pub suite: String,
    /// One method.
    pub first: String,
    /// The other.
    pub second: String,
    /// Angle error of the second less that of the first, over apples that both answered; negative where the second is
    /// better.
    pub angle_difference: Option<Summary>,
    /// Centre error of the second less that of the first, over apples where both have a sphere.
    pub center_difference: Option<Summary>,
    /// Apples that only the first answered.
    pub only_first_answered: usize,
    /// Apples that only the second answered.
    pub only_second_answered: usize,
}

/// Every pair of methods, suite by suite.
pub(crate) fn compare(rows: &[AppleRow]) -> Vec<Comparison> {
    let mut blocks: Vec<Vec<&AppleRow>> = Vec::new();
    for block in rows.chunk_by(|a, b| a.suite == b.suite && a.method == b.method) {
        blocks.push(block.iter().filter(|row| row.target).collect());
    }
    let mut comparisons = Vec::new();
    for (i, first) in blocks.iter().enumerate() {
        for second in &blocks[i + 1..] {
            if let (Some(a), Some(b)) = (first.first(), second.first())
                && a.suite == b.suite
            {
                comparisons.push(Comparison::of(first, second));
            }
        }
    }
    comparisons
}

impl Comparison {
    /// Both blocks hold the same apples in the same order.
    fn of(first: &[&AppleRow], second: &[&AppleRow]) -> Self {
        let pairs = || first.iter().zip(second);
        let difference = |field: fn(&AppleRow) -> Option<f64>| {
            let values: Vec<_> = pairs()
                .filter_map(|(a, b)| Some((a.case_number, field(b)? - field(a)?)))
                .collect();
            Summary::of(&values)
        };
        let only = |a: bool, b: bool| {
            pairs()
                .filter(|(x, y)| x.is_answered() == a && y.is_answered() == b)
                .count()
        };
        Self {
            suite: first[0].suite.clone(),
            first: first[0].method.clone(),
            second: second[0].method.clone(),
            angle_difference: difference(|row| row.angle_error),
            center_difference: difference(|row| row.center_error),
            only_first_answered: only(true, false),
            only_second_answered: only(false, true),
        }
    }
}
