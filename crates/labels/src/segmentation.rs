//! Pixels measured on strokes and masks.

mod agreement;
mod counts;
mod distance;
mod images;
mod mask;
mod page;
mod result;
mod run;
mod skeleton;
mod truth;
mod verdict;

pub use agreement::{Agreement, agreement};
pub use counts::WidthClass;
pub use images::{
    SegmentationImage, SegmentationTruth, masked_images, photograph, segmentation_images,
};
pub use mask::{MaskValues, TruthMask};
pub use page::segmentation_page;
pub use result::{
    CalibrationBin, LevelFigures, SEGMENTATION_SCHEMA, SegmentationDifference,
    SegmentationEvaluation, SegmentationResult, StrokeSummary, TruthKind, WidthRecall,
    WorstSegmentation,
};
pub use run::{MaskReader, SegmentationOptions, SegmentationSource, evaluate_segmentation};
pub use verdict::{PixelVerdict, judge_pixels};
