use pomona::{DetectionRecord, Record, Status};

/// How many apples were picked and refused, and why, in one line without a line break.
pub(crate) fn summary(records: &[Record]) -> String {
    let picks = || records.iter().flat_map(|record| &record.picks);
    let apples = plural(picks().count(), "apple");
    let frames = plural(records.len(), "frame");
    let mut reasons: Vec<(&str, usize)> = Vec::new();
    for pick in picks().filter(|p| p.status != Status::Picked) {
        let name = pick.status.name();
        match reasons.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => reasons.push((name, 1)),
        }
    }
    reasons.sort_by_key(|&(name, count)| (std::cmp::Reverse(count), name));
    let refused: usize = reasons.iter().map(|(_, count)| count).sum();
    let picked = picks().count() - refused;
    let mut text = format!("{apples} in {frames}: {picked} picked, {refused} refused");
    if !reasons.is_empty() {
        let reasons = reasons
            .iter()
            .map(|(name, count)| format!("{count} {name}"));
        text = format!("{text} ({})", reasons.collect::<Vec<_>>().join(", "));
    }
    text + &detected(records)
}

/// What detectors found and what depth made of it; empty where all boxes were given.
fn detected(records: &[Record]) -> String {
    let detections = || {
        records
            .iter()
            .filter_map(|record| record.detection.as_ref())
    };
    if detections().next().is_none() {
        return String::new();
    }
    let sum = |count: fn(&DetectionRecord) -> usize| detections().map(count).sum::<usize>();
    let counts = format!(
        "; {}, {} merged, {} marked",
        plural(sum(|d| d.detections), "detection"),
        sum(|d| d.merged),
        sum(|d| d.marked)
    );
    let by_depth = sum(|d| d.by_depth);
    if by_depth == 0 {
        return counts;
    }
    format!("{counts}, {by_depth} more found in depth")
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
    use crate::table::tests::record;

    #[test]
    fn reasons_are_counted() {
        let statuses = [
            Status::NoDepth,
            Status::Picked,
            Status::NoBranch,
            Status::NoDepth,
        ];
        assert_eq!(
            summary(&[record(&statuses)]),
            "4 apples in 1 frame: 1 picked, 3 refused (2 no_depth, 1 no_branch)"
        );
        let mut found = record(&[Status::Implausible]);
        found.detection = Some(DetectionRecord {
            detections: 3,
            merged: 2,
            marked: 1,
            ..DetectionRecord::default()
        });
        assert_eq!(
            summary(&[found]),
            "1 apple in 1 frame: 0 picked, 1 refused (1 implausible); 3 detections, 2 merged, 1 marked"
        );
        assert_eq!(summary(&[]), "0 apples in 0 frames: 0 picked, 0 refused");
    }
}
