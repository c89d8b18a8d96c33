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
