//! One-to-one pairs of two sets.

/// For each row the column that is nearest to it and to which it is the nearest row in turn, within the gate.
pub(crate) fn mutually_nearest(
    rows: usize,
    columns: usize,
    gate: f64,
    distance: impl Fn(usize, usize) -> f64,
) -> Vec<Option<usize>> {
    let mut of_row: Vec<(f64, Option<usize>)> = vec![(f64::INFINITY, None); rows];
    let mut of_column = vec![(f64::INFINITY, None); columns];
    for (r, row) in of_row.iter_mut().enumerate() {
        for (c, column) in of_column.iter_mut().enumerate() {
            let d = distance(r, c);
            // Written so that NaN is outside the gate.
            if !(d <= gate) {
                continue;
            }
            if d < row.0 {
                *row = (d, Some(c));
            }
            if d < column.0 {
                *column = (d, Some(r));
            }
        }
    }
    let mutual = |(r, (_, c)): (usize, &(f64, Option<usize>))| {
        c.filter(|&c: &usize| of_column[c].1 == Some(r))
    };
    of_row.iter().enumerate().map(mutual).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_pairs_that_both_prefer_within_the_gate() {
        let distances = [[1.0, 4.0, 9.0], [0.5, 2.0, 9.0], [f64::NAN, 8.0, 7.0]];
        let pairs = |gate| mutually_nearest(3, 3, gate, |r, c| distances[r][c]);
        assert_eq!(pairs(10.0), [None, Some(0), Some(2)]);
        assert_eq!(pairs(5.0), [None, Some(0), None]);
        assert_eq!(pairs(0.1), [None, None, None]);
    }
}
