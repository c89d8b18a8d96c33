use super::agreement::Agreement;
use super::counts::WidthClass;
use crate::resampling::Estimate;
use pomona_segment::SegmenterReport;
use serde::Serialize;

/// Schema of [`SegmentationEvaluation`]; a change of meaning changes its number.
pub const SEGMENTATION_SCHEMA: &str = "pomona.segmentation-evaluation/1";

/// Masks of wood measured on the same images, as `pomona evaluate --segmentation` writes them to segmentation.json.
///
/// Shares from 0 to 1, lengths and widths in pixels. What cannot be computed is absent.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct SegmentationEvaluation {
    /// Name and version of this form.
    #[cfg_attr(test, schemars(extend("const" = SEGMENTATION_SCHEMA)))]
    pub schema: &'static str,
    /// Version of this program.
    pub version: &'static str,
    /// The images, and the strokes or masks that are the truth.
    pub strokes: StrokeSummary,
    /// Distance in pixels within which wood is found and a mark is right.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub tolerance_px: f64,
    /// Probability from which on a pixel is marked.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub threshold: f64,
    /// Seed of the bootstrap.
    pub seed: u64,
    /// Number of bootstrap resamples.
    pub resamples: usize,
    /// How well a second person's strokes agree with these, centre line against centre line. Absent where there are
    /// none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agreement: Option<Agreement>,
    /// One for each segmenter or folder of masks, in the order given.
    pub results: Vec<SegmentationResult>,
    /// Every pair of them.
    pub differences: Vec<SegmentationDifference>,
}

/// The strokes or masks measured on.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct StrokeSummary {
    /// Name of the file, or of the folder of masks.
    pub name: String,
    /// Which of the two they are.
    pub truth: TruthKind,
    /// Number of images.
    pub images: usize,
    /// Number of photographs that they are cut from; intervals are over these.
    pub photographs: usize,
    /// Number of strokes of wood; 0 for masks.
    pub wood: usize,
    /// Length in pixels of the centre lines of wood.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub wood_length_px: f64,
    /// Length in pixels of posts and the like.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub post_length_px: f64,
}

/// What is taken for true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum TruthKind {
    /// Strokes drawn by eye.
    Strokes,
    /// Masks; their centre lines are found by thinning.
    Masks,
}

/// The figures of one segmenter at the threshold, with intervals.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct SegmentationResult {
    /// Its name in this evaluation.
    pub name: String,
    /// The segmenter; absent for masks of another program.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::SegmenterReport"))]
    pub segmenter: Option<SegmenterReport>,
    /// Of the length of centre lines at least 4 pixels wide, the share near a marked pixel. Absent, like every figure,
    /// where it does not exist on the images.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recall_wide: Option<Estimate>,
    /// The same of wood of 3 to 4 pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recall_thin: Option<Estimate>,
    /// Of the marked pixels, the share near wood.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precision: Option<Estimate>,
    /// Intersection over union of marked pixels and the strokes' bands, or the true masks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iou: Option<Estimate>,
    /// Of the length of posts and wires, the share that is marked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub posts: Option<Estimate>,
    /// Recall by width.
    pub by_width: Vec<WidthRecall>,
    /// The same figures at each threshold.
    pub curve: Vec<LevelFigures>,
    /// How often what is called wood with some probability is wood.
    pub calibration: Vec<CalibrationBin>,
    /// Mean difference of probability and share over those bins, by their pixels.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub calibration_error: f64,
    /// The images with the most length missed and marked falsely, the worst first.
    pub worst: Vec<WorstSegmentation>,
}

/// Recall among wood of one width.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct WidthRecall {
    /// The width.
    pub width: WidthClass,
    /// Length of its centre lines, pixels.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub length_px: f64,
    /// Share of it near a marked pixel; 0 where there is none.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub recall: f64,
}

/// Figures at one threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct LevelFigures {
    /// The threshold.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub threshold: f64,
    /// Recall of wood at least 4 pixels wide.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub recall_wide: f64,
    /// Recall of wood of 3 to 4 pixels.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub recall_thin: f64,
    /// Precision; 1 where nothing is marked.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub precision: f64,
    /// Share of the length of posts that is marked.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub posts: f64,
}

/// Pixels of one range of probability.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct CalibrationBin {
    /// Their number.
    pub pixels: u64,
    /// Their mean probability of wood.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub probability: f64,
    /// The share of them that is wood.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub share: f64,
}

/// One image on which a segmenter did badly.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct WorstSegmentation {
    /// Its name.
    pub image: String,
    /// Length of wood missed, pixels.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub missed_px: f64,
    /// Pixels marked far from wood.
    pub false_pixels: u64,
}

/// The differences of two segmenters' figures, paired: resampled over the same photographs.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct SegmentationDifference {
    /// The one that is subtracted.
    pub first: String,
    /// The one it is subtracted from; it is better where a difference is positive.
    pub second: String,
    /// Of the recall of wood at least 4 pixels wide.
    pub recall_wide: Estimate,
    /// Of the precision.
    pub precision: Estimate,
    /// Of the intersection over union.
    pub iou: Estimate,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        pomona_schema::assert_in_docs::<SegmentationEvaluation>(
            SEGMENTATION_SCHEMA,
            "segmentation-evaluation.schema.json",
        );
    }
}
