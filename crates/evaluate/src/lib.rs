//! Methods measured on scenes and frames with ground truth: errors, statistics, tables, plots.
//!
//! ```
//! use pomona::{Config, Method, Picker};
//! use pomona_evaluate::{Subject, evaluate};
//!
//! // The first two of the paper's fifteen laboratory orientations, rendered in memory.
//! let subjects = Subject::named("lab15", Some(2))?;
//! let picker = Picker::new(Config::default().with(|c| c.method = Method::Paper))?;
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
//! - A [`Subject`] is one frame with ground truth: a case of a suite, or a folder.
//! - A [`PickMethod`] answers frames; [`pomona::Picker`] is one.
//! - [`evaluate`] runs every method on every subject on all cores and returns an
//!   [`Evaluation`]: an [`AppleRow`] for each apple, a [`SuiteResult`] for each suite and method, a
//!   [`Comparison`] for each pair of methods.
//! - **Accuracy** is measured against ground truth, **repeatability** against the mean of a method's own answers
//!   ([`Repeatability`], the paper's measure).
//! - **[`Reliability`]** tests whether a method's confidences and standard deviations are calibrated.
//! - [`evaluate_with_robot`] also mounts a camera on a robot, calibrates it from noisy samples, and
//!   measures the gripper in the base frame: a [`BaseRow`] for each answer, a [`BaseResult`] with the error budget.
//! - [`report_page`] and [`apples_csv`] are the content of `report.html` and `apples.csv`.
//! - [`measure_calipers`] compares fitted radii with measured diameters on real frames, and aligns the apples of two
//!   frames of one tree.
//! - [`measure_real`] compares directions on real frames with strokes of wood drawn by eye.
//!
//! # Not here
//!
//! Picking (`pomona`), scenes and their truth (`pomona-scenes`), detectors against labels (`pomona-labels`), and the
//! judgement whether a
//! result is good enough: limits and golden runs belong to `cargo xtask regress`.
//!
//! # References
//!
//! Gao, Zhou, Cao and Jiang 2022, "An Algorithm for Calculating Apple Picking Direction
//! Based on 3D Vision", Agriculture 12(8), 1170, doi 10.3390/agriculture12081170.

mod apple_row;
mod apples_csv;
mod calipers;
mod drawn_boxes;
mod error;
mod evaluation;
mod matching;
mod method;
mod paper_figures;
mod real;
mod report;
mod robot;
mod run;
mod subject;
mod suite;

pub use apple_row::{AppleRow, NO_BOX};
pub use apples_csv::apples_csv;
pub use calipers::{
    AlignedApple, Alignment, CALIPER_SCHEMA, Caliper, CaliperFrame, CaliperReport, CaliperResult,
    CaliperRow, measure_calipers, read_calipers,
};
pub use drawn_boxes::{boxes_about, boxes_on_nothing};
pub use error::EvaluateError;
pub use evaluation::{Evaluation, SCHEMA};
pub use method::PickMethod;
pub use real::{
    AppleWood, AppleWoodTable, ConfidenceShare, FrameAgreement, PerturbedAgreement, REAL_SCHEMA,
    RealAgreement, RealFigures, RealFrame, RealFrameFigures, RealFrameSummary, RealOptions,
    RealReliability, RealReport, RealResult, RealRow, SeenFigures, UnseenFigures, Verdict,
    WoodSeen, measure_real, read_real_frames, real_csv,
};
pub use report::{caliper_page, real_page, report_page};
pub use robot::{
    BaseRow, CalibrationNoise, DirectionTerms, PlannedRow, PositionTerms, RobotTrial, Term,
};
pub use run::{evaluate, evaluate_with_robot};
pub use subject::Subject;
pub use suite::{
    AngleErrors, BaseResult, BudgetTerm, Comparison, ConfidenceBin, Coverage, Difficulty, Group,
    Grouping, LabRow, Planned, Refusals, Reliability, Repeatability, RiskPoint, SdCalibration,
    SuiteResult, Timing,
};
