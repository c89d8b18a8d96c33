use thiserror::Error;

/// Why a frame could not be worked on at all.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PickError {
    /// The frame has no boxes, and no detector was asked for any.
    #[error(
        "frame '{frame}' has no boxes: put boxes.xml (VOC), boxes.json (COCO) or boxes.txt (YOLO) \
         into its folder, give --boxes FILE, or let a detector find them"
    )]
    NoBoxes {
        /// The frame's id.
        frame: String,
    },
    /// The images, the camera or the boxes contradict each other.
    #[error("frame '{frame}': {source}")]
    Frame {
        /// The frame's id.
        frame: String,
        /// What is wrong with it.
        source: Box<pomona_cloud::CloudError>,
    },
    /// The mask of wood has another size than the frame's images.
    #[error(
        "frame '{frame}': the mask of wood has {} x {} pixels, the images have {} x {}: \
         give a mask of this frame's colour image at its full size",
        found.0, found.1, expected.0, expected.1
    )]
    WoodSize {
        /// The frame's id.
        frame: String,
        /// Width and height of the mask, pixels.
        found: (usize, usize),
        /// Width and height of the images, pixels.
        expected: (usize, usize),
    },
    /// The detector failed.
    #[error("frame '{frame}': {source}")]
    Detect {
        /// The frame's id.
        frame: String,
        /// What it said.
        source: Box<pomona_detect::DetectError>,
    },
    /// A setting makes no sense.
    #[error(transparent)]
    Config(#[from] pomona_settings::ConfigError),
    /// The transform starts in another frame than the camera's.
    #[error(
        "frame '{frame}' was taken in '{camera}', but the transform starts in '{from}': \
         give the transform of this camera, or correct one of the names"
    )]
    WrongTransform {
        /// The frame's id.
        frame: String,
        /// The camera's frame.
        camera: String,
        /// Where the transform starts.
        from: String,
    },
}
