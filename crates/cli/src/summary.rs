use pomona::record::PicksRecord;
use pomona::{FrameAnswer, Status};
use std::fmt;

/// How many apples of some frames were picked and refused, and why; written in one line without a line break.
#[derive(Default)]
pub(crate) struct Summary {
    frames: usize,
    picked: usize,
    /// The reasons of the refusals, each with its number.
    refused: Vec<(&'static str, usize)>,
    /// What detectors found and what depth made of it; `None` where all boxes were given.
    detected: Option<Detected>,
}

/// What detectors found in some frames.
#[derive(Clone, Copy, Default)]
struct Detected {
    detections: usize,
    merged: usize,
    marked: usize,
    by_depth: usize,
}

impl Summary {
    /// Of the answers for some frames.
    pub(crate) fn of(answers: &[FrameAnswer]) -> Self {
        let mut summary = Self::default();
        for answer in answers {
            let detected = answer.detection.as_ref().map(|d| Detected {
                detections: d.detections,
                merged: d.merged,
                marked: d.marked,
                by_depth: d.by_depth,
            });
            summary.add(answer.apples.iter().map(|a| a.status), detected);
        }
        summary
    }

    /// Of one frame's record that was read from a file.
    pub(crate) fn of_record(record: &PicksRecord) -> Self {
        let mut summary = Self::default();
        let detected = record.detection.as_ref().map(|d| Detected {
            detections: d.detections,
            merged: d.merged,
            marked: d.marked,
            by_depth: d.by_depth,
        });
        summary.add(record.picks.iter().map(|p| p.status), detected);
        summary
    }

    fn add(&mut self, statuses: impl Iterator<Item = Status>, detected: Option<Detected>) {
        self.frames += 1;
        for status in statuses {
            let name = status.name();
            if status == Status::Picked {
                self.picked += 1;
            } else if let Some((_, count)) = self.refused.iter_mut().find(|(n, _)| *n == name) {
                *count += 1;
            } else {
                self.refused.push((name, 1));
            }
        }
        self.refused
            .sort_by_key(|&(name, count)| (std::cmp::Reverse(count), name));
        if let Some(d) = detected {
            let sum = self.detected.get_or_insert_default();
            sum.detections += d.detections;
            sum.merged += d.merged;
            sum.marked += d.marked;
            sum.by_depth += d.by_depth;
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let refused: usize = self.refused.iter().map(|(_, count)| count).sum();
        write!(
            f,
            "{} in {}: {} picked, {refused} refused",
            plural(self.picked + refused, "apple"),
            plural(self.frames, "frame"),
            self.picked
        )?;
        if !self.refused.is_empty() {
            let reasons = self
                .refused
                .iter()
                .map(|(name, count)| format!("{count} {name}"));
            write!(f, " ({})", reasons.collect::<Vec<_>>().join(", "))?;
        }
        if let Some(d) = &self.detected {
            let detections = plural(d.detections, "detection");
            write!(
                f,
                "; {detections}, {} merged, {} marked",
                d.merged, d.marked
            )?;
            if d.by_depth > 0 {
                write!(f, ", {} more found in depth", d.by_depth)?;
            }
        }
        Ok(())
    }
}

/// `count` and its noun.
pub(crate) fn plural(count: usize, noun: &str) -> String {
    if count == 1 {
        format!("1 {noun}")
    } else {
        format!("{count} {noun}s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::tests::answer;
    use pomona::DetectionSummary;

    #[test]
    fn reasons_are_counted() {
        let statuses = [
            Status::NoDepth,
            Status::Picked,
            Status::NoBranch,
            Status::NoDepth,
        ];
        let (all, text) = (
            answer(&statuses),
            "4 apples in 1 frame: 1 picked, 3 refused (2 no_depth, 1 no_branch)",
        );
        assert_eq!(
            Summary::of_record(&PicksRecord::from(&all)).to_string(),
            text
        );
        assert_eq!(Summary::of(&[all]).to_string(), text);
        let mut found = answer(&[Status::Implausible]);
        let mut detection = DetectionSummary::default();
        (detection.detections, detection.merged, detection.marked) = (3, 2, 1);
        found.detection = Some(detection);
        let text = "1 apple in 1 frame: 0 picked, 1 refused (1 implausible); 3 detections, 2 merged, 1 marked";
        assert_eq!(
            Summary::of_record(&PicksRecord::from(&found)).to_string(),
            text
        );
        assert_eq!(Summary::of(&[found]).to_string(), text);
        assert_eq!(
            Summary::of(&[]).to_string(),
            "0 apples in 0 frames: 0 picked, 0 refused"
        );
    }
}
