use thiserror::Error;

/// Why a frame could not be worked on at all.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PickError {
    /// The frame has no boxes, and nothing here finds apples.
    #[error(
        "frame '{frame}' has no boxes: put boxes.xml (VOC), boxes.json (COCO) or boxes.txt (YOLO) \
         into its folder, or give --boxes FILE"
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
    /// A setting makes no sense.
    #[error(transparent)]
    Config(#[from] crate::ConfigError),
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
