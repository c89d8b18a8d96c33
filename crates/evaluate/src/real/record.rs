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
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct RealReport {
    /// Name and version of this form.
    #[cfg_attr(test, schemars(extend("const" = REAL_SCHEMA)))]
    pub schema: String,
    /// Seed of the methods and of the copies.
    pub seed: u64,
    /// What tells methods the probability of wood: the name of a segmenter, or `masks`; absent where nothing does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wood: Option<String>,
    /// Where no table says which apples' wood is seen: the distance in radii from the middle of a box within which wood
    /// is drawn for those.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub apple_radii: Option<f64>,
    /// The frames, in the order in which they were given.
    pub frames: Vec<RealFrameSummary>,
    /// One entry for each method.
    pub results: Vec<RealResult>,
}

/// What a frame holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct RealFrameSummary {
    /// Id of the frame.
    pub frame: String,
    /// Number of strokes of wood.
    pub wood_strokes: usize,
    /// Standard deviation of the noise of its readings, metres, as second differences along rows show it; absent where it
    /// cannot be seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub depth_noise: Option<f64>,
    /// Number of boxes whose wood is `seen`, `doubtful`, `none` and `unlisted`.
    #[cfg_attr(test, schemars(with = "BTreeMap<String, usize>"))]
    pub boxes: BTreeMap<WoodSeen, usize>,
}

/// One method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct RealResult {
    /// Name of the method.
    pub method: String,
    /// Over all frames.
    pub all: RealFigures,
    /// Over each frame.
    pub frames: Vec<RealFrameFigures>,
    /// Directions of the same apples in two frames of one tree, over all pairs of frames; absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between_frames: Option<RealAgreement>,
    /// Each pair of frames.
    pub pairs: Vec<FrameAgreement>,
    /// Each box of each frame, in the order of the frames and their boxes.
    pub apples: Vec<RealRow>,
}

/// The figures of a method over one frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct RealFrameFigures {
    /// Id of the frame.
    pub frame: String,
    /// Its figures.
    pub figures: RealFigures,
}

/// The figures of a method over one frame or several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
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
    /// Directions from perturbed copies of the frames beside those from the frames, all boxes; absent without copies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub perturbed: Option<PerturbedAgreement>,
}

/// How two sets of directions of the same apples agree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct RealAgreement {
    /// Share of the pairs that are answered both times.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub answered_in_both: Proportion,
    /// Share of those whose directions are at most 20 degrees apart.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub within_20_deg: Proportion,
    /// Share of those whose directions are more than 50 degrees apart.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub beyond_50_deg: Proportion,
}

/// How the directions from perturbed copies agree with those from the frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct PerturbedAgreement {
    /// Number of copies of each frame.
    pub copies: usize,
    /// Share of the boxes of copies that are answered in the copy and refused in the frame, or the other way round.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub flipped: Proportion,
    /// Their directions.
    pub directions: RealAgreement,
}

/// Two frames of one tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct FrameAgreement {
    /// Id of the one.
    pub first: String,
    /// Id of the other.
    pub second: String,
    /// Number of apples of the same name that have a centre in both.
    pub centers: usize,
    /// Number of those whose centres one rigid motion brings to within 30 mm of each other.
    pub aligned: usize,
    /// Angle of that motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation_angle: Option<f64>,
    /// Directions of the boxes of the same name, turned by that motion; absent where it fits fewer than half of the
    /// centres, since the frames are then not of one tree, or not answered well enough to tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub directions: Option<RealAgreement>,
}

/// The answers to apples whose wood is seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct SeenFigures {
    /// Share of the apples that are answered.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub answered: Proportion,
    /// Share of the answers that point at the wood.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub right: Proportion,
    /// Share of the answers whose foot is on that wood, within 0.15 radii of its edge, wherever along it: another measure,
    /// which a foot beside the nearest point meets, as perspective and slanting wood bring it about, and one that points
    /// past the wood does not.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub on_wood: Proportion,
    /// Share of the apples with an answer that points at the wood.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub hits: Proportion,
    /// Number of answers that point elsewhere.
    pub elsewhere: usize,
    /// Number of apples refused for each reason.
    pub refused: BTreeMap<String, usize>,
}

/// The answers to apples whose wood is not seen for certain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct UnseenFigures {
    /// Share of the apples that are refused.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub refused: Proportion,
    /// Share of the apples that are answered.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub answered: Proportion,
    /// Share of the apples that are answered with a confidence of at least 0.5; an answer without a confidence counts.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub confident: Proportion,
}

/// What the confidence says of answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct RealReliability {
    /// Share that points at the wood, of the answers of each range of confidence.
    pub bins: Vec<ConfidenceShare>,
    /// The same of the answers with a confidence of at least 0.9.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub right_of_confident: Proportion,
    /// Mean confidence.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub mean_confidence: f64,
    /// Mean squared difference of confidence and outcome (Brier 1950); 0.25 for a confidence that is always 0.5.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub brier: f64,
}

/// A range of confidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct ConfidenceShare {
    /// Lowest confidence.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub from: f64,
    /// Confidence below which it ends; the last range includes 1.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub to: f64,
    /// Share of its answers that point at the wood.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub right: Proportion,
}

/// What became of one box under one method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
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
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub confidence: Option<f64>,
    /// Angle in the image between the direction to the foot and that to the wood.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub image_angle: Option<f64>,
    /// Distance of the wood from the apple's centre in the image, radii of the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub wood_distance_radii: Option<f64>,
    /// Distance of the foot from the nearest point of the wood in the image, radii of the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub foot_from_wood_radii: Option<f64>,
    /// Distance of the foot from that wood anywhere along it in the image, radii of the box; 0 on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub foot_off_wood_radii: Option<f64>,
    /// Number of strokes nearer than that wood that depth shows far in front of the apple or behind it.
    pub passed_over: usize,
    /// Distance of the fitted centre from the camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub distance: Option<f64>,
    /// Fitted radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
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
    /// Points nearest to the centre of the strokes that count as nearest, one of each, pixels.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wood_px: Vec<[f64; 2]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        pomona_schema::assert_in_docs::<RealReport>(REAL_SCHEMA, "real-evaluation.schema.json");
    }
}
