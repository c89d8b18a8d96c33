use crate::canvas::Canvas;
use crate::text::{Font, shorten};
use crate::{BoxMark, ViewError, draw_boxes, palette};
use pomona_cloud::ColorImage;

/// Pixels between two pictures.
const GAP: usize = 8;

/// One picture of a sheet.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ContactSheetImage {
    /// The image.
    pub image: ColorImage,
    /// Boxes drawn over it, in its pixels.
    pub marks: Vec<BoxMark>,
    /// The text below it.
    pub caption: String,
}

impl ContactSheetImage {
    /// An image with boxes over it and a text below it.
    pub fn new(image: ColorImage, marks: Vec<BoxMark>, caption: impl Into<String>) -> Self {
        Self {
            image,
            marks,
            caption: caption.into(),
        }
    }
}

/// Pictures side by side, `columns` in a row, each scaled to fit a square of `side` pixels.
///
/// Boxes and captions are drawn after the scaling, so that they stay legible.
///
/// # Errors
///
/// [`ViewError`] for an invalid image, and for a sheet without pictures, columns or side.
pub fn contact_sheet(
    pictures: &[ContactSheetImage],
    columns: usize,
    side: usize,
) -> Result<ColorImage, ViewError> {
    let columns = columns.min(pictures.len());
    if columns == 0 || side == 0 {
        return Err(ViewError::Size {
            width: columns * side,
            height: side,
        });
    }
    let font = Font::for_height(side);
    let line = font.line_height() as usize + 4;
    let rows = pictures.len().div_ceil(columns);
    let mut sheet = ColorImage::filled(
        columns * (side + GAP) + GAP,
        rows * (side + line + GAP) + GAP,
        palette::BACKGROUND,
    );
    let corner = |index: usize| {
        let (column, row) = (index % columns, index / columns);
        (GAP + column * (side + GAP), GAP + row * (side + line + GAP))
    };
    for (index, picture) in pictures.iter().enumerate() {
        let (left, top) = corner(index);
        let drawn = scaled_with_marks(picture, side)?;
        for (row, pixels) in drawn.pixels.chunks_exact(drawn.width).enumerate() {
            let start = (top + row) * sheet.width + left;
            sheet.pixels[start..start + drawn.width].copy_from_slice(pixels);
        }
    }
    let mut canvas = Canvas::new(&sheet)?;
    for (index, picture) in pictures.iter().enumerate() {
        let (left, top) = corner(index);
        let text = shorten(&picture.caption, side / font.char_width() as usize);
        let y = (top + side + 2) as i32;
        font.write(&mut canvas, &text, left as i32, y, false, palette::TEXT);
    }
    Ok(canvas.into_image())
}

fn scaled_with_marks(picture: &ContactSheetImage, side: usize) -> Result<ColorImage, ViewError> {
    let (width, height) = (picture.image.width, picture.image.height);
    if width == 0 || height == 0 || picture.image.pixels.len() != width * height {
        return Err(ViewError::PixelCount {
            width,
            height,
            pixels: picture.image.pixels.len(),
        });
    }
    let scale = side as f64 / width.max(height) as f64;
    let fit = |length: usize| ((length as f64 * scale).round() as usize).clamp(1, side);
    let scaled = scaled(&picture.image, fit(width), fit(height));
    let (x_scale, y_scale) = (
        scaled.width as f64 / width as f64,
        scaled.height as f64 / height as f64,
    );
    let marks: Vec<BoxMark> = picture
        .marks
        .iter()
        .cloned()
        .map(|mut mark| {
            mark.bounds.x_min *= x_scale;
            mark.bounds.x_max *= x_scale;
            mark.bounds.y_min *= y_scale;
            mark.bounds.y_max *= y_scale;
            mark
        })
        .collect();
    draw_boxes(&scaled, &marks)
}

/// Each pixel is the mean of those that it covers, or the nearest one where it covers none whole.
fn scaled(image: &ColorImage, width: usize, height: usize) -> ColorImage {
    let span = |at: usize, to: usize, from: usize| {
        let start = at * from / to;
        (start, ((at + 1) * from / to).max(start + 1))
    };
    let mut pixels = Vec::with_capacity(width * height);
    for y in 0..height {
        let (top, bottom) = span(y, height, image.height);
        for x in 0..width {
            let (left, right) = span(x, width, image.width);
            let mut sum = [0_usize; 3];
            for row in top..bottom {
                for pixel in &image.pixels[row * image.width + left..row * image.width + right] {
                    for (channel, value) in sum.iter_mut().zip(pixel) {
                        *channel += usize::from(*value);
                    }
                }
            }
            let count = (bottom - top) * (right - left);
            pixels.push(sum.map(|channel| (channel / count) as u8));
        }
    }
    ColorImage {
        width,
        height,
        pixels,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, height: usize, color: [u8; 3]) -> ContactSheetImage {
        ContactSheetImage {
            image: ColorImage::filled(width, height, color),
            marks: Vec::new(),
            caption: "a.png".to_owned(),
        }
    }

    #[test]
    fn pictures_keep_their_shape_and_colour_at_any_size() {
        let pictures = [
            picture(200, 100, [200, 0, 0]),
            picture(20, 40, [0, 200, 0]),
            picture(1, 1, [0, 0, 200]),
        ];
        let sheet = contact_sheet(&pictures, 2, 80).unwrap();
        assert_eq!(sheet.width, 2 * 80 + 3 * GAP);
        let count = |color: [u8; 3]| sheet.pixels.iter().filter(|p| **p == color).count();
        assert_eq!(count([200, 0, 0]), 80 * 40);
        assert_eq!(count([0, 200, 0]), 40 * 80);
        assert_eq!(count([0, 0, 200]), 80 * 80);
    }

    #[test]
    fn scaling_down_takes_the_mean() {
        let mut image = ColorImage::filled(4, 2, [0; 3]);
        image.pixels[0] = [100, 0, 4];
        assert_eq!(scaled(&image, 2, 1).pixels, [[25, 0, 1], [0; 3]]);
    }

    #[test]
    fn what_is_no_sheet_is_refused() {
        assert!(contact_sheet(&[], 3, 80).is_err());
        assert!(contact_sheet(&[picture(4, 4, [0; 3])], 0, 80).is_err());
        assert!(contact_sheet(&[picture(4, 4, [0; 3])], 3, 0).is_err());
        assert!(contact_sheet(&[picture(0, 4, [0; 3])], 3, 80).is_err());
    }
}
