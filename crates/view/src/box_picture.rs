use crate::boxes::{outline, visible_part};
use crate::canvas::Canvas;
use crate::text::{Font, shorten};
use crate::{ViewError, palette};
use pomona_cloud::{ColorImage, PixelBox};

/// The class of a box, which decides its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BoxKind {
    /// A detection that has not been matched: blue.
    Detected,
    /// A true positive: green.
    TruePositive,
    /// A false positive: red.
    FalsePositive,
    /// A label that was missed: yellow.
    Missed,
}

impl BoxKind {
    fn color(self) -> [u8; 3] {
        match self {
            Self::Detected => palette::BOX,
            Self::TruePositive => palette::BRANCH,
            Self::FalsePositive => palette::DIRECTION,
            Self::Missed => palette::PATH,
        }
    }
}

/// A box to be drawn.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BoxMark {
    /// The box, pixels; the part inside the image is drawn.
    pub bounds: PixelBox,
    /// What it is of.
    pub kind: BoxKind,
    /// A short text above it, such as its score; none where it is empty.
    pub caption: String,
}

impl BoxMark {
    /// A box without a caption.
    pub fn new(bounds: PixelBox, kind: BoxKind) -> Self {
        Self {
            bounds,
            kind,
            caption: String::new(),
        }
    }

    /// This box with a caption.
    #[must_use]
    pub fn captioned(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }
}

/// The image with the boxes drawn over it, later ones over earlier ones.
///
/// A caption stands above its box, or below where there is no room; captions that would cover an earlier one are left
/// out. A box that cannot be shown is left out too. Widths follow the picture's height.
///
/// ```
/// use pomona_cloud::{ColorImage, PixelBox};
/// use pomona_view::{BoxKind, BoxMark, draw_boxes};
///
/// let image = ColorImage::filled(64, 48, [90, 120, 80]);
/// let bounds = PixelBox { name: "0".into(), x_min: 20.0, y_min: 24.0, x_max: 40.0, y_max: 44.0, score: 0.8 };
/// let mark = BoxMark::new(bounds, BoxKind::Detected).captioned("0.80");
///
/// assert_ne!(draw_boxes(&image, &[mark])?, image);
/// # Ok::<(), pomona_view::ViewError>(())
/// ```
///
/// # Errors
///
/// [`ViewError`] for an invalid image.
pub fn draw_boxes(image: &ColorImage, marks: &[BoxMark]) -> Result<ColorImage, ViewError> {
    let mut canvas = Canvas::new(image)?;
    let (width, height) = (image.width, image.height);
    let font = Font::for_height(height);
    let scale = (height as f32 / 1080.0).clamp(0.6, 4.0);
    let parts: Vec<_> = marks
        .iter()
        .map(|mark| visible_part(&mark.bounds, width, height))
        .collect();
    for (mark, part) in marks.iter().zip(&parts) {
        if let Some(part) = part {
            outline(&mut canvas, *part, mark.kind.color(), scale);
        }
    }
    let mut rectangles: Vec<[i32; 4]> = Vec::new();
    for (mark, part) in marks.iter().zip(&parts) {
        let Some([left, top, _, bottom]) = *part else {
            continue;
        };
        let text = shorten(&mark.caption, 24);
        let size = (font.width(&text) + 4, font.line_height());
        let x = (left as i32).min(width as i32 - size.0).max(0);
        let above = top as i32 - size.1 - 1;
        let y = if above >= 0 { above } else { bottom as i32 + 1 };
        let rectangle = [x, y, x + size.0, y + size.1];
        let is_free = rectangles.iter().all(|other| !overlap(rectangle, *other));
        if !text.is_empty() && is_free && rectangle[3] <= height as i32 {
            let edges = [x, y, size.0, size.1].map(|v| v as f32);
            canvas.rounded_rectangle(edges, 2.0, palette::BACKGROUND, 0.8);
            font.write(&mut canvas, &text, x + 2, y, false, palette::TEXT);
            rectangles.push(rectangle);
        }
    }
    Ok(canvas.into_image())
}

fn overlap(a: [i32; 4], b: [i32; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(x: f64, kind: BoxKind, caption: &str) -> BoxMark {
        BoxMark {
            bounds: PixelBox {
                name: String::new(),
                x_min: x,
                y_min: 40.0,
                x_max: x + 20.0,
                y_max: 60.0,
                score: 1.0,
            },
            kind,
            caption: caption.to_owned(),
        }
    }

    #[test]
    fn each_kind_has_its_colour() {
        let image = ColorImage::filled(100, 100, [0; 3]);
        for (kind, color) in [
            (BoxKind::Detected, palette::BOX),
            (BoxKind::TruePositive, palette::BRANCH),
            (BoxKind::FalsePositive, palette::DIRECTION),
            (BoxKind::Missed, palette::PATH),
        ] {
            let drawn = draw_boxes(&image, &[mark(30.0, kind, "")]).unwrap();
            let near = |pixel: &[u8; 3]| pixel.iter().zip(color).all(|(a, b)| a.abs_diff(b) < 60);
            assert!(drawn.pixels.iter().any(near), "{kind:?}");
        }
    }

    #[test]
    fn a_caption_is_written_once_where_two_would_cover_each_other() {
        let image = ColorImage::filled(100, 100, [0; 3]);
        let bare = draw_boxes(&image, &[mark(30.0, BoxKind::TruePositive, "")]).unwrap();
        let one = draw_boxes(&image, &[mark(30.0, BoxKind::TruePositive, "0.91")]).unwrap();
        assert_ne!(bare, one);
        let twice = [
            mark(30.0, BoxKind::TruePositive, "0.91"),
            mark(30.0, BoxKind::TruePositive, "0.91"),
        ];
        let boxes_twice = [
            mark(30.0, BoxKind::TruePositive, ""),
            mark(30.0, BoxKind::TruePositive, "0.91"),
        ];
        assert_eq!(draw_boxes(&image, &twice), draw_boxes(&image, &boxes_twice));
    }

    #[test]
    fn boxes_that_cannot_be_shown_are_left_out() {
        let image = ColorImage::filled(100, 100, [0; 3]);
        let marks = [
            mark(f64::NAN, BoxKind::FalsePositive, "a"),
            mark(500.0, BoxKind::FalsePositive, "b"),
        ];
        assert_eq!(draw_boxes(&image, &marks).unwrap(), image);
        assert!(draw_boxes(&ColorImage::filled(0, 0, [0; 3]), &[]).is_err());
    }
}
