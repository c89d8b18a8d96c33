use crate::PixelWindow;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A box in a colour image, in pixels; `x_min <= x < x_max` and likewise y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PixelBox {
    /// Name of the boxed apple; a number as text where the file gives none.
    pub name: String,
    /// Left edge.
    pub x_min: f64,
    /// Top edge.
    pub y_min: f64,
    /// Right edge.
    pub x_max: f64,
    /// Bottom edge.
    pub y_max: f64,
    /// Detection score in 0..=1; 1 for a box drawn by a person.
    pub score: f64,
}

/// Why a box encloses nothing of an image.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BoxError {
    /// An edge or the score is NaN or infinite, or the score is outside 0..=1.
    #[error("box `{name}`: {field} is {value}; give finite edges in pixels and a score in 0..=1")]
    BadNumber {
        /// Name of the box.
        name: String,
        /// Which number.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// The right edge is not right of the left one, or the bottom not below the top.
    #[error(
        "box `{name}`: inverted or without area, from {minimum} to {maximum} along {axis}; give the smaller edge first"
    )]
    Inverted {
        /// Name of the box.
        name: String,
        /// `x` or `y`.
        axis: char,
        /// The edge that should be the smaller one.
        minimum: f64,
        /// The edge that should be the larger one.
        maximum: f64,
    },
    /// The box holds no pixel of the image.
    #[error(
        "box `{name}`: x {}..{}, y {}..{} holds no pixel of the {width}x{height} image; give the boxes of this image, in its pixels",
        .edges[0], .edges[2], .edges[1], .edges[3]
    )]
    Outside {
        /// Name of the box.
        name: String,
        /// Left, top, right and bottom edge.
        edges: [f64; 4],
        /// Width of the image.
        width: usize,
        /// Height of the image.
        height: usize,
    },
}

impl PixelBox {
    /// The pixels of a `width` × `height` image that lie in the box; what is outside the image
    /// is cut off.
    ///
    /// # Errors
    ///
    /// A [`BoxError`] where a number is not finite, the box is inverted, or it holds no
    /// pixel of the image.
    pub fn window(&self, width: usize, height: usize) -> Result<PixelWindow, BoxError> {
        self.check_numbers()?;
        let edges = [self.x_min, self.y_min, self.x_max, self.y_max];
        let [x_min, y_min, x_max, y_max] = edges;
        let window = PixelWindow::clamped(x_min, y_min, x_max, y_max, width, height);
        if window.is_empty() {
            return Err(self.outside(width, height));
        }
        Ok(window)
    }

    /// Checks that the box shares area with a `width` × `height` image, if less than a pixel's: a label may be a sliver
    /// at the edge.
    ///
    /// # Errors
    ///
    /// As [`PixelBox::window`], but for boxes between the pixels' centres.
    pub fn touches(&self, width: usize, height: usize) -> Result<(), BoxError> {
        self.check_numbers()?;
        let inside = self.x_max > 0.0
            && self.y_max > 0.0
            && self.x_min < width as f64
            && self.y_min < height as f64;
        if inside {
            return Ok(());
        }
        Err(self.outside(width, height))
    }

    fn outside(&self, width: usize, height: usize) -> BoxError {
        BoxError::Outside {
            name: self.name.clone(),
            edges: [self.x_min, self.y_min, self.x_max, self.y_max],
            width,
            height,
        }
    }

    /// Checks that numbers are finite, and the edges in order.
    fn check_numbers(&self) -> Result<(), BoxError> {
        let name = || self.name.clone();
        for (field, value) in [
            ("x_min", self.x_min),
            ("y_min", self.y_min),
            ("x_max", self.x_max),
            ("y_max", self.y_max),
            ("score", self.score),
        ] {
            if !value.is_finite() || (field == "score" && !(0.0..=1.0).contains(&value)) {
                return Err(BoxError::BadNumber {
                    name: name(),
                    field,
                    value,
                });
            }
        }
        for (axis, minimum, maximum) in
            [('x', self.x_min, self.x_max), ('y', self.y_min, self.y_max)]
        {
            if minimum >= maximum {
                return Err(BoxError::Inverted {
                    name: name(),
                    axis,
                    minimum,
                    maximum,
                });
            }
        }
        Ok(())
    }

    /// Checks that the box holds pixels of a `width` × `height` image.
    ///
    /// # Errors
    ///
    /// As [`PixelBox::window`].
    pub fn validate(&self, width: usize, height: usize) -> Result<(), BoxError> {
        self.window(width, height).map(|_| ())
    }

    /// Its centre.
    pub fn center(&self) -> (f64, f64) {
        (
            0.5 * (self.x_min + self.x_max),
            0.5 * (self.y_min + self.y_max),
        )
    }

    /// Width, in pixels.
    pub fn width(&self) -> f64 {
        self.x_max - self.x_min
    }

    /// Height, in pixels.
    pub fn height(&self) -> f64 {
        self.y_max - self.y_min
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxed(name: &str, x_min: f64, y_min: f64, x_max: f64, y_max: f64) -> PixelBox {
        PixelBox {
            name: name.to_owned(),
            x_min,
            y_min,
            x_max,
            y_max,
            score: 1.0,
        }
    }

    #[test]
    fn a_box_partly_outside_is_cut_off() {
        let window = boxed("a", -5.0, 2.5, 3.0, 99.0).window(10, 8).unwrap();
        assert_eq!(
            window,
            PixelWindow {
                x0: 0,
                y0: 3,
                x1: 3,
                y1: 8
            }
        );
    }

    #[test]
    fn a_sliver_at_the_edge_touches_the_image_and_holds_no_pixel() {
        let sliver = boxed("a", 3.0, 7.8, 9.0, 8.0);
        assert!(sliver.validate(10, 8).is_err() && sliver.touches(10, 8).is_ok());
        for (x_min, x_max) in [(-3.0, 0.0), (10.0, 12.0), (5.0, 4.0), (f64::NAN, 4.0)] {
            assert!(boxed("a", x_min, 1.0, x_max, 3.0).touches(10, 8).is_err());
        }
    }

    #[test]
    fn boxes_that_enclose_nothing_are_refused_by_name() {
        let refused = |b: PixelBox| b.validate(10, 8).unwrap_err();
        assert!(matches!(
            refused(boxed("a", 10.0, 0.0, 12.0, 5.0)),
            BoxError::Outside { .. }
        ));
        assert!(matches!(
            refused(boxed("a", 1.1, 0.0, 1.9, 5.0)),
            BoxError::Outside { .. }
        ));
        let inverted = refused(boxed("2118", 5.0, 0.0, 3.0, 5.0));
        assert!(matches!(inverted, BoxError::Inverted { axis: 'x', .. }));
        assert!(inverted.to_string().contains("`2118`"));
        let nan = refused(boxed("a", f64::NAN, 0.0, 3.0, 5.0));
        assert!(matches!(nan, BoxError::BadNumber { field: "x_min", .. }));
        let sure = PixelBox {
            score: 1.5,
            ..boxed("a", 1.0, 0.0, 3.0, 5.0)
        };
        assert!(matches!(
            refused(sure),
            BoxError::BadNumber { field: "score", .. }
        ));
    }
}
