use super::matched_image::MatchedImage;
use super::matching::IOU_THRESHOLDS;
use super::ranked::{Steps, ranked};
use serde::{Deserialize, Serialize};

/// Most points of a stored curve: more than a plot can show.
const MOST_POINTS: usize = 400;

/// Precision over recall at an intersection over union of 0.5, and the areas under such curves.
///
/// Average precision is given twice: with **all points** of the curve (PASCAL VOC from 2010 on), and with COCO's
/// **101 points**. Both take at each recall the best precision at that recall or beyond.
///
/// ```
/// use pomona_cloud::{LabelledBox, PixelBox};
/// use pomona_detect::Detection;
/// use pomona_labels::{Curve, MatchedImage};
///
/// let pixel_box = |x: f64| {
///     PixelBox { name: "1".into(), x_min: x, y_min: 0.0, x_max: x + 10.0, y_max: 10.0, score: 1.0 }
/// };
/// let seen = |x: f64, score| Detection { x_min: x, y_min: 0.0, x_max: x + 10.0, y_max: 10.0, score, class: 0 };
/// let labels = [LabelledBox::new(pixel_box(0.0)), LabelledBox::new(pixel_box(50.0))];
///
/// // One apple found, something else taken for one, the other apple found.
/// let image = MatchedImage::new(&labels, vec![seen(0.0, 0.9), seen(20.0, 0.8), seen(50.0, 0.7)]);
/// let curve = Curve::of(&[image]).unwrap();
///
/// assert!((curve.ap50 - (0.5 * 1.0 + 0.5 * 2.0 / 3.0)).abs() < 1e-12);
/// assert_eq!(curve.best_f1.unwrap().score, 0.7);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(
    test,
    derive(schemars::JsonSchema),
    schemars(
        deny_unknown_fields,
        description = "Precision over recall at an intersection over union of 0.5, and average precision by both rules."
    )
)]
#[non_exhaustive]
pub struct Curve {
    /// Average precision at an intersection over union of 0.5, all points (PASCAL VOC from 2010 on).
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub ap50: f64,
    /// The same, 101 points (COCO).
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub ap50_101: f64,
    /// Mean of the average precisions at 0.50, 0.55, … 0.95, all points.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub ap50_95: f64,
    /// The same, 101 points: COCO's main figure.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub ap50_95_101: f64,
    /// Where F1 is best; `null` in files where nothing was detected.
    #[cfg_attr(test, schemars(with = "pomona_schema::Nullable<BestF1>"))]
    pub best_f1: Option<BestF1>,
    /// The curve at an intersection over union of 0.5 from the best score down, thinned for plots.
    pub points: Vec<CurvePoint>,
}

/// One point of a precision–recall curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct CurvePoint {
    /// Detections of at least this score count.
    pub score: f64,
    /// Share of the labels that they find.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub recall: f64,
    /// Share of them that find a label.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub precision: f64,
}

/// The best F1 of a curve: the harmonic mean of precision and recall.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct BestF1 {
    /// F1.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub f1: f64,
    /// The threshold of the score.
    pub score: f64,
    /// Recall there.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub recall: f64,
    /// Precision there.
    #[cfg_attr(test, schemars(with = "pomona_schema::Share"))]
    pub precision: f64,
    /// False positives there per image.
    #[serde(rename = "further_per_image")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub false_positives_per_image: f64,
}

impl Curve {
    /// The curve over all images; `None` where there is no label to find, so that no recall exists.
    pub fn of(images: &[MatchedImage]) -> Option<Self> {
        let labels: u64 = images.iter().map(|image| image.label_count() as u64).sum();
        if labels == 0 {
            return None;
        }
        let mut first = Steps::default();
        let (mut all_points, mut at_101) =
            ([0.0; IOU_THRESHOLDS.len()], [0.0; IOU_THRESHOLDS.len()]);
        for threshold in (0..IOU_THRESHOLDS.len()).rev() {
            first.fill(&ranked(images, threshold), |_| 1);
            all_points[threshold] = first.all_points(labels);
            at_101[threshold] = first.at_101(labels);
        }
        let mean = |values: [f64; IOU_THRESHOLDS.len()]| {
            values.iter().sum::<f64>() / IOU_THRESHOLDS.len() as f64
        };
        let points: Vec<CurvePoint> = first
            .steps
            .iter()
            .map(|&(score, hits, count)| CurvePoint {
                score,
                recall: hits as f64 / labels as f64,
                precision: hits as f64 / count as f64,
            })
            .collect();
        Some(Self {
            ap50: all_points[0],
            ap50_101: at_101[0],
            ap50_95: mean(all_points),
            ap50_95_101: mean(at_101),
            best_f1: best_f1(&first, labels, images.len()),
            points: thinned(points),
        })
    }
}

/// The best F1, at the highest score that reaches it.
fn best_f1(steps: &Steps, labels: u64, images: usize) -> Option<BestF1> {
    let mut best: Option<BestF1> = None;
    for &(score, hits, count) in &steps.steps {
        let f1 = 2.0 * hits as f64 / (count + labels) as f64;
        if best.is_none_or(|best| f1 > best.f1) {
            best = Some(BestF1 {
                f1,
                score,
                recall: hits as f64 / labels as f64,
                precision: hits as f64 / count as f64,
                false_positives_per_image: (count - hits) as f64 / images as f64,
            });
        }
    }
    best
}

/// Every n-th of the points, the first and the last included.
fn thinned(points: Vec<CurvePoint>) -> Vec<CurvePoint> {
    let stride = points.len().div_ceil(MOST_POINTS - 1).max(1);
    let last = points.len().saturating_sub(1);
    let kept = points.into_iter().enumerate();
    kept.filter(|(at, _)| at % stride == 0 || *at == last)
        .map(|(_, point)| point)
        .collect()
}
