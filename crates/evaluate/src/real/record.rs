use super::apple_wood::WoodSeen;
use pomona_statistics::Proportion;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Name and version of the form of [`RealReport`].
pub const REAL_SCHEMA: &str = "pomona.real-evaluation/1";

/// Methods measured on real frames against strokes of wood, as `pomona evaluate --real` writes them to real.json. Lengths
/// in metres, angles in radians, positions in the camera's frame; pixels from the image's upper left corner, the middle
/// of the first pixel at (0.5, 0.5). What is not known is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RealReport {
    /// Name and version of this form.
    pub schema: String,
    /// Seed of the methods.
    pub seed: u64,
    /// What tells methods the probability of wood: the name of a segmenter, or `masks`; absent where nothing does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wood: Option<String>,
    /// Where no table says which apples' wood is seen: the distance in radii from the middle of a box within which wood
    /// is drawn for those.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub apple_radii: Option<f64>,
    /// The frames, in the order in which they were given.
    pub frames: Vec<RealFrameSummary>,
    /// One entry for each method.
    pub results: Vec<RealResult>,
}

/// What a frame holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RealFrameSummary {
    /// Id of the frame.
    pub frame: String,
    /// Number of strokes of wood.
    pub wood_strokes: usize,
    /// Number of boxes whose wood is `seen`, `doubtful`, `none` and `unlisted`.
    pub boxes: BTreeMap<WoodSeen, usize>,
}

/// One method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RealResult {
    /// Name of the method.
    pub method: String,
    /// Over all frames.
    pub all: RealFigures,
    /// Over each frame.
    pub frames: Vec<RealFrameFigures>,
    /// Each box of each frame, in the order of the frames and their boxes.
    pub apples: Vec<RealRow>,
}

/// The figures of a method over one frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RealFrameFigures {
    /// Id of the frame.
    pub frame: String,
    /// Its figures.
    pub figures: RealFigures,
}

/// The figures of a method over one frame or several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RealFigures {
    /// Apples whose wood is seen.
    pub seen: SeenFigures,
    /// Apples without visible wood.
    pub none: UnseenFigures,
    /// Apples whose wood is doubtful.
    pub doubtful: UnseenFigures,
    /// Boxes of which nobody said whether wood is seen.
    pub unlisted: UnseenFigures,
    /// What the confidence says of the answers to apples whose wood is seen; absent where no answer states one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reliability: Option<RealReliability>,
}

/// The answers to apples whose wood is seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SeenFigures {
    /// Share of the apples that are answered.
    pub answered: Proportion,
    /// Share of the answers that point at the wood.
    pub right: Proportion,
    /// Share of the apples with an answer that points at the wood.
    pub hits: Proportion,
    /// Number of answers that point elsewhere.
    pub elsewhere: usize,
    /// Number of apples refused for each reason.
    pub refused: BTreeMap<String, usize>,
}

/// The answers to apples whose wood is not seen for certain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct UnseenFigures {
    /// Share of the apples that are refused.
    pub refused: Proportion,
    /// Share of the apples that are answered.
    pub answered: Proportion,
    /// Share of the apples that are answered with a confidence of at least 0.5; an answer without a confidence counts.
    pub confident: Proportion,
}

/// What the confidence says of answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RealReliability {
    /// Share that points at the wood, of the answers of each range of confidence.
    pub bins: Vec<ConfidenceShare>,
    /// The same of the answers with a confidence of at least 0.9.
    pub right_of_confident: Proportion,
    /// Mean confidence.
    pub mean_confidence: f64,
    /// Mean squared difference of confidence and outcome (Brier 1950); 0.25 for a confidence that is always 0.5.
    pub brier: f64,
}

/// A range of confidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ConfidenceShare {
    /// Lowest confidence.
    pub from: f64,
    /// Confidence below which it ends; the last range includes 1.
    pub to: f64,
    /// Share of its answers that point at the wood.
    pub right: Proportion,
}

/// What became of one box under one method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Verdict {
    /// The answer points at the wood.
    Right,
    /// The wood is seen, and the answer points elsewhere.
    Elsewhere,
    /// The wood is not seen for certain, and there is an answer: it is not judged.
    Answered,
    /// There is no answer.
    Refused,
}

impl Verdict {
    /// Its name in tables and files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Elsewhere => "elsewhere",
            Self::Answered => "answered",
            Self::Refused => "refused",
        }
    }
}

/// One box of one frame under one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RealRow {
    /// Id of the frame.
    pub frame: String,
    /// Name of the box.
    pub box_name: String,
    /// Radius of the box, half the mean of its sides, pixels.
    pub box_radius_px: f64,
    /// Whether a person sees the apple's wood.
    pub wood: WoodSeen,
    /// What became of it.
    pub verdict: Verdict,
    /// `picked` or the reason of the refusal.
    pub status: String,
    /// Probability that the direction is right, where the method states one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
    /// Angle in the image between the direction to the foot and that to the wood.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image_angle: Option<f64>,
    /// Distance of the wood from the apple's centre in the image, radii of the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wood_distance_radii: Option<f64>,
    /// Distance of the foot from the nearest point of the wood in the image, radii of the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot_from_wood_radii: Option<f64>,
    /// Number of strokes nearer than that wood that depth shows far in front of the apple or behind it.
    pub passed_over: usize,
    /// Distance of the fitted centre from the camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// Fitted radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Fitted centre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 3]>,
    /// Foot of the perpendicular from the centre on the branch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot: Option<[f64; 3]>,
    /// The centre in the image, pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center_px: Option<[f64; 2]>,
    /// The foot in the image, pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot_px: Option<[f64; 2]>,
    /// Points of the wood nearest to the centre, one of each stroke that is as near as the nearest one, pixels.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wood_px: Vec<[f64; 2]>,
}
