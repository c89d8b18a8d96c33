use super::curve::Curve;
use super::dataset::LabelForm;
use super::sizes::SizeClass;
use crate::Share;
use pomona_detect::DetectorReport;
use serde::Serialize;

/// Schema of [`DetectionEvaluation`]; a change of meaning changes its number.
pub const DETECTION_SCHEMA: &str = "pomona.detection-evaluation/1";

/// What `detection.json` holds: detectors measured on the same labelled images.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DetectionEvaluation {
    /// [`DETECTION_SCHEMA`].
    pub schema: &'static str,
    /// Version of this program.
    pub version: &'static str,
    /// The images and their labels.
    pub dataset: DatasetRecord,
    /// Seed of the bootstrap.
    pub seed: u64,
    /// How often the images were drawn anew.
    pub resamples: usize,
    /// Score at which recall, precision and further detections are counted.
    pub threshold: f64,
    /// One for each detector or box file, in the order given.
    pub results: Vec<DetectionResult>,
    /// Every pair of them.
    pub differences: Vec<DetectionDifference>,
}

/// What was measured on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DatasetRecord {
    /// Name of the folder or file.
    pub name: String,
    /// How its labels are kept.
    pub form: LabelForm,
    /// Images.
    pub images: usize,
    /// Images among them without a label that counts.
    pub background_images: usize,
    /// Images among those without a label file at all, which YOLO's convention takes for background.
    pub images_without_label_file: usize,
    /// Labels that have to be found.
    pub labels: usize,
    /// Labels that neither count nor punish: difficult ones and crowds.
    pub ignored_labels: usize,
}

/// How one detector did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DetectionResult {
    /// Its name in this evaluation.
    pub name: String,
    /// What detected; absent for boxes of another program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub detector: Option<DetectorReport>,
    /// Detections of any score.
    pub detections: usize,
    /// Average precision at an overlap of 0.5, all points: the main figure. Absent, as all that recall is needed for,
    /// where there is no label to find.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ap50: Option<Estimate>,
    /// Mean of the average precisions at the overlaps 0.50 to 0.95, all points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ap50_95: Option<Estimate>,
    /// Best F1 at an overlap of 0.5.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub f1: Option<Estimate>,
    /// Recall at the threshold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recall: Option<Estimate>,
    /// Precision at the threshold; 0 where nothing was detected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precision: Option<Estimate>,
    /// Counts at the threshold, overlap 0.5.
    pub at_threshold: AtThreshold,
    /// Recall by COCO's sizes, overlap 0.5.
    pub by_size: Vec<SizeRecall>,
    /// Recall by finer sizes, overlap 0.5.
    pub by_fine_size: Vec<SizeRecall>,
    /// The curve, and average precision by both rules.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curve: Option<Curve>,
    /// The images with most missed labels and further detections at the threshold, the worst first.
    pub worst: Vec<WorstImage>,
}

/// A figure with its 95 % interval: percentile bootstrap over images.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The figure.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// What the detections of a threshold's score and better ones come to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtThreshold {
    /// Labels found.
    pub found: usize,
    /// Labels missed.
    pub missed: usize,
    /// Detections that find nothing.
    pub further: usize,
    /// The same in the mean of an image.
    pub further_per_image: f64,
    /// Mean intersection over union of the labels found and their detections; absent where none is found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_iou: Option<f64>,
}

/// Recall among labels of one size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SizeRecall {
    /// The size.
    pub size: SizeClass,
    /// Share of its labels found at the threshold.
    pub at_threshold: Share,
    /// Share of its labels found by a detection of any score.
    pub at_any_score: Share,
}

/// One image on which a detector did badly.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct WorstImage {
    /// Its name in the data set.
    pub image: String,
    /// Labels found.
    pub found: usize,
    /// Labels missed.
    pub missed: usize,
    /// Detections that find nothing.
    pub further: usize,
}

/// The figures of one detector less those of another, drawn over the same images.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DetectionDifference {
    /// One.
    pub first: String,
    /// The other; a positive difference says that it is better.
    pub second: String,
    /// Of average precision at an overlap of 0.5, all points.
    pub ap50: Estimate,
    /// Of average precision over the overlaps 0.50 to 0.95, all points.
    pub ap50_95: Estimate,
    /// Of the best F1.
    pub f1: Estimate,
    /// Of recall at the threshold.
    pub recall: Estimate,
    /// Of precision at the threshold.
    pub precision: Estimate,
}
