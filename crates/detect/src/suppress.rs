use crate::detection::Detection;
use std::cmp::Ordering;

/// Between which boxes the better one suppresses the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scope {
    /// Those of one class.
    #[default]
    PerClass,
    /// All.
    AcrossClasses,
}

/// Non-maximum suppression: no two boxes that remain have an `IoU` above `nms_iou`, and each that is removed has one
/// with a better box that remains. They come out best first.
///
/// Which of two boxes of equal score is the better one depends on their class and position, not on the order in which
/// they come. Boxes with a number that is not finite, or without area, are removed. Time grows with the number of boxes
/// times those that overlap along x.
pub fn suppress(detections: &mut Vec<Detection>, nms_iou: f64, scope: Scope) {
    detections.retain(is_box);
    detections.sort_by(best_first);
    let widest = widest(detections);
    let mut by_x: Vec<usize> = (0..detections.len()).collect();
    by_x.sort_by(|&a, &b| detections[a].x_min.total_cmp(&detections[b].x_min));
    let mut alive = vec![true; detections.len()];
    for best in 0..detections.len() {
        if !alive[best] {
            continue;
        }
        let kept = &detections[best];
        // Whatever touches it begins right of here, and left of its right edge.
        let begin = by_x.partition_point(|&k| detections[k].x_min < kept.x_min - widest);
        for &other in &by_x[begin..] {
            let candidate = &detections[other];
            if candidate.x_min > kept.x_max {
                break;
            }
            let rival = scope == Scope::AcrossClasses || candidate.class == kept.class;
            if other > best && rival && kept.iou(candidate) > nms_iou {
                alive[other] = false;
            }
        }
    }
    let mut alive = alive.into_iter();
    detections.retain(|_| alive.next() == Some(true));
}

/// Whether a box has an area and nothing but numbers.
pub(crate) fn is_box(detection: &Detection) -> bool {
    let Detection {
        x_min,
        y_min,
        x_max,
        y_max,
        score,
        ..
    } = *detection;
    let finite = [x_min, y_min, x_max, y_max, score]
        .iter()
        .all(|x| x.is_finite());
    finite && x_min < x_max && y_min < y_max
}

/// By score, then class and place: a total order of whatever differs.
pub(crate) fn best_first(a: &Detection, b: &Detection) -> Ordering {
    b.score
        .total_cmp(&a.score)
        .then_with(|| a.class.cmp(&b.class))
        .then_with(|| a.x_min.total_cmp(&b.x_min))
        .then_with(|| a.y_min.total_cmp(&b.y_min))
        .then_with(|| a.x_max.total_cmp(&b.x_max))
        .then_with(|| a.y_max.total_cmp(&b.y_max))
}

/// Width of the widest box; 0 where there is none.
pub(crate) fn widest(detections: &[Detection]) -> f64 {
    let widths = detections.iter().map(|d| d.x_max - d.x_min);
    widths.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes(count: usize) -> impl Strategy<Value = Vec<Detection>> {
        let one = (
            0..40_u32,
            0..40_u32,
            1..25_u32,
            1..25_u32,
            0..6_u32,
            0..2_usize,
        );
        prop::collection::vec(one, 0..count).prop_map(|boxes| {
            let detection =
                |(x, y, w, h, score, class): (u32, u32, u32, u32, u32, usize)| Detection {
                    x_min: f64::from(x),
                    y_min: f64::from(y),
                    x_max: f64::from(x + w),
                    y_max: f64::from(y + h),
                    score: f64::from(score) / 5.0,
                    class,
                };
            boxes.into_iter().map(detection).collect()
        })
    }

    /// Every pair, as the definition has it.
    fn oracle(mut boxes: Vec<Detection>, nms_iou: f64, scope: Scope) -> Vec<Detection> {
        boxes.sort_by(best_first);
        let mut kept: Vec<Detection> = Vec::new();
        for candidate in boxes {
            let beaten = kept.iter().any(|k| {
                (scope == Scope::AcrossClasses || k.class == candidate.class)
                    && k.iou(&candidate) > nms_iou
            });
            if !beaten {
                kept.push(candidate);
            }
        }
        kept
    }

    proptest! {
        #[test]
        fn as_by_trying_every_pair(
            boxes in boxes(60),
            nms_iou in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0],
            across in any::<bool>(),
            turn in 0..60_usize,
        ) {
            let scope = if across { Scope::AcrossClasses } else { Scope::PerClass };
            let mut ours = boxes.clone();
            suppress(&mut ours, nms_iou, scope);
            prop_assert_eq!(&ours, &oracle(boxes.clone(), nms_iou, scope));
            // The order in which they come says nothing.
            let mut turned = boxes;
            let middle = turn.min(turned.len());
            turned.rotate_left(middle);
            suppress(&mut turned, nms_iou, scope);
            prop_assert_eq!(&ours, &turned);
        }
    }

    #[test]
    fn what_is_no_box_goes() {
        let fine = Detection {
            x_min: 0.0,
            y_min: 0.0,
            x_max: 1.0,
            y_max: 1.0,
            score: 0.5,
            class: 0,
        };
        let mut boxes = vec![
            Detection {
                x_max: f64::INFINITY,
                ..fine
            },
            Detection {
                score: f64::NAN,
                ..fine
            },
            Detection {
                x_max: -1.0,
                ..fine
            },
            fine,
        ];
        suppress(&mut boxes, 0.5, Scope::PerClass);
        assert_eq!(boxes, [fine]);
    }
}
