/// An 8-bit RGB image, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColorImage {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` pixels, row by row.
    pub pixels: Vec<[u8; 3]>,
}

impl ColorImage {
    /// An image of one colour.
    pub fn filled(width: usize, height: usize, color: [u8; 3]) -> Self {
        Self {
            width,
            height,
            pixels: vec![color; width * height],
        }
    }

    /// The pixel at column `u` of row `v`; `None` outside the image.
    pub fn get(&self, u: usize, v: usize) -> Option<[u8; 3]> {
        let index = (u < self.width && v < self.height).then(|| v * self.width + u)?;
        self.pixels.get(index).copied()
    }
}
