//! Detections measured on labelled boxes.

mod curve;
mod figures;
mod matched_image;
mod matching;
mod other_programs;
mod page;
mod ranked;
mod result;
mod run;
mod sizes;

pub use curve::{BestF1, Curve, CurvePoint};
pub use matched_image::MatchedImage;
pub use matching::{DetectionMatch, GroundTruthBox, match_detections};
pub use other_programs::read_detections;
pub use page::detection_page;
pub use result::{
    AtThreshold, DETECTION_SCHEMA, DatasetSummary, DetectionDifference, DetectionEvaluation,
    DetectionResult, SizeRecall, WorstImage,
};
pub use run::{DetectionOptions, DetectionSource, evaluate_detections};
pub use sizes::{COCO_SIZES, FINE_SIZES, SizeClass};
