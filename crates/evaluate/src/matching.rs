use pomona::AppleAnswer;
use pomona_cloud::PixelBox;
use pomona_scenes::AppleTruth;

/// Least overlap of two boxes that are of the same apple, as intersection over union.
///
/// The usual threshold of detection benchmarks (PASCAL VOC; Everingham et al. 2010).
const SAME_APPLE_IOU: f64 = 0.5;

/// For each apple of the truth the index of its answer, each answer used once.
///
/// An answer whose box bears the apple's name and overlaps it at all is taken first: names repeat in
/// detectors' output, where each may be `apple`. The rest are joined by overlap, best first.
pub(crate) fn match_answers(truth: &[AppleTruth], answers: &[AppleAnswer]) -> Vec<Option<usize>> {
    let mut matched = vec![None; truth.len()];
    let mut used = vec![false; answers.len()];
    let mut pairs = Vec::new();
    for (t, apple) in truth.iter().enumerate() {
        for (p, answer) in answers.iter().enumerate() {
            let overlap = intersection_over_union(&apple.bounds, &answer.bounds);
            let named = apple.bounds.name == answer.bounds.name;
            if overlap >= SAME_APPLE_IOU || (named && overlap > 0.0) {
                pairs.push((named, overlap, t, p));
            }
        }
    }
    pairs.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)));
    for (_, _, t, p) in pairs {
        if matched[t].is_none() && !used[p] {
            matched[t] = Some(p);
            used[p] = true;
        }
    }
    matched
}

fn intersection_over_union(a: &PixelBox, b: &PixelBox) -> f64 {
    let width = (a.x_max.min(b.x_max) - a.x_min.max(b.x_min)).max(0.0);
    let height = (a.y_max.min(b.y_max) - a.y_min.max(b.y_min)).max(0.0);
    let both = width * height;
    let either = a.width() * a.height() + b.width() * b.height() - both;
    if either > 0.0 { both / either } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona::Status;

    fn bounds(name: &str, x: f64) -> PixelBox {
        PixelBox {
            name: name.into(),
            x_min: x,
            y_min: 0.0,
            x_max: x + 10.0,
            y_max: 10.0,
            score: 1.0,
        }
    }

    fn apple(name: &str, x: f64) -> AppleTruth {
        serde_json::from_value(serde_json::json!({
            "box": bounds(name, x), "center": [0.0, 0.0, 1.0], "radius": 0.04
        }))
        .unwrap()
    }

    fn answer(id: usize, name: &str, x: f64) -> AppleAnswer {
        AppleAnswer::new(id, bounds(name, x), Status::NoDepth)
    }

    #[test]
    fn names_lead_in_any_order() {
        let truth = [apple("a", 0.0), apple("b", 3.0)];
        assert_eq!(
            match_answers(&truth, &[answer(0, "b", 0.0), answer(1, "a", 3.0)]),
            [Some(1), Some(0)]
        );
    }

    #[test]
    fn without_names_the_overlap_decides_and_each_pick_counts_once() {
        let truth = [apple("0", 0.0), apple("1", 20.0), apple("2", 1.0)];
        let answers = [
            answer(0, "apple", 19.0),
            answer(1, "apple", 0.5),
            answer(2, "apple", 60.0),
        ];
        let matched = match_answers(&truth, &answers);
        assert_eq!(matched[1], Some(0));
        assert_eq!((matched[0], matched[2]), (Some(1), None));
    }

    #[test]
    fn a_name_alone_without_overlap_is_another_apple() {
        assert_eq!(
            match_answers(&[apple("a", 0.0)], &[answer(0, "a", 50.0)]),
            [None]
        );
    }
}
