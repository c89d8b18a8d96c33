use crate::AppleMark;
use crate::canvas::{Canvas, Point};
use crate::layout::Rectangle;
use crate::palette;
use crate::text::{Font, shorten};

/// The longest text on a label, characters.
const LONGEST: usize = 48;

/// The label of one apple: its number on a coloured field, its text beside it.
pub(crate) struct Label {
    number: String,
    words: String,
    color: [u8; 3],
}

impl Label {
    /// The field is red as the arrow, or orange as the box of a refused apple;
    /// the words are cut to what `picture_width` can hold.
    pub(crate) fn new(mark: &AppleMark<'_>, font: Font, picture_width: usize) -> Self {
        let number = mark.number.to_string();
        let columns = picture_width / font.char_width().unsigned_abs() as usize;
        let words = shorten(
            &mark.words(),
            columns.saturating_sub(number.len() + 3).min(LONGEST),
        );
        let color = if mark.refused.is_some() {
            palette::REFUSED
        } else if mark.arrow.is_some() {
            palette::DIRECTION
        } else {
            palette::BOX
        };
        Self {
            number,
            words,
            color,
        }
    }

    fn padding(font: Font) -> i32 {
        font.line_height() / 5
    }

    fn field_width(&self, font: Font) -> i32 {
        font.width(&self.number) + 2 * Self::padding(font)
    }

    /// Width and height, pixels.
    pub(crate) fn size(&self, font: Font) -> (i32, i32) {
        let words = if self.words.is_empty() {
            0
        } else {
            font.width(&self.words) + 2 * Self::padding(font)
        };
        (self.field_width(font) + words, font.line_height() + 2)
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas, rectangle: Rectangle, font: Font) {
        let [x, y, width, height] = [
            rectangle.left,
            rectangle.top,
            rectangle.width,
            rectangle.height,
        ]
        .map(|v| v as f32);
        let radius = height / 5.0;
        canvas.rounded_rectangle([x, y, width, height], radius, palette::BACKGROUND, 0.85);
        let field = self.field_width(font);
        canvas.rounded_rectangle([x, y, field as f32, height], radius, self.color, 1.0);
        let left = rectangle.left + Self::padding(font);
        let text_color = if self.color == palette::REFUSED {
            palette::BACKGROUND
        } else {
            palette::TEXT
        };
        font.write(
            canvas,
            &self.number,
            left,
            rectangle.top + 1,
            true,
            text_color,
        );
        font.write(
            canvas,
            &self.words,
            left + field,
            rectangle.top + 1,
            false,
            palette::TEXT,
        );
    }

    /// A thin line from a label that had to move away back to the box it names.
    pub(crate) fn draw_leader(
        canvas: &mut Canvas,
        rectangle: Rectangle,
        anchor: Rectangle,
        font: Font,
        scale: f32,
    ) {
        if rectangle.gap(anchor) < font.line_height() as f32 {
            return;
        }
        let (x, anchor_x) = nearest(
            rectangle.left,
            rectangle.right(),
            anchor.left,
            anchor.right(),
        );
        let (y, anchor_y) = nearest(
            rectangle.top,
            rectangle.bottom(),
            anchor.top,
            anchor.bottom(),
        );
        let (from, to) = (Point::from_xy(x, y), Point::from_xy(anchor_x, anchor_y));
        canvas.line(from, to, palette::BACKGROUND, 0.7, 3.0 * scale);
        canvas.line(from, to, palette::TEXT, 0.9, 1.3 * scale);
    }
}

/// The nearest values of two intervals; the middle of what they share where they overlap.
fn nearest(a_min: i32, a_max: i32, b_min: i32, b_max: i32) -> (f32, f32) {
    if a_max < b_min {
        return (a_max as f32, b_min as f32);
    }
    if b_max < a_min {
        return (a_min as f32, b_max as f32);
    }
    let shared = f32::midpoint(a_min.max(b_min) as f32, a_max.min(b_max) as f32);
    (shared, shared)
}
