use super::images::SegmentationImage;
use super::run::{SegmentationOptions, marking_threshold};
use super::truth::Truth;
use crate::error::LabelsError;

/// What a pixel of a segmented image is, measured on what is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PixelVerdict {
    /// Marked, and within the tolerance of wood.
    Right,
    /// Marked, and further away.
    Wrong,
    /// Wood that is not marked.
    Missed,
    /// Neither marked nor wood, or near far wood.
    Rest,
    /// Outside of what has been drawn in: it does not count.
    Outside,
}

/// Judges each pixel of an image of `[width, height]` pixels by the probabilities of wood, row by row, as
/// [`evaluate_segmentation`](crate::evaluate_segmentation) counts them.
///
/// # Errors
///
/// [`LabelsError`] for a truth that cannot be read or does not fit the image, and for more or fewer probabilities than
/// pixels.
pub fn judge_pixels(
    image: &SegmentationImage,
    size: [usize; 2],
    probabilities: &[f32],
    options: &SegmentationOptions,
) -> Result<Vec<PixelVerdict>, LabelsError> {
    let truth = Truth::of(image, size, options.tolerance_px, options.apple_radii)?;
    if probabilities.len() != truth.wood.len() {
        let problem = format!(
            "{}x{} pixels, and there are {} probabilities",
            size[0],
            size[1],
            probabilities.len()
        );
        let remedy = "give one for each pixel of the image";
        return Err(LabelsError::malformed(&image.path, &problem, remedy));
    }
    let threshold = marking_threshold(options);
    let verdict = |(k, p): (usize, &f32)| {
        let is_marked = f64::from(*p) >= threshold;
        match (truth.outside[k], truth.ignored[k]) {
            (true, _) => PixelVerdict::Outside,
            (_, true) => PixelVerdict::Rest,
            _ if is_marked && truth.near[k] => PixelVerdict::Right,
            _ if is_marked => PixelVerdict::Wrong,
            _ if truth.wood[k] => PixelVerdict::Missed,
            _ => PixelVerdict::Rest,
        }
    };
    Ok(probabilities.iter().enumerate().map(verdict).collect())
}
