use super::curve::Curve;
use super::figures::{FIGURES, Figure, RankedSource};
use super::matched_image::MatchedImage;
use super::result::{
    AtThreshold, DETECTION_SCHEMA, DatasetSummary, DetectionDifference, DetectionEvaluation,
    DetectionResult, SizeRecall, WorstImage,
};
use super::sizes::{COCO_SIZES, FINE_SIZES, SizeClass};
use crate::dataset::{LabelledDataset, LabelledImage};
use crate::error::LabelsError;
use crate::resampling::Resampled;
use pomona_cloud::{ColorImage, LabelKind};
use pomona_detect::{DetectError, Detection, Detector};
use pomona_statistics::{Proportion, RESAMPLES};
use rayon::prelude::*;

/// Most images that a result names as the worst.
const WORST: usize = 12;

/// Where detections come from.
pub enum DetectionSource<'a> {
    /// A detector, run on every image.
    Detector {
        /// Its name in the evaluation.
        name: String,
        /// The detector. It should be opened with a low threshold: average precision needs unsure detections too.
        detector: &'a dyn Detector,
    },
    /// Boxes that another program found.
    Boxes {
        /// Their name in the evaluation.
        name: String,
        /// The detections of each image of the data set, in its order.
        detections: Vec<Vec<Detection>>,
    },
}

impl DetectionSource<'_> {
    fn name(&self) -> &str {
        match self {
            Self::Detector { name, .. } | Self::Boxes { name, .. } => name,
        }
    }
}

/// How detectors are evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DetectionOptions {
    /// Score threshold at which recall, precision and false positives are counted, 0 to 1.
    pub threshold: f64,
    /// Seed of the bootstrap.
    pub seed: u64,
}

impl DetectionOptions {
    /// This threshold and this seed.
    pub const fn new(threshold: f64, seed: u64) -> Self {
        Self { threshold, seed }
    }
}

/// Measures every source on every image of `dataset`, images in parallel.
///
/// `done` is called once for each image, from any thread. The result depends on data set, sources and options
/// alone, whatever the number of threads. The second part of it holds, for each source, the matches in each image.
///
/// # Errors
///
/// The first image that cannot be read or detected in.
pub fn evaluate_detections(
    dataset: &LabelledDataset,
    sources: &[DetectionSource<'_>],
    options: &DetectionOptions,
    done: &(dyn Fn() + Sync),
) -> Result<(DetectionEvaluation, Vec<Vec<MatchedImage>>), LabelsError> {
    let by_image: Vec<Vec<MatchedImage>> = dataset
        .images
        .par_iter()
        .enumerate()
        .map(|(number, image)| {
            let matched = matched(image, number, sources, options.threshold);
            done();
            matched
        })
        .collect::<Result<_, _>>()?;
    let mut by_source: Vec<Vec<MatchedImage>> = sources.iter().map(|_| Vec::new()).collect();
    for of_image in by_image {
        for (of_source, matched) in by_source.iter_mut().zip(of_image) {
            of_source.push(matched);
        }
    }
    let ranked: Vec<RankedSource> = by_source
        .iter()
        .map(|images| RankedSource::new(images, options.threshold))
        .collect();
    let resampled = Resampled::new(
        &ranked,
        dataset.images.len(),
        options.seed,
        RankedSource::figures,
    );
    let results = sources
        .iter()
        .enumerate()
        .map(|(s, source)| {
            result(
                dataset,
                source,
                &by_source[s],
                (s, resampled.as_ref()),
                options,
            )
        })
        .collect();
    let evaluation = DetectionEvaluation {
        schema: DETECTION_SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        dataset: summary(dataset),
        seed: options.seed,
        resamples: RESAMPLES,
        threshold: options.threshold,
        results,
        differences: resampled.map_or_else(Vec::new, |resampled| differences(sources, &resampled)),
    };
    Ok((evaluation, by_source))
}

/// The detections of each source in one image, matched.
fn matched(
    image: &LabelledImage,
    number: usize,
    sources: &[DetectionSource<'_>],
    threshold: f64,
) -> Result<Vec<MatchedImage>, LabelsError> {
    let needed = sources
        .iter()
        .any(|s| matches!(s, DetectionSource::Detector { .. }));
    let pixels = needed.then(|| ColorImage::read(&image.path)).transpose()?;
    sources
        .iter()
        .map(|source| {
            let detections = match (source, &pixels) {
                (DetectionSource::Detector { detector, .. }, Some(pixels)) => {
                    detected(*detector, pixels, threshold).map_err(|source| {
                        LabelsError::Detection {
                            image: image.path.clone(),
                            source,
                        }
                    })?
                }
                (DetectionSource::Boxes { detections, .. }, _) => {
                    detections.get(number).cloned().unwrap_or_default()
                }
                // The pixels are there wherever a detector is.
                (DetectionSource::Detector { .. }, None) => Vec::new(),
            };
            Ok(MatchedImage::new(&image.boxes, detections))
        })
        .collect()
}

/// What the detector gives at the threshold, as whoever uses it at that threshold has it, and behind that its boxes of
/// lower scores, for the rest of the curve.
fn detected(
    detector: &dyn Detector,
    pixels: &ColorImage,
    threshold: f64,
) -> Result<Vec<Detection>, DetectError> {
    let mut found = detector.detect_at(pixels, &[threshold, 0.0])?.into_iter();
    let mut detections = found.next().unwrap_or_default();
    let unsure = found.next().unwrap_or_default().into_iter();
    detections.extend(unsure.filter(|d| d.score < threshold));
    Ok(detections)
}

fn summary(dataset: &LabelledDataset) -> DatasetSummary {
    let counts = |image: &LabelledImage| {
        image
            .boxes
            .iter()
            .filter(|l| l.kind == LabelKind::Object)
            .count()
    };
    let labels: usize = dataset.images.iter().map(counts).sum();
    let all: usize = dataset.images.iter().map(|image| image.boxes.len()).sum();
    DatasetSummary {
        name: dataset.name.clone(),
        form: dataset.form,
        images: dataset.images.len(),
        background_images: dataset
            .images
            .iter()
            .filter(|image| counts(image) == 0)
            .count(),
        images_without_label_file: dataset.without_label_file,
        labels,
        ignored_labels: all - labels,
    }
}

fn result(
    dataset: &LabelledDataset,
    source: &DetectionSource<'_>,
    images: &[MatchedImage],
    (number, resampled): (usize, Option<&Resampled<FIGURES>>),
    options: &DetectionOptions,
) -> DetectionResult {
    let threshold = options.threshold;
    let estimate =
        |figure: Figure| resampled.map(|resampled| resampled.estimate(number, figure as usize));
    DetectionResult {
        name: source.name().to_owned(),
        detector: match source {
            DetectionSource::Detector { detector, .. } => Some(detector.report()),
            DetectionSource::Boxes { .. } => None,
        },
        detections: images.iter().map(|image| image.detections.len()).sum(),
        ap50: estimate(Figure::Ap50),
        ap50_95: estimate(Figure::Ap50To95),
        f1: estimate(Figure::F1),
        recall: estimate(Figure::Recall),
        precision: estimate(Figure::Precision),
        at_threshold: at_threshold(images, threshold),
        by_size: by_size(images, &COCO_SIZES, threshold),
        by_fine_size: by_size(images, &FINE_SIZES, threshold),
        curve: Curve::of(images),
        worst: worst(dataset, images, threshold),
    }
}

fn at_threshold(images: &[MatchedImage], threshold: f64) -> AtThreshold {
    let ious: Vec<f64> = images
        .iter()
        .flat_map(|image| image.found(threshold).into_iter().flatten())
        .collect();
    let (found, false_positives) = (
        ious.len(),
        images
            .iter()
            .map(|image| image.false_positives(threshold).len())
            .sum::<usize>(),
    );
    let labels: usize = images.iter().map(MatchedImage::label_count).sum();
    AtThreshold {
        found,
        missed: labels - found,
        false_positives,
        false_positives_per_image: false_positives as f64 / images.len().max(1) as f64,
        mean_iou: (found > 0).then(|| ious.iter().sum::<f64>() / found as f64),
    }
}

fn by_size(images: &[MatchedImage], classes: &[SizeClass], threshold: f64) -> Vec<SizeRecall> {
    let share = |class: &SizeClass, threshold: f64| {
        let (mut found, mut of) = (0, 0);
        for image in images {
            for (label, iou) in image.labels.iter().zip(image.found(threshold)) {
                if label.counts() && class.holds(label.area()) {
                    of += 1;
                    found += usize::from(iou.is_some());
                }
            }
        }
        Proportion::new(found, of)
    };
    let recall = |class: &SizeClass| SizeRecall {
        size: *class,
        at_threshold: share(class, threshold),
        at_any_score: share(class, f64::NEG_INFINITY),
    };
    classes.iter().map(recall).collect()
}

fn worst(dataset: &LabelledDataset, images: &[MatchedImage], threshold: f64) -> Vec<WorstImage> {
    let mut all: Vec<WorstImage> = dataset
        .images
        .iter()
        .zip(images)
        .map(|(image, matched)| WorstImage {
            image: image.name.clone(),
            found: matched.true_positives(threshold).len(),
            missed: matched.missed(threshold).len(),
            false_positives: matched.false_positives(threshold).len(),
        })
        .filter(|image| image.missed + image.false_positives > 0)
        .collect();
    all.sort_by_key(|image| std::cmp::Reverse(image.missed + image.false_positives));
    all.truncate(WORST);
    all
}

fn differences(
    sources: &[DetectionSource<'_>],
    resampled: &Resampled<FIGURES>,
) -> Vec<DetectionDifference> {
    let mut differences = Vec::new();
    for (first, a) in sources.iter().enumerate() {
        for (second, b) in sources.iter().enumerate().skip(first + 1) {
            let difference = |figure: Figure| resampled.difference(first, second, figure as usize);
            differences.push(DetectionDifference {
                first: a.name().to_owned(),
                second: b.name().to_owned(),
                ap50: difference(Figure::Ap50),
                ap50_95: difference(Figure::Ap50To95),
                f1: difference(Figure::F1),
                recall: difference(Figure::Recall),
                precision: difference(Figure::Precision),
            });
        }
    }
    differences
}
