use super::*;
use proptest::prelude::*;

const IMAGE: [usize; 2] = [100, 60];
const LEFT: [usize; 4] = [0, 0, 60, 60];
const RIGHT: [usize; 4] = [40, 0, 100, 60];
const WHOLE: [usize; 4] = [0, 0, 100, 60];

fn seen([x_min, y_min, x_max, y_max]: [f64; 4], score: f64) -> Detection {
    Detection {
        x_min,
        y_min,
        x_max,
        y_max,
        score,
        class: 0,
    }
}

fn view([x0, y0, x1, y1]: [usize; 4], scale: f64, detections: &[Detection]) -> View {
    View {
        window: PixelWindow { x0, y0, x1, y1 },
        scale,
        detections: detections.to_vec(),
    }
}

fn near(found: &Detection, expected: &Detection) -> bool {
    let differences = [
        found.x_min - expected.x_min,
        found.y_min - expected.y_min,
        found.x_max - expected.x_max,
        found.y_max - expected.y_max,
        found.score - expected.score,
    ];
    differences.iter().all(|d| d.abs() < 1e-9)
}

#[test]
fn boxes_weigh_their_score_and_their_resolution() {
    // In the middle of both tiles' common part, so that neither cuts it.
    let left = seen([46.0, 20.0, 54.0, 30.0], 0.9);
    let right = seen([47.0, 20.0, 55.0, 32.0], 0.3);
    let whole = seen([46.0, 16.0, 54.0, 32.0], 0.6);
    let views = [
        view(LEFT, 1.0, &[left]),
        view(RIGHT, 1.0, &[right]),
        view(WHOLE, 0.5, &[whole]),
    ];
    let fused = fuse(&views, IMAGE, 0.45);
    let total = 0.9 + 0.3 + 0.15;
    let mean = |a: f64, b: f64, c: f64| (0.9 * a + 0.3 * b + 0.15 * c) / total;
    let expected = seen(
        [
            mean(46.0, 47.0, 46.0),
            mean(20.0, 20.0, 16.0),
            mean(54.0, 55.0, 54.0),
            mean(30.0, 32.0, 32.0),
        ],
        0.9,
    );
    assert_eq!(fused.len(), 1, "{fused:?}");
    assert!(near(&fused[0], &expected), "{fused:?} {expected:?}");
}

#[test]
fn a_cut_box_does_not_spoil_a_whole_one() {
    // An apple from 45 to 65: the left tile shows three quarters of it, and is surer of it.
    let apple = seen([45.0, 20.0, 65.0, 40.0], 0.5);
    let part = seen([45.5, 19.0, 59.5, 41.0], 0.8);
    let views = [view(LEFT, 1.0, &[part]), view(RIGHT, 1.0, &[apple])];
    let fused = fuse(&views, IMAGE, 0.45);
    assert_eq!(fused.len(), 1, "{fused:?}");
    assert!(
        near(
            &fused[0],
            &Detection {
                score: 0.8,
                ..apple
            }
        ),
        "{fused:?}"
    );

    // A sliver of it, which has hardly any IoU with it, goes too.
    let apple = seen([55.0, 20.0, 75.0, 40.0], 0.5);
    let sliver = seen([55.0, 22.0, 60.0, 38.0], 0.4);
    let views = [view(LEFT, 1.0, &[sliver]), view(RIGHT, 1.0, &[apple])];
    assert_eq!(fuse(&views, IMAGE, 0.45), [apple]);

    // A large one, which only the whole image shows whole.
    let apple = seen([20.0, 5.0, 80.0, 55.0], 0.5);
    let parts = [
        view(LEFT, 1.0, &[seen([21.0, 6.0, 60.0, 54.0], 0.7)]),
        view(RIGHT, 1.0, &[seen([40.0, 6.0, 79.0, 54.0], 0.3)]),
        view(WHOLE, 0.4, &[apple]),
    ];
    assert_eq!(
        fuse(&parts, IMAGE, 0.45),
        [Detection {
            score: 0.7,
            ..apple
        }]
    );
}

#[test]
fn a_fragment_inside_a_larger_box_goes_though_it_ends_before_the_border() {
    // The left tile shows three quarters of an apple, and its box ends eight pixels before the tile does.
    let apple = seen([35.0, 10.0, 75.0, 50.0], 0.6);
    let fragment = seen([36.0, 20.0, 50.0, 40.0], 0.9);
    let views = [view(LEFT, 1.0, &[fragment]), view(WHOLE, 1.0, &[apple])];
    assert_eq!(fuse(&views, IMAGE, 0.45), [apple]);
    // A small apple before a large one: whoever shows the large one shows it too.
    let views = [
        view(LEFT, 1.0, &[fragment]),
        view(WHOLE, 1.0, &[apple, fragment]),
    ];
    assert_eq!(fuse(&views, IMAGE, 0.45).len(), 2);
    // And one in a tile that shows the large one to its end.
    let inner = seen([66.0, 20.0, 74.0, 40.0], 0.9);
    let large = seen([62.0, 10.0, 98.0, 50.0], 0.6);
    let views = [view(RIGHT, 1.0, &[inner]), view(WHOLE, 1.0, &[large])];
    assert_eq!(fuse(&views, IMAGE, 0.45).len(), 2);
}

#[test]
fn parts_without_a_whole_are_joined() {
    let parts = [
        view(LEFT, 1.0, &[seen([21.0, 6.0, 60.0, 54.0], 0.7)]),
        view(RIGHT, 1.0, &[seen([40.0, 5.0, 79.0, 54.0], 0.3)]),
    ];
    assert_eq!(
        fuse(&parts, IMAGE, 0.45),
        [seen([21.0, 5.0, 79.0, 54.0], 0.7)]
    );
}

#[test]
fn an_apple_before_a_cut_one_stays() {
    let small = seen([44.0, 20.0, 52.0, 28.0], 0.9);
    let large = seen([10.0, 5.0, 60.0, 55.0], 0.5);
    let fused = fuse(&[view(LEFT, 1.0, &[large, small])], IMAGE, 0.45);
    assert_eq!(fused, [small, large]);
}

#[test]
fn the_image_s_own_edge_cuts_nothing() {
    let apple = seen([0.0, 0.0, 8.0, 8.0], 0.5);
    let views = [view(LEFT, 1.0, &[apple]), view(WHOLE, 0.5, &[apple])];
    assert_eq!(fuse(&views, IMAGE, 0.45), [apple]);
}

#[test]
fn nonsense_goes() {
    let views = [
        view(LEFT, 0.0, &[seen([10.0, 10.0, 20.0, 20.0], 0.5); 2]),
        view(WHOLE, f64::NAN, &[seen([f64::NAN, 0.0, 1.0, 1.0], 0.5)]),
        view([9, 9, 3, 3], 1.0, &[seen([0.0, 0.0, 1e300, 1e300], 0.0)]),
    ];
    for found in fuse(&views, IMAGE, 0.45) {
        assert!(is_box(&found), "{found:?}");
    }
    assert!(fuse(&[], IMAGE, 0.45).is_empty());
}

/// Section 3 of the paper over every pair, with our weights: what whole boxes become.
fn oracle(mut boxes: Vec<(Detection, f64)>, nms_iou: f64) -> Vec<Detection> {
    boxes.sort_by(|a, b| best_first(&a.0, &b.0).then_with(|| b.1.total_cmp(&a.1)));
    let mut clusters: Vec<Vec<(Detection, f64)>> = Vec::new();
    let mean = |members: &[(Detection, f64)]| {
        let weight = |m: &(Detection, f64)| m.0.score.max(1e-6) * m.1 * m.1;
        let total: f64 = members.iter().map(weight).sum();
        let of = |edge: fn(&Detection) -> f64| -> f64 {
            members.iter().map(|m| weight(m) * edge(&m.0)).sum::<f64>() / total
        };
        Detection {
            x_min: of(|d| d.x_min),
            y_min: of(|d| d.y_min),
            x_max: of(|d| d.x_max),
            y_max: of(|d| d.y_max),
            ..members[0].0
        }
    };
    for one in boxes {
        let mut best: Option<(f64, usize)> = None;
        for (k, cluster) in clusters.iter().enumerate() {
            let iou = mean(cluster).iou(&one.0);
            let same = cluster[0].0.class == one.0.class;
            if same && iou > nms_iou && best.is_none_or(|(most, _)| iou > most) {
                best = Some((iou, k));
            }
        }
        match best {
            Some((_, k)) => clusters[k].push(one),
            None => clusters.push(vec![one]),
        }
    }
    let mut fused: Vec<Detection> = clusters.iter().map(|members| mean(members)).collect();
    suppress(&mut fused, nms_iou, Scope::PerClass);
    fused
}

fn boxes() -> impl Strategy<Value = Vec<Detection>> {
    let one = (
        0.0..85.0,
        0.0..45.0,
        2.0..30.0,
        2.0..30.0,
        0.0..1.0,
        0..2_usize,
    );
    prop::collection::vec(one, 0..25).prop_map(|boxes| {
        let detection = |(x, y, w, h, score, class): (f64, f64, f64, f64, f64, usize)| Detection {
            class,
            ..seen([x, y, (x + w).min(100.0), (y + h).min(60.0)], score)
        };
        boxes.into_iter().map(detection).collect()
    })
}

proptest! {
    #[test]
    fn whole_boxes_become_the_weighted_means_of_the_paper(
        near_boxes in boxes(),
        far_boxes in boxes(),
        nms_iou in 0.1..0.9,
    ) {
        let views = [view(WHOLE, 1.0, &near_boxes), view(WHOLE, 0.5, &far_boxes)];
        let fused = fuse(&views, IMAGE, nms_iou);
        let all = near_boxes.iter().map(|d| (*d, 1.0));
        let expected = oracle(all.chain(far_boxes.iter().map(|d| (*d, 0.5))).collect(), nms_iou);
        prop_assert_eq!(fused.len(), expected.len());
        for (found, expected) in fused.iter().zip(&expected) {
            prop_assert!(near(found, expected), "{:?} {:?}", found, expected);
        }
    }

    #[test]
    fn order_changes_nothing_and_no_two_are_the_same_apple(
        left in boxes(),
        right in boxes(),
        whole in boxes(),
        nms_iou in 0.1..0.9,
    ) {
        let inside = |boxes: &[Detection], window: [usize; 4]| -> Vec<Detection> {
            let window = seen(window.map(|edge| edge as f64), 0.0);
            boxes.iter().map(|d| common(d, &window)).filter(is_box).collect()
        };
        let mut views = vec![
            view(LEFT, 1.0, &inside(&left, LEFT)),
            view(RIGHT, 1.0, &inside(&right, RIGHT)),
            view(WHOLE, 0.5, &whole),
        ];
        let fused = fuse(&views, IMAGE, nms_iou);
        for (k, a) in fused.iter().enumerate() {
            for b in &fused[..k] {
                prop_assert!(a.class != b.class || a.iou(b) <= nms_iou);
                prop_assert!(a.score <= b.score);
            }
        }
        views.reverse();
        for view in &mut views {
            view.detections.reverse();
        }
        prop_assert_eq!(&fused, &fuse(&views, IMAGE, nms_iou));
    }
}
