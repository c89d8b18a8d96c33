//! Labelled images: data sets read, detectors measured on them, results reported.
//!
//! ```
//! use pomona_cloud::{LabelledBox, PixelBox};
//! use pomona_detect::Detection;
//! use pomona_labels::{
//!     DetectionOptions, DetectionSource, LabelForm, LabelledDataset, LabelledImage, evaluate_detections,
//! };
//!
//! let pixel_box = PixelBox { name: "1".into(), x_min: 0.0, y_min: 0.0, x_max: 10.0, y_max: 10.0, score: 1.0 };
//! let mut image = LabelledImage::new("a.png", "images/a.png", 640, 480);
//! image.boxes.push(LabelledBox::new(pixel_box));
//! let dataset = LabelledDataset::new("demo", LabelForm::LabelFolder, vec![image]);
//!
//! // The detections of another program in that image: the apple, and a false positive.
//! let seen = |x: f64, score| Detection { x_min: x, y_min: 0.0, x_max: x + 10.0, y_max: 10.0, score, class: 0 };
//! let source = DetectionSource::Boxes {
//!     name: "theirs".into(),
//!     detections: vec![vec![seen(1.0, 0.9), seen(50.0, 0.6)]],
//! };
//!
//! let options = DetectionOptions::new(0.5, 0);
//! let (evaluation, _) = evaluate_detections(&dataset, &[source], &options, &|| {})?;
//! let result = &evaluation.results[0];
//! assert_eq!(result.recall.unwrap().value, 1.0);
//! assert_eq!(result.at_threshold.false_positives, 1);
//! # Ok::<(), pomona_labels::LabelsError>(())
//! ```
//!
//! # Concepts
//!
//! - A [`LabelledDataset`] contains [`LabelledImage`]s. It is read from a folder in YOLO, VOC or COCO form, or from
//!   frames with boxes.
//! - A [`DetectionSource`] is a detector, or the boxes of another program ([`read_detections`]).
//! - [`match_detections`] matches detections with labels as COCO does; a [`MatchedImage`] holds the matches of an
//!   image.
//! - A [`Curve`] is precision over recall, with the areas under it.
//! - [`evaluate_detections`] gives a [`DetectionEvaluation`]: for each source its figures with intervals from resampled
//!   images, recall by size ([`SizeClass`]) and the worst images; for each pair of sources the paired differences.
//! - [`detection_page`] is the content of `report.html`.
//! - [`ImageStrokes`] are the centre lines of wood, peduncles and posts, drawn by eye in an image ([`read_strokes`]).
//!   [`evaluate_segmentation`] measures on them, or on masks ([`masked_images`]), what a segmenter calls wood: recall
//!   along the lines, precision of what is marked, calibration; [`judge_pixels`] says of each pixel what it was counted
//!   for; [`agreement`] compares two people's strokes.
//!
//! # Not here
//!
//! Running networks (`pomona-detect`, `pomona-segment`), reading a single file of boxes (`pomona-cloud`), pictures (`pomona-view`),
//! picking directions against truth (`pomona-evaluate`).
//!
//! # References
//!
//! Lin et al. 2014, "Microsoft COCO: Common Objects in Context", arXiv 1405.0312. Everingham et al. 2015, "The PASCAL
//! Visual Object Classes Challenge: A Retrospective", doi 10.1007/s11263-014-0733-5.

mod cells;
mod dataset;
mod detection;
mod error;
mod resampling;
mod segmentation;
mod strokes;

pub use dataset::{LabelForm, LabelledDataset, LabelledImage};
pub use detection::{
    AtThreshold, BestF1, COCO_SIZES, Curve, CurvePoint, DETECTION_SCHEMA, DatasetSummary,
    DetectionDifference, DetectionEvaluation, DetectionMatch, DetectionOptions, DetectionResult,
    DetectionSource, FINE_SIZES, GroundTruthBox, MatchedImage, SizeClass, SizeRecall, WorstImage,
    detection_page, evaluate_detections, match_detections, read_detections,
};
pub use error::LabelsError;
pub use resampling::Estimate;
pub use segmentation::{
    Agreement, CalibrationBin, LevelFigures, MaskReader, MaskValues, PixelVerdict,
    SEGMENTATION_SCHEMA, SegmentationDifference, SegmentationEvaluation, SegmentationImage,
    SegmentationOptions, SegmentationResult, SegmentationSource, SegmentationTruth, StrokeSummary,
    TruthKind, TruthMask, WidthClass, WidthRecall, WorstSegmentation, agreement,
    evaluate_segmentation, judge_pixels, masked_images, photograph, segmentation_images,
    segmentation_page,
};
pub use strokes::{
    ImageStrokes, PathSample, Stroke, StrokeClass, StrokePoint, parse_strokes, read_strokes,
};
