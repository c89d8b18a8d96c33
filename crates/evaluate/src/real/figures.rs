use super::apple_wood::WoodSeen;
use super::record::{
    ConfidenceShare, RealFigures, RealReliability, RealRow, SeenFigures, UnseenFigures, Verdict,
};
use pomona_statistics::Proportion;
use std::collections::BTreeMap;

/// Bounds of the ranges of confidence: doubted, weak, fair and sure answers. Few, since frames have few apples.
const CONFIDENCE_BOUNDS: [f64; 5] = [0.0, 0.5, 0.7, 0.9, 1.0];

/// Distance from the edge of wood within which a foot is on it: strokes and centres are some pixels off; radii.
const ON_WOOD_RADII: f64 = 0.15;

/// A confidence from here on is that of an answer that a robot would act on.
const CONFIDENT: f64 = 0.5;

impl RealFigures {
    /// The figures of rows; those of copies are left out.
    pub(super) fn of<'a>(rows: impl Iterator<Item = &'a RealRow>) -> Self {
        let mut of_wood: BTreeMap<WoodSeen, Vec<&RealRow>> = BTreeMap::new();
        for row in rows {
            of_wood.entry(row.wood).or_default().push(row);
        }
        let mut take = |wood| of_wood.remove(&wood).unwrap_or_default();
        let seen = take(WoodSeen::Seen);
        Self {
            reliability: RealReliability::of(&seen),
            seen: SeenFigures::of(&seen),
            none: UnseenFigures::of(&take(WoodSeen::None)),
            doubtful: UnseenFigures::of(&take(WoodSeen::Doubtful)),
            unlisted: UnseenFigures::of(&take(WoodSeen::Unlisted)),
            perturbed: None,
        }
    }
}

impl SeenFigures {
    fn of(rows: &[&RealRow]) -> Self {
        let count = |verdict| rows.iter().filter(|row| row.verdict == verdict).count();
        let (right, elsewhere) = (count(Verdict::Right), count(Verdict::Elsewhere));
        let is_on_wood =
            |row: &&&RealRow| row.foot_off_wood_radii.is_some_and(|d| d <= ON_WOOD_RADII);
        let on_wood = rows.iter().filter(is_on_wood).count();
        let mut refused = BTreeMap::new();
        for row in rows.iter().filter(|row| row.verdict == Verdict::Refused) {
            *refused.entry(row.status.clone()).or_insert(0) += 1;
        }
        Self {
            answered: Proportion::new(right + elsewhere, rows.len()),
            right: Proportion::new(right, right + elsewhere),
            on_wood: Proportion::new(on_wood, right + elsewhere),
            hits: Proportion::new(right, rows.len()),
            elsewhere,
            refused,
        }
    }
}

impl UnseenFigures {
    fn of(rows: &[&RealRow]) -> Self {
        let answered = rows.iter().filter(|row| row.verdict != Verdict::Refused);
        let is_confident = |row: &&&RealRow| row.confidence.is_none_or(|c| c >= CONFIDENT);
        let confident = answered.clone().filter(is_confident).count();
        let answered = answered.count();
        Self {
            refused: Proportion::new(rows.len() - answered, rows.len()),
            answered: Proportion::new(answered, rows.len()),
            confident: Proportion::new(confident, rows.len()),
        }
    }
}

impl RealReliability {
    fn of(rows: &[&RealRow]) -> Option<Self> {
        let answers: Vec<(f64, bool)> = rows
            .iter()
            .filter(|row| row.verdict != Verdict::Refused)
            .filter_map(|row| Some((row.confidence?, row.verdict == Verdict::Right)))
            .collect();
        if answers.is_empty() {
            return None;
        }
        let right = |from: f64, to: f64| {
            let is_last = Some(&to) == CONFIDENCE_BOUNDS.last();
            let own = answers
                .iter()
                .filter(|(c, _)| *c >= from && (*c < to || is_last));
            Proportion::new(own.clone().filter(|(_, right)| *right).count(), own.count())
        };
        let bins: Vec<ConfidenceShare> = CONFIDENCE_BOUNDS
            .windows(2)
            .map(|pair| ConfidenceShare {
                from: pair[0],
                to: pair[1],
                right: right(pair[0], pair[1]),
            })
            .collect();
        let mean = |of: &dyn Fn(f64, bool) -> f64| {
            answers.iter().map(|&(c, right)| of(c, right)).sum::<f64>() / answers.len() as f64
        };
        Some(Self {
            right_of_confident: bins.last()?.right,
            bins,
            mean_confidence: mean(&|confidence, _| confidence),
            brier: mean(&|confidence, right| (confidence - f64::from(u8::from(right))).powi(2)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(wood: WoodSeen, verdict: Verdict, confidence: Option<f64>) -> RealRow {
        RealRow {
            frame: "a".into(),
            box_name: "1".into(),
            box_radius_px: 30.0,
            wood,
            verdict,
            status: if verdict == Verdict::Refused {
                "no_branch"
            } else {
                "picked"
            }
            .into(),
            confidence,
            image_angle: None,
            wood_distance_radii: None,
            foot_from_wood_radii: None,
            foot_off_wood_radii: (verdict == Verdict::Right).then_some(0.1),
            passed_over: 0,
            distance: None,
            radius: None,
            center: None,
            foot: None,
            center_px: None,
            foot_px: None,
            wood_px: Vec::new(),
        }
    }

    #[test]
    fn shares_are_of_what_they_say() {
        use Verdict::{Answered, Elsewhere, Refused, Right};
        use WoodSeen::{Doubtful, None as Nothing, Seen, Unlisted};
        let rows = [
            row(Seen, Right, Some(0.95)),
            row(Seen, Elsewhere, Some(0.9)),
            row(Seen, Elsewhere, Some(0.4)),
            row(Seen, Refused, Some(0.2)),
            row(Nothing, Answered, Some(0.4)),
            row(Nothing, Answered, Some(0.5)),
            row(Nothing, Refused, Some(0.6)),
            row(Doubtful, Answered, None),
            row(Unlisted, Refused, None),
        ];
        let figures = RealFigures::of(rows.iter());
        let counts = |p: &Proportion| (p.count, p.of);
        assert_eq!(counts(&figures.seen.answered), (3, 4));
        assert_eq!(counts(&figures.seen.right), (1, 3));
        assert_eq!(counts(&figures.seen.on_wood), (1, 3));
        assert_eq!(counts(&figures.seen.hits), (1, 4));
        assert_eq!(figures.seen.elsewhere, 2);
        assert_eq!(figures.seen.refused["no_branch"], 1);
        assert_eq!(counts(&figures.none.refused), (1, 3));
        assert_eq!(counts(&figures.none.answered), (2, 3));
        assert_eq!(counts(&figures.none.confident), (1, 3));
        assert_eq!(counts(&figures.doubtful.confident), (1, 1));
        assert_eq!(counts(&figures.unlisted.refused), (1, 1));
        let reliability = figures.reliability.unwrap();
        let bins: Vec<_> = reliability.bins.iter().map(|b| counts(&b.right)).collect();
        assert_eq!(bins, [(0, 1), (0, 0), (0, 0), (1, 2)]);
        assert_eq!(counts(&reliability.right_of_confident), (1, 2));
        let brier = (0.05_f64.powi(2) + 0.9_f64.powi(2) + 0.4_f64.powi(2)) / 3.0;
        assert!((reliability.brier - brier).abs() < 1e-12);
        assert!(RealFigures::of(rows[7..].iter()).reliability.is_none());
    }
}
