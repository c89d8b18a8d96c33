//! Pixels measured on strokes.

mod agreement;
mod counts;
mod images;
mod page;
mod result;
mod run;
mod truth;

pub use agreement::{Agreement, agreement};
pub use counts::WidthClass;
pub use images::{SegmentationImage, photograph, segmentation_images};
pub use page::segmentation_page;
pub use result::{
    CalibrationBin, LevelFigures, SEGMENTATION_SCHEMA, SegmentationDifference,
    SegmentationEvaluation, SegmentationResult, StrokeSummary, WidthRecall, WorstSegmentation,
};
pub use run::{MaskReader, SegmentationOptions, SegmentationSource, evaluate_segmentation};
