use super::angle_errors::AngleErrors;
use crate::apple_row::{AppleRow, values};
use pomona_statistics::{Proportion, Summary};
use serde::{Deserialize, Serialize};

/// Errors of one suite and method against one thing that makes an apple hard.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Grouping {
    /// What the apples are grouped by.
    pub by: Difficulty,
    /// The groups that hold apples, in ascending order.
    pub groups: Vec<Group>,
}

/// What makes an apple hard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Difficulty {
    /// Distance of the centre from the camera, metres.
    Distance,
    /// Share of the apple's silhouette that is hidden.
    Occlusion,
    /// Diameter of the branch, metres.
    BranchThickness,
    /// Leaves within 3 radii.
    Leaves,
    /// Length of the branch that shows within 3 radii, metres.
    VisibleBranchLength,
}

/// The apples whose difficulty lies in `from..to`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Group {
    /// Least value.
    pub from: f64,
    /// Upper bound, not included; absent for the last, open group.
    pub to: Option<f64>,
    /// Apples asked for.
    pub apples: usize,
    /// Apples that got a direction.
    pub answered: Proportion,
    /// Angle errors of the answered ones.
    pub angle: Option<AngleErrors>,
    /// Centre errors of those with a sphere.
    pub center_error: Option<Summary>,
}

impl Difficulty {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Distance,
        Self::Occlusion,
        Self::BranchThickness,
        Self::Leaves,
        Self::VisibleBranchLength,
    ];

    /// Where the groups begin; what lies below the first belongs to it.
    fn edges(self) -> &'static [f64] {
        match self {
            Self::Distance => &[0.0, 0.8, 0.95, 1.1, 1.25, 1.4],
            Self::Occlusion => &[0.0, 0.1, 0.25, 0.4, 0.55, 0.7],
            Self::BranchThickness => &[0.0, 0.006, 0.009, 0.012, 0.016],
            Self::Leaves => &[0.0, 1.0, 3.0, 6.0, 9.0],
            Self::VisibleBranchLength => &[0.0, 0.01, 0.05, 0.1, 0.15, 0.2],
        }
    }

    /// The value for one apple, where the truth tells.
    pub fn of(self, row: &AppleRow) -> Option<f64> {
        match self {
            Self::Distance => Some(row.distance),
            Self::Occlusion => row.visible_share.map(|share| 1.0 - share),
            Self::BranchThickness => row.branch_radius.map(|radius| 2.0 * radius),
            Self::Leaves => row.leaves,
            Self::VisibleBranchLength => row.visible_branch_length,
        }
    }
}

impl Grouping {
    /// The groupings that the truth allows.
    pub(crate) fn all(rows: &[&AppleRow]) -> Vec<Self> {
        Difficulty::ALL
            .into_iter()
            .map(|by| Self::of(by, rows))
            .filter(|g| !g.groups.is_empty())
            .collect()
    }

    fn of(by: Difficulty, rows: &[&AppleRow]) -> Self {
        let edges = by.edges();
        let number = |value: f64| {
            edges
                .iter()
                .filter(|&&edge| value >= edge)
                .count()
                .saturating_sub(1)
        };
        let groups = (0..edges.len()).filter_map(|i| {
            let inside = |row: &&&AppleRow| by.of(row).is_some_and(|value| number(value) == i);
            let rows: Vec<&AppleRow> = rows.iter().filter(inside).copied().collect();
            let answered = rows.iter().filter(|row| row.is_answered()).count();
            (!rows.is_empty()).then(|| Group {
                from: edges[i],
                to: edges.get(i + 1).copied(),
                apples: rows.len(),
                answered: Proportion::new(answered, rows.len()),
                angle: AngleErrors::of(&values(&rows, |row| row.angle_error)),
                center_error: Summary::of(&values(&rows, |row| row.center_error)),
            })
        });
        Self {
            by,
            groups: groups.collect(),
        }
    }
}
