use crate::{Camera, ColorImage, DepthImage, PixelBox};

/// One RGB-D frame: colour, depth registered to it, camera, and boxes where they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Name of the frame; the folder's name where it was read from one.
    pub id: String,
    /// Camera of both images.
    pub camera: Camera,
    /// Colour image.
    pub color: ColorImage,
    /// Depth image, of the same size.
    pub depth: DepthImage,
    /// Boxes of apples; `None` where nobody looked for apples.
    pub boxes: Option<Vec<PixelBox>>,
}
