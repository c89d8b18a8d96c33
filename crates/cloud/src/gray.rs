/// An 8-bit image of one channel, rows from the top: a mask, or an index for each pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GrayImage {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` values, row by row.
    pub values: Vec<u8>,
}

impl GrayImage {
    /// The value at column `u` of row `v`; `None` outside the image.
    pub fn get(&self, u: usize, v: usize) -> Option<u8> {
        let index = (u < self.width && v < self.height).then(|| v * self.width + u)?;
        self.values.get(index).copied()
    }
}
