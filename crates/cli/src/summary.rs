use pomona::{Record, Status};

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
    let counts = format!("{apples} in {frames}: {picked} picked, {refused} refused");
    if reasons.is_empty() {
        return counts;
    }
    let reasons = reasons
        .iter()
        .map(|(name, count)| format!("{count} {name}"));
    format!("{counts} ({})", reasons.collect::<Vec<_>>().join(", "))
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
        assert_eq!(summary(&[]), "0 apples in 0 frames: 0 picked, 0 refused");
    }
}
