use pomona_cloud::{LabelKind, PixelBox};
use pomona_detect::Detection;

/// The intersections over union that COCO asks of a true positive.
pub(crate) const IOU_THRESHOLDS: [f64; 10] =
    [0.50, 0.55, 0.60, 0.65, 0.70, 0.75, 0.80, 0.85, 0.90, 0.95];

/// A labelled box as detections are matched with it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GroundTruthBox {
    /// Left, upper, right and lower edge, pixels.
    pub edges: [f64; 4],
    /// Whether a detector has to find it.
    pub kind: LabelKind,
}

impl GroundTruthBox {
    /// The edges of `bounds`, with `kind`.
    pub fn new(bounds: &PixelBox, kind: LabelKind) -> Self {
        Self {
            edges: [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max],
            kind,
        }
    }

    /// Whether it has to be found: neither difficult nor a crowd.
    pub fn counts(&self) -> bool {
        self.kind == LabelKind::Object
    }

    /// Area in square pixels.
    pub fn area(&self) -> f64 {
        area(self.edges)
    }

    /// Intersection over union with a detection; for a crowd, intersection over the detection's area, since a detection
    /// may cover a part of the crowd.
    fn iou(&self, detection: [f64; 4]) -> f64 {
        let common = common_area(self.edges, detection);
        let whole = match self.kind {
            LabelKind::Crowd => area(detection),
            _ => self.area() + area(detection) - common,
        };
        if whole > 0.0 { common / whole } else { 0.0 }
    }
}

/// The result of matching one detection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DetectionMatch {
    /// It found a label.
    TruePositive {
        /// Index of the label.
        label: usize,
        /// Intersection over union of the two.
        iou: f64,
    },
    /// It matches a difficult label or a crowd, and counts neither as right nor as wrong.
    Ignored,
    /// It matches no label.
    FalsePositive,
}

/// Matches the detections of one image with its labels, as COCO does; one result for each detection.
///
/// Detections choose in order of descending score, equal scores in the order given. Each takes the free label
/// with the largest intersection over union, if that is at least `least_iou`; among equals, the last one. A
/// detection is matched with a difficult label or a crowd only where it finds no other label; a crowd may be matched
/// more than once. Scores that are not finite come last.
///
/// Lin et al. 2014, "Microsoft COCO: Common Objects in Context", and the evaluation that comes with it.
pub fn match_detections(
    detections: &[Detection],
    labels: &[GroundTruthBox],
    least_iou: f64,
) -> Vec<DetectionMatch> {
    let mut order: Vec<usize> = (0..detections.len()).collect();
    order.sort_by(|&a, &b| rank(detections[b].score).total_cmp(&rank(detections[a].score)));
    let mut taken = vec![false; labels.len()];
    let mut matches = vec![DetectionMatch::FalsePositive; detections.len()];
    for index in order {
        let d = &detections[index];
        let edges = [d.x_min, d.y_min, d.x_max, d.y_max];
        let best = |counting: bool| {
            let free = labels.iter().enumerate().filter(|&(l, label)| {
                let open = !taken[l] || label.kind == LabelKind::Crowd;
                label.counts() == counting && open
            });
            free.map(|(l, label)| (l, label.iou(edges)))
                .filter(|&(_, iou)| iou >= least_iou)
                .max_by(|a, b| a.1.total_cmp(&b.1))
        };
        if let Some((label, iou)) = best(true) {
            taken[label] = true;
            matches[index] = DetectionMatch::TruePositive { label, iou };
        } else if let Some((label, _)) = best(false) {
            taken[label] = true;
            matches[index] = DetectionMatch::Ignored;
        }
    }
    matches
}

/// A score as matching and ranking order it: what is not finite comes last.
pub(crate) fn rank(score: f64) -> f64 {
    if score.is_finite() {
        score
    } else {
        f64::NEG_INFINITY
    }
}

fn area([x_min, y_min, x_max, y_max]: [f64; 4]) -> f64 {
    (x_max - x_min).max(0.0) * (y_max - y_min).max(0.0)
}

fn common_area(a: [f64; 4], b: [f64; 4]) -> f64 {
    area([
        a[0].max(b[0]),
        a[1].max(b[1]),
        a[2].min(b[2]),
        a[3].min(b[3]),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn detection(score: f64, x: f64) -> Detection {
        Detection {
            x_min: x,
            y_min: 0.0,
            x_max: x + 10.0,
            y_max: 10.0,
            score,
            class: 0,
        }
    }

    fn label(x: f64, kind: LabelKind) -> GroundTruthBox {
        GroundTruthBox {
            edges: [x, 0.0, x + 10.0, 10.0],
            kind,
        }
    }

    fn hits(outcomes: &[DetectionMatch]) -> Vec<Option<usize>> {
        let hit = |outcome: &DetectionMatch| match outcome {
            DetectionMatch::TruePositive { label, .. } => Some(*label),
            _ => None,
        };
        outcomes.iter().map(hit).collect()
    }

    #[test]
    fn the_surest_detection_chooses_first_and_each_label_is_found_once() {
        let labels = [label(0.0, LabelKind::Object)];
        let detections = [detection(0.5, 0.0), detection(0.9, 2.0)];
        let outcomes = match_detections(&detections, &labels, 0.5);
        assert_eq!(outcomes[0], DetectionMatch::FalsePositive);
        // 8 · 10 common of 12 · 10 covered.
        assert_eq!(
            outcomes[1],
            DetectionMatch::TruePositive {
                label: 0,
                iou: 80.0 / 120.0
            }
        );
    }

    #[test]
    fn a_detection_takes_what_it_overlaps_most() {
        let labels = [label(0.0, LabelKind::Object), label(3.0, LabelKind::Object)];
        let found = match_detections(&[detection(1.0, 2.0), detection(0.5, 1.0)], &labels, 0.5);
        assert_eq!(hits(&found), [Some(1), Some(0)]);
    }

    #[test]
    fn ignored_labels_neither_count_nor_punish() {
        for kind in [LabelKind::Difficult, LabelKind::Crowd] {
            let labels = [label(0.0, kind), label(1.0, LabelKind::Object)];
            let detections = [
                detection(0.9, 0.0),
                detection(0.8, 0.5),
                detection(0.7, 40.0),
            ];
            // The first one lies on the ignored label exactly, but finds the other one well enough.
            let outcomes = match_detections(&detections, &labels, 0.5);
            assert_eq!(hits(&outcomes), [Some(1), None, None]);
            assert_eq!(
                outcomes[1..],
                [DetectionMatch::Ignored, DetectionMatch::FalsePositive]
            );
        }
    }

    #[test]
    fn a_crowd_takes_many_and_a_difficult_label_one() {
        let wide = |kind| GroundTruthBox {
            edges: [0.0, 0.0, 100.0, 10.0],
            kind,
        };
        let detections = [detection(0.9, 0.0), detection(0.8, 50.0)];
        let crowd = match_detections(&detections, &[wide(LabelKind::Crowd)], 0.5);
        assert_eq!(crowd, [DetectionMatch::Ignored; 2]);
        let twice = [detection(0.9, 0.0), detection(0.8, 0.0)];
        let difficult = match_detections(&twice, &[label(0.0, LabelKind::Difficult)], 0.5);
        assert_eq!(
            difficult,
            [DetectionMatch::Ignored, DetectionMatch::FalsePositive]
        );
    }

    #[test]
    fn boxes_and_scores_that_are_no_numbers_find_nothing_and_harm_nobody() {
        let mut bad = detection(f64::NAN, 0.0);
        bad.x_max = f64::NAN;
        let inverted = Detection {
            x_max: -5.0,
            ..detection(0.9, 0.0)
        };
        let detections = [bad, inverted, detection(0.1, 0.0)];
        let outcomes = match_detections(&detections, &[label(0.0, LabelKind::Object)], 0.5);
        assert_eq!(hits(&outcomes), [None, None, Some(0)]);
        assert_eq!(match_detections(&[], &[], 0.5), []);
    }

    /// The rules once more, by trying all labels in COCO's own order: those that count first, and a best one so far
    /// that only an overlap at least as large replaces.
    fn by_the_book(
        detections: &[Detection],
        labels: &[GroundTruthBox],
        least: f64,
    ) -> Vec<Option<usize>> {
        let mut order: Vec<usize> = (0..labels.len()).collect();
        order.sort_by_key(|&l| !labels[l].counts());
        let mut by_score: Vec<usize> = (0..detections.len()).collect();
        by_score.sort_by(|&a, &b| detections[b].score.total_cmp(&detections[a].score));
        let mut taken = vec![false; labels.len()];
        let mut found = vec![None; detections.len()];
        for d in by_score {
            let edges = [
                detections[d].x_min,
                detections[d].y_min,
                detections[d].x_max,
                detections[d].y_max,
            ];
            let (mut best, mut at) = (least, None);
            for &l in &order {
                if taken[l] && labels[l].kind != LabelKind::Crowd {
                    continue;
                }
                if at.is_some_and(|m: usize| labels[m].counts()) && !labels[l].counts() {
                    break;
                }
                let overlap = labels[l].iou(edges);
                if overlap >= best {
                    (best, at) = (overlap, Some(l));
                }
            }
            if let Some(l) = at {
                taken[l] = true;
                found[d] = Some(l);
            }
        }
        found
    }

    proptest! {
        #[test]
        fn agrees_with_the_rules_written_out(
            places in prop::collection::vec((0.0..60.0_f64, 0.0..1.0_f64), 0..12),
            labels in prop::collection::vec((0.0..60.0_f64, 0..4_u8), 0..12),
            least in 0.05..0.95_f64,
        ) {
            let detections: Vec<_> = places.iter().map(|&(x, s)| detection(s, x)).collect();
            let labels: Vec<_> = labels.iter().map(|&(x, kind)| label(x, match kind {
                0 => LabelKind::Difficult,
                1 => LabelKind::Crowd,
                _ => LabelKind::Object,
            })).collect();
            let outcomes = match_detections(&detections, &labels, least);
            let book = by_the_book(&detections, &labels, least);
            for (outcome, label) in outcomes.iter().zip(book) {
                match (outcome, label) {
                    (DetectionMatch::TruePositive { label, .. }, Some(l)) => prop_assert_eq!(*label, l),
                    (DetectionMatch::Ignored, Some(l)) => prop_assert!(!labels[l].counts()),
                    (DetectionMatch::FalsePositive, None) => {}
                    other => prop_assert!(false, "{:?}", other),
                }
            }
        }
    }
}
