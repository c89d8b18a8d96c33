use super::curve::Curve;
use super::sizes::SizeClass;
use crate::dataset::LabelForm;
use crate::resampling::Estimate;
use pomona_detect::DetectorReport;
use pomona_statistics::Proportion;
use serde::Serialize;

/// Schema of [`DetectionEvaluation`]; a change of meaning changes its number.
pub const DETECTION_SCHEMA: &str = "pomona.detection-evaluation/1";

/// Detectors measured on the same labelled images, as `pomona evaluate --detection` writes them to detection.json.
///
/// Shares from 0 to 1, sizes in pixels. A detection that finds a label overlaps it by an intersection over union of at
/// least 0.5 unless said. What cannot be computed is absent, as recall is where there is no label.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct DetectionEvaluation {
    /// Name and version of this form.
    #[cfg_attr(test, schemars(extend("const" = DETECTION_SCHEMA)))]
    pub schema: &'static str,
    /// Version of this program.
    pub version: &'static str,
    /// The images and their labels.
    pub dataset: DatasetSummary,
    /// Seed of the bootstrap.
    pub seed: u64,
    /// Number of bootstrap resamples.
    pub resamples: usize,
    /// Score threshold at which recall, precision and false positives are counted.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub threshold: f64,
    /// One for each detector or box file, in the order given.
    pub results: Vec<DetectionResult>,
    /// Every pair of them.
    pub differences: Vec<DetectionDifference>,
}

/// The data set measured on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct DatasetSummary {
    /// Name of the folder or file.
    pub name: String,
    /// How its labels are stored.
    pub form: LabelForm,
    /// Number of images.
    pub images: usize,
    /// Images among them without a label that counts.
    pub background_images: usize,
    /// Those of them without a label file, which count as background as in YOLO.
    pub images_without_label_file: usize,
    /// Labels that have to be found.
    pub labels: usize,
    /// Labels that are ignored in matching: difficult ones and crowds.
    pub ignored_labels: usize,
}

/// The figures of one detector.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct DetectionResult {
    /// Its name in this evaluation.
    pub name: String,
    /// The detector; absent for boxes of another program.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::DetectorReport"))]
    pub detector: Option<DetectorReport>,
    /// Detections of any score.
    pub detections: usize,
    /// Average precision at an intersection over union of 0.5, all points: the main figure. Absent, like every figure
    /// that needs recall, where there is no label to find.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ap50: Option<Estimate>,
    /// Mean of the average precisions at intersections over union of 0.50 to 0.95, all points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ap50_95: Option<Estimate>,
    /// Best F1 at an intersection over union of 0.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub f1: Option<Estimate>,
    /// Recall at the threshold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recall: Option<Estimate>,
    /// Precision at the threshold; 0 where nothing was detected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precision: Option<Estimate>,
    /// Counts at the threshold, at an intersection over union of 0.5.
    pub at_threshold: AtThreshold,
    /// Recall by COCO's sizes, at an intersection over union of 0.5.
    pub by_size: Vec<SizeRecall>,
    /// Recall by finer sizes, at an intersection over union of 0.5.
    pub by_fine_size: Vec<SizeRecall>,
    /// The curve, and average precision by both rules.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curve: Option<Curve>,
    /// The images with most missed labels and false positives at the threshold, the worst first.
    pub worst: Vec<WorstImage>,
}

/// Counts of the detections of at least the threshold's score.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct AtThreshold {
    /// Labels found.
    pub found: usize,
    /// Labels missed.
    pub missed: usize,
    /// Detections that match no label.
    #[serde(rename = "further")]
    pub false_positives: usize,
    /// The same per image.
    #[serde(rename = "further_per_image")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub false_positives_per_image: f64,
    /// Mean intersection over union of the labels found and their detections; absent where none is found.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub mean_iou: Option<f64>,
}

/// Recall among labels of one size: the root of the label's area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct SizeRecall {
    /// The size.
    pub size: SizeClass,
    /// Share of its labels found at the threshold.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub at_threshold: Proportion,
    /// Share of its labels found by a detection of any score.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub at_any_score: Proportion,
}

/// One image on which a detector did badly.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct WorstImage {
    /// Its name in the data set.
    pub image: String,
    /// Labels found.
    pub found: usize,
    /// Labels missed.
    pub missed: usize,
    /// Detections that match no label.
    #[serde(rename = "further")]
    pub false_positives: usize,
}

/// The differences of two detectors' figures, paired: resampled over the same images.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct DetectionDifference {
    /// The detector that is subtracted.
    pub first: String,
    /// The detector it is subtracted from; it is better where a difference is positive.
    pub second: String,
    /// Of average precision at an intersection over union of 0.5, all points.
    pub ap50: Estimate,
    /// Of average precision at intersections over union of 0.50 to 0.95, all points.
    pub ap50_95: Estimate,
    /// Of the best F1.
    pub f1: Estimate,
    /// Of recall at the threshold.
    pub recall: Estimate,
    /// Of precision at the threshold.
    pub precision: Estimate,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        pomona_schema::assert_in_docs::<DetectionEvaluation>(
            DETECTION_SCHEMA,
            "detection-evaluation.schema.json",
        );
    }
}
