//! Lower triangles of small symmetric matrices, stored row by row.

/// How many parameters a model may have for its covariance to be computed.
pub const MAX_PARAMETERS: usize = 12;

/// Entries of the lower triangle of the largest matrix.
pub(crate) const TRIANGLE: usize = MAX_PARAMETERS * (MAX_PARAMETERS + 1) / 2;

/// Place of an entry of a lower triangle that is stored row by row; `column` is at most `row`.
pub(crate) fn place(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}
