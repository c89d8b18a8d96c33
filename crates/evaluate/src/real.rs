//! Real frames without ground truth: directions against strokes of wood drawn by eye.

mod agreement;
mod apple_wood;
mod brightness;
mod figures;
mod frame;
mod measure;
mod perturbation;
mod record;
mod table;
mod verdict;
mod wood_near;

pub use apple_wood::{AppleWood, AppleWoodTable, WoodSeen};
pub use frame::{RealFrame, read_real_frames};
pub use measure::{RealOptions, measure_real};
pub use record::{
    ConfidenceShare, FrameAgreement, PerturbedAgreement, REAL_SCHEMA, RealAgreement, RealFigures,
    RealFrameFigures, RealFrameSummary, RealReliability, RealReport, RealResult, RealRow,
    SeenFigures, UnseenFigures, Verdict,
};
pub use table::real_csv;
