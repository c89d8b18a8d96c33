use crate::{classes::Classes, error::SegmentError, segmentation::Segmentation};
use pomona_cloud::{ColorImage, PixelWindow};
use pomona_network::RuntimeReport;
use serde::Serialize;

/// Tells what each pixel of a colour image shows.
///
/// One segmenter serves many threads. The same image gives the same probabilities, and those of a pixel do not depend
/// on which other windows are asked for; on which other places they may.
pub trait Segmenter: Send + Sync {
    /// The classes that it tells apart.
    fn classes(&self) -> &Classes;

    /// The probabilities of the pixels in `windows`; more may be seen, and the others are [unseen](crate::UNSEEN).
    ///
    /// # Errors
    ///
    /// [`SegmentError`]; for a window that reaches beyond the image too.
    fn segment_windows(
        &self,
        image: &ColorImage,
        windows: &[PixelWindow],
    ) -> Result<Segmentation, SegmentError>;

    /// The same for places that are small and far apart, faster: they may be put beside each other for a network, which
    /// then sees less around each, so that their probabilities differ a little from those of the whole image.
    ///
    /// # Errors
    ///
    /// As [`Segmenter::segment_windows`].
    fn segment_places(
        &self,
        image: &ColorImage,
        places: &[PixelWindow],
    ) -> Result<Segmentation, SegmentError> {
        self.segment_windows(image, places)
    }

    /// Which segmenter this is, for the record.
    fn report(&self) -> SegmenterReport;

    /// The probabilities of all pixels.
    ///
    /// # Errors
    ///
    /// As [`Segmenter::segment_windows`].
    fn segment(&self, image: &ColorImage) -> Result<Segmentation, SegmentError> {
        self.segment_windows(image, &[PixelWindow::full(image.width, image.height)])
    }
}

/// Which segmenter ran, and how: part of the output, so that a result can be traced.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct SegmenterReport {
    /// Name of the segmenter or of the model's file.
    pub name: String,
    /// The inference backend; absent where none of ours ran.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runtime: Option<RuntimeReport>,
    /// What was assumed about the model, and how to state it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

impl SegmenterReport {
    /// The report of a segmenter of this name, without a backend of ours.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            runtime: None,
            notes: Vec::new(),
        }
    }
}
