use crate::outcome::{BranchCandidate, FittedApple, FittedBranch};
use serde::{Deserialize, Serialize};

/// A fitted apple.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct AppleRecord {
    /// Centre: the paper's O.
    pub center: [f64; 3],
    /// Radius.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub radius: f64,
    /// Number of the readings of the box that lie on the surface.
    pub inliers: usize,
    /// Root mean square of their distances from it.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub rms: f64,
    /// Covariance of the centre, square metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center_covariance: Option<[[f64; 3]; 3]>,
    /// Standard deviation of the radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub radius_sd: Option<f64>,
    /// Share of its outline's area on which its surface shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub visible_share: Option<f64>,
    /// How well the body agrees with points, outline and box; 1 is perfect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub agreement: Option<f64>,
}

/// A fitted branch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct BranchRecord {
    /// A point on the line.
    pub point: [f64; 3],
    /// Its unit direction; the opposite one is the same line.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: [f64; 3],
    /// Number of the points that lie on it.
    pub inliers: usize,
    /// Root mean square of their distances from it.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub rms: f64,
}

/// A branch that was weighed against others. Metres; lengths are measured along the branch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct CandidateRecord {
    /// Point of its axis nearest to the apple's centre.
    pub foot: [f64; 3],
    /// Unit tangent of its axis there.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub tangent: [f64; 3],
    /// Radius of the branch.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub radius: f64,
    /// Distance of the foot from the centre.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub distance: f64,
    /// What it is ranked by; larger is better.
    pub score: f64,
    /// Length that shows with the branch's own width.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub shown: f64,
    /// Of that, what lies on the side of the foot that shows less.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub shown_lesser_side: f64,
    /// Length at which something else of its depth shows.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub odd: f64,
    /// Length at which the camera looks past or through it.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub empty: f64,
    /// Length that something nearer hides.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub hidden: f64,
    /// Probability that it is wood, where the colour image tells; the score is then the probability that it is the
    /// nearest wood.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub wood: Option<f64>,
    /// By how much it stands out as wood from what lies beside it, where the colour image tells.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = -1.0, max = 1.0)))]
    pub contrast: Option<f64>,
}

impl From<&FittedApple> for AppleRecord {
    fn from(apple: &FittedApple) -> Self {
        Self {
            center: apple.center.point().into(),
            radius: apple.radius_m,
            inliers: apple.inliers,
            rms: apple.rms_m,
            center_covariance: apple.center_covariance.map(|c| c.matrix_m2().into()),
            radius_sd: apple.radius_sd_m,
            visible_share: apple.visible_share,
            agreement: apple.agreement,
        }
    }
}

impl From<&FittedBranch> for BranchRecord {
    fn from(branch: &FittedBranch) -> Self {
        Self {
            point: branch.point.point().into(),
            direction: branch.direction.vector().into(),
            inliers: branch.inliers,
            rms: branch.rms_m,
        }
    }
}

impl From<&BranchCandidate> for CandidateRecord {
    fn from(candidate: &BranchCandidate) -> Self {
        Self {
            foot: candidate.foot.point().into(),
            tangent: candidate.tangent.vector().into(),
            radius: candidate.radius_m,
            distance: candidate.distance_m,
            score: candidate.score,
            shown: candidate.shown_m,
            shown_lesser_side: candidate.shown_lesser_side_m,
            odd: candidate.odd_m,
            empty: candidate.empty_m,
            hidden: candidate.hidden_m,
            wood: candidate.wood,
            contrast: candidate.contrast,
        }
    }
}
