use super::alignment::Alignment;
use super::table::Caliper;
use crate::error::EvaluateError;
use crate::method::PickMethod;
use pomona::{AppleAnswer, CheckedFrame, FrameAnswer};
use pomona_cloud::Frame;
use pomona_statistics::Summary;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Name and version of the form of [`CaliperReport`].
pub const CALIPER_SCHEMA: &str = "pomona.calipers/1";

/// What `calipers.json` holds. Metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CaliperReport {
    /// [`CALIPER_SCHEMA`].
    pub schema: String,
    /// Seed of the methods.
    pub seed: u64,
    /// One entry for each method.
    pub results: Vec<CaliperResult>,
}

/// One method over all frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CaliperResult {
    /// Method.
    pub method: String,
    /// Fitted radius less half the measured diameter, over measured boxes with a sphere; its mean
    /// is the bias. Its interval draws whole apples, with the boxes of all frames.
    pub radius_error: Option<Summary>,
    /// The same without its sign.
    pub radius_error_absolute: Option<Summary>,
    /// Each frame.
    pub frames: Vec<CaliperFrame>,
    /// Each measured box, by name and then by frame.
    pub apples: Vec<CaliperRow>,
    /// Each pair of frames.
    pub alignments: Vec<Alignment>,
}

/// What became of one frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CaliperFrame {
    /// Its id.
    pub frame: String,
    /// Boxes.
    pub boxes: usize,
    /// Boxes of measured apples.
    pub measured: usize,
    /// How many boxes ended in which status.
    pub by_status: BTreeMap<String, usize>,
    /// Mean absolute radius error over its measured boxes with a sphere.
    pub radius_error_absolute: Option<f64>,
}

/// One box of a measured apple.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CaliperRow {
    /// Name of the box.
    pub box_name: String,
    /// The frame.
    pub frame: String,
    /// `picked` or the reason of refusal.
    pub status: String,
    /// Half the measured diameter.
    pub measured_radius: f64,
    /// Fitted radius; absent without a sphere.
    pub radius: Option<f64>,
    /// Fitted less measured.
    pub radius_error: Option<f64>,
    /// Distance of the fitted centre from the camera.
    pub distance: Option<f64>,
}

/// Sets the fitted radii of real frames beside measured ones, and aligns each pair of frames.
///
/// # Errors
///
/// [`EvaluateError::Pick`] for a frame that a method cannot work on.
pub fn measure_calipers(
    frames: &[Frame],
    calipers: &[Caliper],
    methods: &[&dyn PickMethod],
    seed: u64,
) -> Result<CaliperReport, EvaluateError> {
    let results = methods.iter().map(|method| {
        let answers: Vec<FrameAnswer> = frames
            .par_iter()
            .map(|frame| method.answer(&CheckedFrame::new(frame)?, seed))
            .collect::<Result<_, _>>()?;
        Ok(CaliperResult::of(method.name(), &answers, calipers))
    });
    Ok(CaliperReport {
        schema: CALIPER_SCHEMA.to_owned(),
        seed,
        results: results.collect::<Result<_, EvaluateError>>()?,
    })
}

impl CaliperResult {
    fn of(method: &str, answers: &[FrameAnswer], calipers: &[Caliper]) -> Self {
        let mut apples = Vec::new();
        let mut errors = Vec::new();
        for (number, caliper) in calipers.iter().enumerate() {
            for answer in answers {
                let own = answer
                    .apples
                    .iter()
                    .filter(|a| a.bounds.name == caliper.box_name);
                for apple in own {
                    let row = CaliperRow::of(&answer.id, caliper, apple);
                    errors.extend(row.radius_error.map(|error| (number, error)));
                    apples.push(row);
                }
            }
        }
        let absolute: Vec<_> = errors.iter().map(|&(n, e)| (n, e.abs())).collect();
        let pairs = answers
            .iter()
            .enumerate()
            .flat_map(|(i, a)| answers[i + 1..].iter().map(move |b| (a, b)));
        Self {
            method: method.to_owned(),
            radius_error: Summary::of(&errors),
            radius_error_absolute: Summary::of(&absolute),
            frames: answers
                .iter()
                .map(|answer| CaliperFrame::of(answer, &apples))
                .collect(),
            alignments: pairs.map(|(a, b)| Alignment::of(a, b)).collect(),
            apples,
        }
    }
}

impl CaliperFrame {
    fn of(answer: &FrameAnswer, apples: &[CaliperRow]) -> Self {
        let own: Vec<&CaliperRow> = apples.iter().filter(|row| row.frame == answer.id).collect();
        let errors: Vec<f64> = own
            .iter()
            .filter_map(|row| row.radius_error)
            .map(f64::abs)
            .collect();
        let mut by_status = BTreeMap::new();
        for apple in &answer.apples {
            *by_status.entry(apple.status.name().to_owned()).or_insert(0) += 1;
        }
        Self {
            frame: answer.id.clone(),
            boxes: answer.apples.len(),
            measured: own.len(),
            by_status,
            radius_error_absolute: (!errors.is_empty())
                .then(|| errors.iter().sum::<f64>() / errors.len() as f64),
        }
    }
}

impl CaliperRow {
    fn of(frame: &str, caliper: &Caliper, answer: &AppleAnswer) -> Self {
        let measured_radius = 0.5 * caliper.diameter;
        let apple = answer.apple;
        Self {
            box_name: caliper.box_name.clone(),
            frame: frame.to_owned(),
            status: answer.status.name().to_owned(),
            measured_radius,
            radius: apple.map(|a| a.radius_m),
            radius_error: apple.map(|a| a.radius_m - measured_radius),
            distance: apple.map(|a| a.center.point().coords.norm()),
        }
    }
}
