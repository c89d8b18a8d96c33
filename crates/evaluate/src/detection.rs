//! Detections measured against labels.

mod bootstrap;
mod curve;
mod dataset;
mod matching;
mod outcome;
mod ranked;
mod result;
mod results_of_others;
mod run;
mod sizes;

pub use curve::{BestF1, Curve, CurvePoint};
pub use dataset::{DetectionDataset, LabelForm, LabelledImage};
pub use matching::{Label, Outcome, match_detections};
pub use outcome::ImageOutcome;
pub use result::{
    AtThreshold, DETECTION_SCHEMA, DatasetRecord, DetectionDifference, DetectionEvaluation,
    DetectionResult, Estimate, SizeRecall, WorstImage,
};
pub use results_of_others::read_detections;
pub use run::{DetectionSettings, DetectionSource, evaluate_detections};
pub use sizes::{COCO_SIZES, FINE_SIZES, SizeClass};
