/// Whether a frame's images are as the lens gave them, or rectified.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageKind {
    /// As the camera took them: the camera matrix K holds, and the lens bends.
    Raw,
    /// Rectified, as `image_rect` of ROS: the projection matrix P holds, and nothing bends.
    Rectified,
}

/// What is known about a camera beside its file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CameraOptions {
    /// How long a unit of the depth image is, in place of what the file says: metres per unit, or, above 1, units per
    /// metre.
    pub depth_scale: Option<f64>,
    /// Which images the camera is for, where its file describes both.
    pub images: Option<ImageKind>,
    /// Width and height of the images, pixels. It tells whether binning and a region of interest have been applied to
    /// the file's numbers already.
    pub image_size: Option<[usize; 2]>,
}
