use pomona_cloud::{LabelKind, PixelBox};
use pomona_detect::Detection;

/// What a detection is measured against: a box and whether it has to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// Left, upper, right and lower edge, pixels.
    pub edges: [f64; 4],
    /// Whether a detector has to find it.
    pub kind: LabelKind,
}

impl Label {
    /// A box that has to be found, or not.
    pub fn new(bounds: &PixelBox, kind: LabelKind) -> Self {
        Self {
            edges: [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max],
            kind,
        }
    }

    /// Whether it counts among those that have to be found.
    pub fn counts(&self) -> bool {
        self.kind == LabelKind::Object
    }

    /// Area in square pixels.
    pub fn area(&self) -> f64 {
        area(self.edges)
    }

    /// Common area of label and detection over what both cover; of a crowd, over the detection alone, since a part
    /// of a crowd may be found.
    fn overlap(&self, detection: [f64; 4]) -> f64 {
        let common = common_area(self.edges, detection);
        let whole = match self.kind {
            LabelKind::Crowd => area(detection),
            _ => self.area() + area(detection) - common,
        };
        if whole > 0.0 { common / whole } else { 0.0 }
    }
}

/// What became of a detection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// It found a label.
    Hit {
        /// Index of the label.
        label: usize,
        /// Intersection over union of the two.
        overlap: f64,
    },
    /// It lies on a label that neither counts nor punishes.
    Ignored,
    /// It found nothing: a further detection.
    Further,
}

/// Joins the detections of one image with its labels, as COCO does, and says what became of each.
///
/// The detections choose in the order of falling score, those of equal score in the order given. Each takes the
/// label that it overlaps most among those that nobody took, if the overlap (intersection over union) is at least
/// `least_overlap`; of two that it overlaps equally, the later one. Only a detection that finds no label that
/// counts is joined with an ignored one; a crowd may be joined with many. Scores that are not finite come last.
///
/// Lin et al. 2014, "Microsoft COCO: Common Objects in Context", and the evaluation that comes with it.
pub fn match_detections(
    detections: &[Detection],
    labels: &[Label],
    least_overlap: f64,
) -> Vec<Outcome> {
    let mut order: Vec<usize> = (0..detections.len()).collect();
    order.sort_by(|&a, &b| rank(detections[b].score).total_cmp(&rank(detections[a].score)));
    let mut taken = vec![false; labels.len()];
    let mut outcomes = vec![Outcome::Further; detections.len()];
    for index in order {
        let d = &detections[index];
        let edges = [d.x_min, d.y_min, d.x_max, d.y_max];
        let best = |counting: bool| {
            let free = labels.iter().enumerate().filter(|&(l, label)| {
                let open = !taken[l] || label.kind == LabelKind::Crowd;
                label.counts() == counting && open
            });
            let overlaps = free.map(|(l, label)| (l, label.overlap(edges)));
            overlaps
                .filter(|&(_, overlap)| overlap >= least_overlap)
                .max_by(|a, b| a.1.total_cmp(&b.1))
        };
        if let Some((label, overlap)) = best(true) {
            taken[label] = true;
            outcomes[index] = Outcome::Hit { label, overlap };
        } else if let Some((label, _)) = best(false) {
            taken[label] = true;
            outcomes[index] = Outcome::Ignored;
        }
    }
    outcomes
}

/// A score that can be ordered: what is not finite comes last.
pub(super) fn rank(score: f64) -> f64 {
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

    fn label(x: f64, kind: LabelKind) -> Label {
        Label {
            edges: [x, 0.0, x + 10.0, 10.0],
            kind,
        }
    }

    fn hits(outcomes: &[Outcome]) -> Vec<Option<usize>> {
        let hit = |outcome: &Outcome| match outcome {
            Outcome::Hit { label, .. } => Some(*label),
            _ => None,
        };
        outcomes.iter().map(hit).collect()
    }

    #[test]
    fn the_surest_detection_chooses_first_and_each_label_is_found_once() {
        let labels = [label(0.0, LabelKind::Object)];
        let detections = [detection(0.5, 0.0), detection(0.9, 2.0)];
        let outcomes = match_detections(&detections, &labels, 0.5);
        assert_eq!(outcomes[0], Outcome::Further);
        // 8 · 10 common of 12 · 10 covered.
        assert_eq!(
            outcomes[1],
            Outcome::Hit {
                label: 0,
                overlap: 80.0 / 120.0
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
            assert_eq!(outcomes[1..], [Outcome::Ignored, Outcome::Further]);
        }
    }

    #[test]
    fn a_crowd_takes_many_and_a_difficult_label_one() {
        let wide = |kind| Label {
            edges: [0.0, 0.0, 100.0, 10.0],
            kind,
        };
        let detections = [detection(0.9, 0.0), detection(0.8, 50.0)];
        let crowd = match_detections(&detections, &[wide(LabelKind::Crowd)], 0.5);
        assert_eq!(crowd, [Outcome::Ignored; 2]);
        let twice = [detection(0.9, 0.0), detection(0.8, 0.0)];
        let difficult = match_detections(&twice, &[label(0.0, LabelKind::Difficult)], 0.5);
        assert_eq!(difficult, [Outcome::Ignored, Outcome::Further]);
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
    fn by_the_book(detections: &[Detection], labels: &[Label], least: f64) -> Vec<Option<usize>> {
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
                let overlap = labels[l].overlap(edges);
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
                    (Outcome::Hit { label, .. }, Some(l)) => prop_assert_eq!(*label, l),
                    (Outcome::Ignored, Some(l)) => prop_assert!(!labels[l].counts()),
                    (Outcome::Further, None) => {}
                    other => prop_assert!(false, "{:?}", other),
                }
            }
        }
    }
}
