use std::fmt::Write;

/// What the numbers of a [`Port`] are stored as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Element {
    /// 32-bit floating point.
    F32,
    /// 16-bit floating point.
    F16,
    /// 8-bit unsigned.
    U8,
    /// 32-bit signed.
    I32,
    /// 64-bit signed.
    I64,
    /// Anything else.
    Other,
}

/// One input or output of a network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Its name in the model.
    pub name: String,
    /// Length of each axis; `None` for one that the model leaves open.
    pub shape: Vec<Option<usize>>,
    /// What its numbers are stored as.
    pub element: Element,
}

/// Numbers that a network takes or gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Tensor {
    /// Its name in the model.
    pub name: String,
    /// Length of each axis, slowest first.
    pub shape: Vec<usize>,
    /// The values, row-major, converted to `f32` whatever the model stores.
    pub data: Vec<f32>,
}

impl Port {
    /// Its shape as messages show it, with a question mark for an open axis: `[1, 3, ?, ?]`.
    pub fn shape_text(&self) -> String {
        let mut text = String::from("[");
        for (index, axis) in self.shape.iter().enumerate() {
            let comma = if index > 0 { ", " } else { "" };
            let _ = match axis {
                Some(length) => write!(text, "{comma}{length}"),
                None => write!(text, "{comma}?"),
            };
        }
        text.push(']');
        text
    }
}

/// How many numbers a tensor of this shape holds; `None` where it overflows.
pub(crate) fn element_count(shape: &[usize]) -> Option<usize> {
    shape
        .iter()
        .try_fold(1_usize, |count, &axis| count.checked_mul(axis))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_in_messages() {
        let text = |shape: &[Option<usize>]| {
            let port = Port {
                name: String::new(),
                shape: shape.to_vec(),
                element: Element::F32,
            };
            port.shape_text()
        };
        assert_eq!(text(&[Some(1), None, Some(3)]), "[1, ?, 3]");
        assert_eq!(text(&[]), "[]");
    }

    #[test]
    fn a_shape_that_nothing_can_hold_has_no_count() {
        assert_eq!(element_count(&[1, 3, 4]), Some(12));
        assert_eq!(element_count(&[]), Some(1));
        assert_eq!(element_count(&[2, usize::MAX]), None);
    }
}
