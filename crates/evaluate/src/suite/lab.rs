use crate::apple_row::{AppleRow, mean_of, values};
use crate::paper_figures::ORIENTATIONS;
use pomona_statistics::{MeanSd, Summary};
use serde::{Deserialize, Serialize};

/// One row of the paper's Tables 1–3 with ours beside it, over all noise draws of the orientation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LabRow {
    /// Name of the orientation, such as `x-90`.
    pub orientation: String,
    /// Scenes of it.
    pub draws: usize,
    /// Scenes of it that were answered.
    pub answered: usize,
    /// True direction.
    pub true_direction: Option<[f64; 3]>,
    /// Mean of our directions; not a unit vector where they differ.
    pub direction: Option<[f64; 3]>,
    /// Our radii.
    pub radius: Option<MeanSd>,
    /// Our centre errors.
    pub center_error: Option<Summary>,
    /// Our angle errors.
    pub angle_error: Option<Summary>,
    /// The paper's radius.
    pub paper_radius: f64,
    /// The paper's direction, as printed.
    pub paper_direction: [f64; 3],
    /// The paper's angle error.
    pub paper_angle_error: f64,
}

impl LabRow {
    /// The rows that the apples fill, in the paper's order; none where they are not the lab's.
    pub(crate) fn all(rows: &[&AppleRow]) -> Vec<Self> {
        ORIENTATIONS
            .iter()
            .filter_map(|paper| {
                let own = |row: &&&AppleRow| orientation_of(&row.case) == Some(paper.name);
                let own: Vec<&AppleRow> = rows.iter().filter(own).copied().collect();
                let first = own.first()?;
                let directions: Vec<[f64; 3]> =
                    own.iter().filter_map(|row| row.direction).collect();
                let radii: Vec<f64> = own.iter().filter_map(|row| row.radius).collect();
                Some(Self {
                    orientation: paper.name.to_owned(),
                    draws: own.len(),
                    answered: directions.len(),
                    true_direction: first.true_direction,
                    direction: mean_of(&directions),
                    radius: MeanSd::of(&radii),
                    center_error: Summary::of(&values(&own, |row| row.center_error)),
                    angle_error: Summary::of(&values(&own, |row| row.angle_error)),
                    paper_radius: paper.radius,
                    paper_direction: paper.direction,
                    paper_angle_error: paper.angle_error_deg.to_radians(),
                })
            })
            .collect()
    }
}

/// `x-90` of `lab-x-90-s3`, the name of a lab scene.
fn orientation_of(case: &str) -> Option<&str> {
    let (orientation, seed) = case.strip_prefix("lab-")?.rsplit_once("-s")?;
    seed.parse::<u64>().ok().map(|_| orientation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_scenes::Orientation;

    #[test]
    fn names_are_those_of_the_scenes() {
        assert_eq!(orientation_of("lab-x-90-s3"), Some("x-90"));
        assert_eq!(orientation_of("lab-y0-s12"), Some("y0"));
        assert_eq!(orientation_of("orchard-0001"), None);
        for (ours, paper) in Orientation::PAPER.iter().zip(ORIENTATIONS) {
            assert_eq!(ours.name(), paper.name);
        }
    }
}
