use crate::canvas::Canvas;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// A fixed-width font at one of the heights that the glyphs come in, or at a
/// multiple of the largest for pictures of many megapixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Font {
    raster: RasterHeight,
    multiple: i32,
}

impl Font {
    /// The font for a picture of this height: 20 px on 1080 rows, never under 16.
    pub(crate) fn for_height(rows: usize) -> Self {
        let wanted = rows / 54;
        let raster = match wanted {
            ..=19 => RasterHeight::Size16,
            20..=23 => RasterHeight::Size20,
            24..=31 => RasterHeight::Size24,
            _ => RasterHeight::Size32,
        };
        Self {
            raster,
            multiple: (wanted / 32).clamp(1, 64) as i32,
        }
    }

    /// Height of a line, pixels.
    pub(crate) fn line_height(self) -> i32 {
        self.raster.val() as i32 * self.multiple
    }

    /// Width of every character, pixels.
    pub(crate) fn char_width(self) -> i32 {
        get_raster_width(FontWeight::Regular, self.raster) as i32 * self.multiple
    }

    /// Width of a text, pixels.
    pub(crate) fn width(self, text: &str) -> i32 {
        (text.chars().count() as i32).saturating_mul(self.char_width())
    }

    /// Writes `text` with its top-left corner at (x, y); a character the font lacks becomes `?`.
    pub(crate) fn write(
        self,
        canvas: &mut Canvas,
        text: &str,
        x: i32,
        y: i32,
        bold: bool,
        color: [u8; 3],
    ) {
        let weight = if bold {
            FontWeight::Bold
        } else {
            FontWeight::Regular
        };
        for (position, c) in text.chars().enumerate() {
            let left = x + position as i32 * self.char_width();
            let glyph =
                get_raster(c, weight, self.raster).or_else(|| get_raster('?', weight, self.raster));
            let Some(glyph) = glyph else { continue };
            for (row, line) in glyph.raster().iter().enumerate() {
                for (column, coverage) in line
                    .iter()
                    .enumerate()
                    .filter(|(_, coverage)| **coverage > 0)
                {
                    let (x, y) = (
                        left + column as i32 * self.multiple,
                        y + row as i32 * self.multiple,
                    );
                    self.block(canvas, x, y, color, f32::from(*coverage) / 255.0);
                }
            }
        }
    }

    fn block(self, canvas: &mut Canvas, x: i32, y: i32, color: [u8; 3], alpha: f32) {
        for dy in 0..self.multiple {
            for dx in 0..self.multiple {
                canvas.blend(x + dx, y + dy, color, alpha);
            }
        }
    }
}

/// At most `limit` characters of `text`, with `..` at the end where some are
/// missing; line breaks and tabs become spaces.
pub(crate) fn shorten(text: &str, limit: usize) -> String {
    let flat = |c: char| if c.is_control() { ' ' } else { c };
    if text.chars().count() <= limit {
        return text.chars().map(flat).collect();
    }
    let kept: String = text
        .chars()
        .take(limit.saturating_sub(2))
        .map(flat)
        .collect();
    if limit < 2 { kept } else { kept + ".." }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_cloud::ColorImage;

    #[test]
    fn grows_with_the_picture() {
        let heights = [48, 480, 1080, 1440, 2160, 4320].map(|h| Font::for_height(h).line_height());
        assert_eq!(heights, [16, 16, 20, 24, 32, 64]);
    }

    #[test]
    fn writes_ink_where_it_says() {
        let blank = ColorImage {
            width: 60,
            height: 40,
            pixels: vec![[0; 3]; 2400],
        };
        let mut canvas = Canvas::new(&blank).unwrap();
        let font = Font::for_height(40);
        font.write(&mut canvas, "8ü🍎", 10, 5, true, [255; 3]);
        let right = 10 + font.width("8ü🍎");
        let image = canvas.into_image();
        let coverage: Vec<usize> = (0..2400).filter(|i| image.pixels[*i] != [0; 3]).collect();
        assert!(coverage.len() > 50);
        assert!(
            coverage
                .iter()
                .all(|i| (10..right).contains(&((i % 60) as i32)) && (5..21).contains(&(i / 60)))
        );
    }

    #[test]
    fn long_texts_are_cut() {
        assert_eq!(shorten("no_branch", 20), "no_branch");
        assert_eq!(shorten("no\nbranch", 7), "no br..");
        assert_eq!(shorten("no", 1), "");
        assert_eq!(shorten("", 0), "");
    }
}
