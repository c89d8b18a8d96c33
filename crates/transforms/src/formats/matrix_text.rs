//! A homogeneous matrix as text: what `numpy.savetxt` and `print` write.

use super::checked::checked;
use super::error::FormatError;
use crate::{FrameTag, NamedTransform, Transform};
use nalgebra::Matrix4;

const REMEDY: &str = "give pomona's JSON, a calibration file of easy_handeye, an echoed TransformStamped, the arguments of static_transform_publisher, URDF's <origin>, an OpenCV matrix, or the sixteen numbers of a 4x4 matrix row by row";

/// The transform of twelve or sixteen numbers, row by row, in metres; brackets, commas and semicolons between them, and
/// lines that begin with `#`, count for nothing. `to` and `from` name its frames.
///
/// # Errors
///
/// [`FormatError`] for other words, for another count of numbers, and for what is no rigid transform.
pub fn from_matrix_text<To: FrameTag, From: FrameTag>(
    text: &str,
    to: &str,
    from: &str,
) -> Result<NamedTransform<To, From>, FormatError> {
    let mut numbers = Vec::new();
    for (line, place) in text.lines().zip(1..) {
        if line.trim_start().starts_with('#') {
            continue;
        }
        let separators = |c: char| c.is_whitespace() || "[](){},;".contains(c);
        for word in line.split(separators).filter(|word| !word.is_empty()) {
            let number = word.parse::<f64>().ok().filter(|n| n.is_finite());
            let number = number.ok_or_else(|| {
                let problem = format!("`{word}` belongs to no form of a transform");
                FormatError::new(format!("line {place}"), problem, REMEDY)
            })?;
            numbers.push(number);
        }
    }
    if ![12, 16].contains(&numbers.len()) {
        let problem = format!("{} numbers, where a matrix has 12 or 16", numbers.len());
        return Err(FormatError::new("text", problem, REMEDY));
    }
    let last = |column: usize| if column == 3 { 1.0 } else { 0.0 };
    let matrix = Matrix4::from_fn(|row, column| {
        numbers
            .get(4 * row + column)
            .copied()
            .unwrap_or_else(|| last(column))
    });
    checked(Transform::from_matrix(&matrix)?, to, from, REMEDY)
}
