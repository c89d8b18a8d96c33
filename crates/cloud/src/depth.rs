/// A depth image registered to the colour image: z in units of [`crate::Camera::depth_scale`]; 0 is 'no reading'.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DepthImage {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` readings, row by row.
    pub readings: Vec<u16>,
}

impl DepthImage {
    /// An image without any reading.
    pub fn empty(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            readings: vec![0; width * height],
        }
    }

    /// The reading at column `u` of row `v`; `None` outside the image and where there is no reading.
    pub fn get(&self, u: usize, v: usize) -> Option<u16> {
        let index = (u < self.width && v < self.height).then(|| v * self.width + u)?;
        self.readings
            .get(index)
            .copied()
            .filter(|&reading| reading != 0)
    }

    /// How many pixels have a reading.
    pub fn reading_count(&self) -> usize {
        self.readings
            .iter()
            .filter(|&&reading| reading != 0)
            .count()
    }
}
