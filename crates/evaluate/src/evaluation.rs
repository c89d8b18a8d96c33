use crate::apple_row::AppleRow;
use crate::suite::{Comparison, SuiteResult};
use serde::{Deserialize, Serialize};

/// Name and version of the form of [`Evaluation`].
pub const SCHEMA: &str = "pomona.evaluation/1";

/// What `evaluation.json` holds. Metres, radians, and milliseconds where the name says so.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Evaluation {
    /// [`SCHEMA`].
    pub schema: String,
    /// Version of the program.
    pub version: String,
    /// Seed of the methods; each scene has its own.
    pub seed: u64,
    /// One entry for each suite and method.
    pub results: Vec<SuiteResult>,
    /// Methods in pairs on the same apples; empty where there is one method.
    pub comparisons: Vec<Comparison>,
    /// Every apple under every method.
    pub apples: Vec<AppleRow>,
}

impl Evaluation {
    /// The evaluation without timings: the rest is the same for the same input, seed and build.
    #[must_use]
    pub fn without_timing(mut self) -> Self {
        for row in &mut self.apples {
            row.timing_ms = None;
        }
        for result in &mut self.results {
            result.timing_ms = None;
        }
        self
    }
}
