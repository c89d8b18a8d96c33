use super::bootstrap::{Drawable, Draws};
use super::curve::Curve;
use super::dataset::{DetectionDataset, LabelledImage};
use super::outcome::ImageOutcome;
use super::result::{
    AtThreshold, DETECTION_SCHEMA, DatasetRecord, DetectionDifference, DetectionEvaluation,
    DetectionResult, SizeRecall, WorstImage,
};
use super::sizes::{COCO_SIZES, FINE_SIZES, SizeClass};
use crate::statistics::RESAMPLES;
use crate::{EvaluateError, Share};
use pomona_cloud::ColorImage;
use pomona_detect::{Detection, Detector};
use rayon::prelude::*;

/// Worst images that a result names at most.
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

/// How to evaluate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetectionSettings {
    /// Score at which recall, precision and further detections are counted, 0 to 1.
    pub threshold: f64,
    /// Seed of the bootstrap.
    pub seed: u64,
}

/// Measures every source on every image of `dataset`, images in parallel.
///
/// `done` is called once for each image, from any thread. The outcome depends on data set, sources and settings
/// alone, whatever the number of threads. Beside the evaluation stands, for each source, what came out on each image.
///
/// # Errors
///
/// The first image that cannot be read or detected in.
pub fn evaluate_detections(
    dataset: &DetectionDataset,
    sources: &[DetectionSource<'_>],
    settings: &DetectionSettings,
    done: &(dyn Fn() + Sync),
) -> Result<(DetectionEvaluation, Vec<Vec<ImageOutcome>>), EvaluateError> {
    let by_image: Vec<Vec<ImageOutcome>> = dataset
        .images
        .par_iter()
        .enumerate()
        .map(|(number, image)| {
            let outcomes = outcomes(image, number, sources);
            done();
            outcomes
        })
        .collect::<Result<_, _>>()?;
    let mut by_source: Vec<Vec<ImageOutcome>> = sources.iter().map(|_| Vec::new()).collect();
    for outcomes in by_image {
        for (of_source, outcome) in by_source.iter_mut().zip(outcomes) {
            of_source.push(outcome);
        }
    }
    let drawable: Vec<Drawable> = by_source
        .iter()
        .map(|images| Drawable::new(images, settings.threshold))
        .collect();
    let draws = Draws::new(&drawable, settings.seed);
    let results = sources
        .iter()
        .enumerate()
        .map(|(s, source)| {
            result(
                dataset,
                source,
                &by_source[s],
                (s, draws.as_ref()),
                settings,
            )
        })
        .collect();
    let evaluation = DetectionEvaluation {
        schema: DETECTION_SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        dataset: record(dataset),
        seed: settings.seed,
        resamples: RESAMPLES,
        threshold: settings.threshold,
        results,
        differences: draws.map_or_else(Vec::new, |draws| differences(sources, &draws)),
    };
    Ok((evaluation, by_source))
}

/// What each source says of one image.
fn outcomes(
    image: &LabelledImage,
    number: usize,
    sources: &[DetectionSource<'_>],
) -> Result<Vec<ImageOutcome>, EvaluateError> {
    let needed = sources
        .iter()
        .any(|s| matches!(s, DetectionSource::Detector { .. }));
    let pixels = needed.then(|| ColorImage::read(&image.path)).transpose()?;
    sources
        .iter()
        .map(|source| {
            let detections = match (source, &pixels) {
                (DetectionSource::Detector { detector, .. }, Some(pixels)) => detector
                    .detect(pixels)
                    .map_err(|source| EvaluateError::Detection {
                        image: image.path.clone(),
                        source,
                    })?,
                (DetectionSource::Boxes { detections, .. }, _) => {
                    detections.get(number).cloned().unwrap_or_default()
                }
                // The pixels are there wherever a detector is.
                (DetectionSource::Detector { .. }, None) => Vec::new(),
            };
            Ok(ImageOutcome::new(&image.labels, detections))
        })
        .collect()
}

fn record(dataset: &DetectionDataset) -> DatasetRecord {
    let counts = |image: &LabelledImage| {
        image
            .labels
            .iter()
            .filter(|l| l.kind == pomona_cloud::LabelKind::Object)
            .count()
    };
    let labels: usize = dataset.images.iter().map(counts).sum();
    let all: usize = dataset.images.iter().map(|image| image.labels.len()).sum();
    DatasetRecord {
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
    dataset: &DetectionDataset,
    source: &DetectionSource<'_>,
    images: &[ImageOutcome],
    (number, draws): (usize, Option<&Draws>),
    settings: &DetectionSettings,
) -> DetectionResult {
    let threshold = settings.threshold;
    let estimate = |figure| draws.map(|draws| draws.estimate(number, figure));
    DetectionResult {
        name: source.name().to_owned(),
        detector: match source {
            DetectionSource::Detector { detector, .. } => Some(detector.report()),
            DetectionSource::Boxes { .. } => None,
        },
        detections: images.iter().map(|image| image.detections.len()).sum(),
        ap50: estimate(0),
        ap50_95: estimate(1),
        f1: estimate(2),
        recall: estimate(3),
        precision: estimate(4),
        at_threshold: at_threshold(images, threshold),
        by_size: by_size(images, &COCO_SIZES, threshold),
        by_fine_size: by_size(images, &FINE_SIZES, threshold),
        curve: Curve::of(images),
        worst: worst(dataset, images, threshold),
    }
}

fn at_threshold(images: &[ImageOutcome], threshold: f64) -> AtThreshold {
    let overlaps: Vec<f64> = images
        .iter()
        .flat_map(|image| image.found(threshold).into_iter().flatten())
        .collect();
    let (found, further) = (
        overlaps.len(),
        images
            .iter()
            .map(|image| image.further(threshold).len())
            .sum::<usize>(),
    );
    let labels: usize = images.iter().map(ImageOutcome::label_count).sum();
    AtThreshold {
        found,
        missed: labels - found,
        further,
        further_per_image: further as f64 / images.len().max(1) as f64,
        mean_iou: (found > 0).then(|| overlaps.iter().sum::<f64>() / found as f64),
    }
}

fn by_size(images: &[ImageOutcome], classes: &[SizeClass], threshold: f64) -> Vec<SizeRecall> {
    let share = |class: &SizeClass, threshold: f64| {
        let (mut found, mut of) = (0, 0);
        for image in images {
            for (label, overlap) in image.labels.iter().zip(image.found(threshold)) {
                if label.counts() && class.holds(label.area()) {
                    of += 1;
                    found += usize::from(overlap.is_some());
                }
            }
        }
        Share::new(found, of)
    };
    let recall = |class: &SizeClass| SizeRecall {
        size: *class,
        at_threshold: share(class, threshold),
        at_any_score: share(class, f64::NEG_INFINITY),
    };
    classes.iter().map(recall).collect()
}

fn worst(dataset: &DetectionDataset, images: &[ImageOutcome], threshold: f64) -> Vec<WorstImage> {
    let mut all: Vec<WorstImage> = dataset
        .images
        .iter()
        .zip(images)
        .map(|(image, outcome)| WorstImage {
            image: image.name.clone(),
            found: outcome.hits(threshold).len(),
            missed: outcome.missed(threshold).len(),
            further: outcome.further(threshold).len(),
        })
        .filter(|image| image.missed + image.further > 0)
        .collect();
    all.sort_by_key(|image| std::cmp::Reverse(image.missed + image.further));
    all.truncate(WORST);
    all
}

fn differences(sources: &[DetectionSource<'_>], draws: &Draws) -> Vec<DetectionDifference> {
    let mut differences = Vec::new();
    for (first, a) in sources.iter().enumerate() {
        for (second, b) in sources.iter().enumerate().skip(first + 1) {
            let difference = |figure| draws.difference(first, second, figure);
            differences.push(DetectionDifference {
                first: a.name().to_owned(),
                second: b.name().to_owned(),
                ap50: difference(0),
                ap50_95: difference(1),
                f1: difference(2),
                recall: difference(3),
                precision: difference(4),
            });
        }
    }
    differences
}
