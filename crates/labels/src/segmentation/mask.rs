use crate::error::LabelsError;
use pomona_cloud::GrayImage;
use pomona_segment::UNSEEN;
use std::path::PathBuf;

/// The value of wood in a mask of wood alone.
const WOOD: u8 = 255;

/// A file that says which pixels of an image are wood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TruthMask {
    /// The file: a grey PNG of the image's size.
    pub path: PathBuf,
    /// What its values mean.
    pub values: MaskValues,
}

/// What the values of a mask mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MaskValues {
    /// 255 is wood, 0 is none.
    Wood,
    /// Numbers of classes; a pixel of 255, [`UNSEEN`](pomona_segment::UNSEEN), does not count.
    Classes {
        /// The number of wood.
        wood: u8,
    },
}

/// What a mask says.
pub(crate) struct MaskPixels {
    /// The pixels of wood.
    pub(crate) wood: Vec<bool>,
    /// The pixels about which it says nothing.
    pub(crate) unseen: Vec<bool>,
}

impl TruthMask {
    /// Reads it, for an image of `[width, height]` pixels.
    ///
    /// # Errors
    ///
    /// [`LabelsError::Cloud`], or [`LabelsError::Malformed`] for another size and for values without a meaning.
    pub(crate) fn read(&self, [width, height]: [usize; 2]) -> Result<MaskPixels, LabelsError> {
        let mask = GrayImage::read(&self.path)?;
        if [mask.width, mask.height] != [width, height] {
            let problem = format!(
                "{}x{} pixels for an image of {width}x{height}",
                mask.width, mask.height
            );
            let remedy = "give a mask of the image's own size";
            return Err(LabelsError::malformed(&self.path, &problem, remedy));
        }
        let (wood, unseen) = match self.values {
            MaskValues::Wood => (WOOD, None),
            MaskValues::Classes { wood } => (wood, Some(UNSEEN)),
        };
        let odd = |value: &u8| self.values == MaskValues::Wood && ![0, WOOD].contains(value);
        if let Some(k) = mask.values.iter().position(odd) {
            let problem = format!(
                "the value {} at ({}, {})",
                mask.values[k],
                k % width,
                k / width
            );
            let remedy = "a mask of what is true has 255 for wood and 0 for everything else";
            return Err(LabelsError::malformed(&self.path, &problem, remedy));
        }
        Ok(MaskPixels {
            wood: mask.values.iter().map(|value| *value == wood).collect(),
            unseen: mask.values.iter().map(|v| Some(*v) == unseen).collect(),
        })
    }
}
