use crate::{
    classes::Classes,
    error::SegmentError,
    segmentation::Segmentation,
    segmenter::{Segmenter, SegmenterReport},
};
use pomona_cloud::{ColorImage, PixelWindow};

/// The mean of segmenters of the same classes, as of one network that looks at an image at several zooms: thin things
/// are seen enlarged, and what they belong to in the larger view.
pub(crate) struct Mean {
    first: Box<dyn Segmenter>,
    others: Vec<Box<dyn Segmenter>>,
}

impl Mean {
    pub(crate) fn new(first: Box<dyn Segmenter>, others: Vec<Box<dyn Segmenter>>) -> Self {
        Self { first, others }
    }
}

impl Segmenter for Mean {
    fn classes(&self) -> &Classes {
        self.first.classes()
    }

    fn segment_windows(
        &self,
        image: &ColorImage,
        windows: &[PixelWindow],
    ) -> Result<Segmentation, SegmentError> {
        let mut mean = self.first.segment_windows(image, windows)?;
        for (k, other) in self.others.iter().enumerate() {
            // Weighted so that all count the same in the end.
            let share = 1.0 / (k + 2) as f32;
            mean.mix(&other.segment_windows(image, windows)?, share);
        }
        Ok(mean.within(windows))
    }

    fn report(&self) -> SegmenterReport {
        self.first.report()
    }
}
