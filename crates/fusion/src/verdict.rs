//! The status of a fused apple and where it comes from in words.

use crate::answer::FusedStatus;
use crate::direction::CombinedDirection;
use crate::links::Link;
use pomona::Status;

/// A direction that others contradict must be more probable than not.
const EVEN_ODDS: f64 = 0.5;

/// What a verdict rests on.
pub(crate) struct Findings<'a> {
    /// The status of every observation, those at another position included.
    pub(crate) statuses: &'a [Status],
    /// How many of them are at the current position.
    pub(crate) current: usize,
    pub(crate) link: Option<Link>,
    /// How many directions there are at the current position.
    pub(crate) directions: usize,
    pub(crate) combined: Option<&'a CombinedDirection>,
}

impl Findings<'_> {
    /// The status and the reason; a direction of less than `least_confidence` is refused.
    pub(crate) fn verdict(&self, least_confidence: f64) -> (FusedStatus, String) {
        let seen = self.seen();
        let Some(combined) = self.combined else {
            let reason = format!("{seen}, no direction: {}", self.status_names());
            return (FusedStatus::NoDirection, reason);
        };
        let agreeing = combined.agreeing_count();
        let contradicted = agreeing < self.directions;
        let reason = match (self.directions, agreeing) {
            (1, _) => format!("{seen}, a direction from 1"),
            (n, k) if n == k => format!("{seen}, {n} directions agree"),
            (n, k) => format!("{seen}, {k} of {n} directions agree"),
        };
        let tied = contradicted && combined.confidence < EVEN_ODDS;
        if combined.confidence >= least_confidence && !tied {
            return (FusedStatus::Picked, reason);
        }
        let status = if contradicted {
            FusedStatus::Contradiction
        } else {
            FusedStatus::Unsure
        };
        (status, reason + ", not sure enough")
    }

    /// How many frames show the apple, and which of them show it elsewhere.
    fn seen(&self) -> String {
        let all = self.statuses.len();
        let frames = if all == 1 { "frame" } else { "frames" };
        let seen = format!("seen in {all} {frames}");
        match self.link {
            Some(link) if link.moved => {
                format!("{seen}, moved, {} of them after that", self.current)
            }
            Some(_) => format!("{seen}, {} of them a misfit", all - self.current),
            None => seen,
        }
    }

    /// Each status once, in alphabetical order.
    fn status_names(&self) -> String {
        let mut names: Vec<&str> = self.statuses.iter().map(|s| s.name()).collect();
        names.sort_unstable();
        names.dedup();
        names.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use pomona_transforms::Direction;

    fn combined(confidence: f64, agreeing: &[bool]) -> CombinedDirection {
        CombinedDirection {
            direction: Direction::new(Vector3::z()).unwrap(),
            sd_rad: 0.1,
            confidence,
            agreeing: agreeing.to_vec(),
        }
    }

    fn verdict(statuses: &[Status], combined: Option<&CombinedDirection>) -> (FusedStatus, String) {
        let findings = Findings {
            statuses,
            current: statuses.len(),
            link: None,
            directions: combined.map_or(0, |c| c.agreeing.len()),
            combined,
        };
        findings.verdict(0.35)
    }

    #[test]
    fn the_reason_names_what_the_frames_say() {
        let statuses = [Status::Occluded, Status::NoBranch, Status::Occluded];
        let (status, reason) = verdict(&statuses, None);
        assert_eq!(status, FusedStatus::NoDirection);
        assert_eq!(
            reason,
            "seen in 3 frames, no direction: no_branch, occluded"
        );
    }

    #[test]
    fn contradicted_directions_need_even_odds_and_others_the_least_confidence() {
        let two = [Status::Picked, Status::Picked];
        let of =
            |confidence, agreeing: &[bool]| verdict(&two, Some(&combined(confidence, agreeing)));
        assert_eq!(of(0.4, &[true, true]).0, FusedStatus::Picked);
        assert_eq!(of(0.3, &[true, true]).0, FusedStatus::Unsure);
        assert_eq!(of(0.6, &[true, false]).0, FusedStatus::Picked);
        let (status, reason) = of(0.4, &[true, false]);
        assert_eq!(status, FusedStatus::Contradiction);
        assert_eq!(
            reason,
            "seen in 2 frames, 1 of 2 directions agree, not sure enough"
        );
    }
}
