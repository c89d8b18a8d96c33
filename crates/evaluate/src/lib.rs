//! Methods run over scenes and frames with truth: errors, statistics, tables, plots.
//!
//! ```
//! use pomona::{Config, Method, Picker};
//! use pomona_evaluate::{Subject, evaluate};
//!
//! // The first two of the paper's fifteen lab orientations, generated in memory.
//! let subjects = Subject::named("lab15", Some(2))?;
//! let picker = Picker::new(Config { method: Method::Paper, ..Config::default() })?;
//!
//! let evaluation = evaluate(&subjects, &[&picker], 0, &|| {})?;
//!
//! let result = &evaluation.results[0];
//! assert_eq!((result.suite.as_str(), result.method.as_str()), ("lab15", "paper"));
//! let angle = result.angle.as_ref().unwrap();
//! println!("{:.1}° ± {:.1}°", angle.error.mean.to_degrees(), angle.error.sd.to_degrees());
//! # Ok::<(), pomona_evaluate::EvaluateError>(())
//! ```
//!
//! # Concepts
//!
//! - A [`Subject`] is one frame with truth: a case of a suite, or a folder.
//! - A [`PickMethod`] answers frames; [`pomona::Picker`] is one.
//! - [`evaluate`] runs every method over every subject on all cores and gives an
//!   [`Evaluation`]: an [`AppleRow`] for each apple, a [`SuiteResult`] for each suite and method, a
//!   [`Comparison`] for each pair of methods.
//! - **Accuracy** is measured against truth, **repeatability** against the mean of a method's own
//!   answers ([`Repeatability`], the paper's measure); they never share a name.
//! - **[`Reliability`]** asks whether a method's confidences and standard deviations hold.
//! - [`evaluate_with_robot`] also mounts a camera on a robot, calibrates it from noisy samples, and
//!   measures the gripper in the base's frame: a [`BaseRow`] for each answer, a [`BaseResult`] with the error budget.
//! - [`report_page`] and [`apples_csv`] are what `report.html` and `apples.csv` hold.
//! - [`measure_calipers`] sets fitted radii beside measured diameters on real frames, and
//!   aligns the apples of two frames of one tree.
//! - [`measure_depth_checks`] asks what depth is worth to a detector's boxes: right and wrong ones, split ones, missing ones.
//! - [`evaluate_detections`] measures detectors, and boxes of other programs, on the labels of a
//!   [`DetectionDataset`]: precision over recall ([`Curve`]), recall by size, what is missed and what is found
//!   besides, with intervals and paired differences.
//! - [`paper_figures`] holds every figure of the paper that ours is set beside.
//!
//! # Not here
//!
//! Picking (`pomona`), scenes and their truth (`pomona-scenes`), and the judgement whether a
//! result is good enough: limits and golden runs belong to `cargo xtask regress`.
//!
//! # References
//!
//! Gao, Zhou, Cao and Jiang 2022, "An Algorithm for Calculating Apple Picking Direction
//! Based on 3D Vision", Agriculture 12(8), 1170, doi 10.3390/agriculture12081170.

mod base;
mod calipers;
mod comparison;
mod depth_check;
mod detection;
mod error;
mod grouping;
mod lab;
mod matching;
mod method;
pub mod paper_figures;
mod reliability;
mod repeatability;
mod report;
mod result;
mod row;
mod run;
mod statistics;
mod subject;
mod table_file;

pub use base::{
    BaseResult, BaseRow, BudgetTerm, CalibrationNoise, Coverage, DirectionTerms, Mounting, Planned,
    PlannedRow, PositionTerms, RobotTrial, Term,
};
pub use calipers::{
    AlignedApple, Alignment, CALIPER_SCHEMA, Caliper, CaliperFrame, CaliperReport, CaliperResult,
    CaliperRow, measure_calipers, read_calipers,
};
pub use comparison::{Comparison, compare};
pub use depth_check::{
    DepthCheckResult, FixedDetector, MarkCounts, MergeCounts, SearchCounts, measure_boxed_frame,
    measure_depth_checks,
};
pub use detection::{
    AtThreshold, BestF1, COCO_SIZES, Curve, CurvePoint, DETECTION_SCHEMA, DatasetRecord,
    DetectionDataset, DetectionDifference, DetectionEvaluation, DetectionResult, DetectionSettings,
    DetectionSource, Estimate, FINE_SIZES, ImageOutcome, Label, LabelForm, LabelledImage, Outcome,
    SizeClass, SizeRecall, WorstImage, evaluate_detections, match_detections, read_detections,
};
pub use error::EvaluateError;
pub use grouping::{Difficulty, Group, Grouping};
pub use lab::LabRow;
pub use matching::{SAME_APPLE_IOU, match_answers};
pub use method::PickMethod;
pub use reliability::{ConfidenceBin, RIGHT_RAD, Reliability, RiskPoint, SdCalibration, UNSURE};
pub use repeatability::Repeatability;
pub use report::{caliper_page, detection_page, report_page};
pub use result::{AngleErrors, Evaluation, Refusals, SCHEMA, SuiteResult, Timing};
pub use row::{
    AppleRow, NO_BOX, VISIBLE_APPLE_SHARE, VISIBLE_BRANCH_LENGTH_M, VISIBLE_BRANCH_PIXELS,
};
pub use run::{evaluate, evaluate_with_robot};
pub use statistics::{Share, Spread, Summary};
pub use subject::Subject;
pub use table_file::apples_csv;
