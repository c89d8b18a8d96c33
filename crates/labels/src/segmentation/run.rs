use super::agreement::agreement;
use super::counts::{BINS, LEVELS, PixelCounts, WIDE, WIDTHS, level, reaching};
use super::images::{SegmentationImage, photograph};
use super::result::{
    CalibrationBin, LevelFigures, SEGMENTATION_SCHEMA, SegmentationDifference,
    SegmentationEvaluation, SegmentationResult, StrokeSummary, TruthKind, WidthRecall,
    WorstSegmentation,
};
use super::truth::Truth;
use crate::error::LabelsError;
use crate::resampling::{Estimate, Resampled};
use crate::strokes::{ImageStrokes, Stroke, StrokeClass};
use pomona_cloud::ColorImage;
use pomona_segment::{Role, Segmenter};
use pomona_statistics::RESAMPLES;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Most images that a result names as the worst.
const WORST: usize = 12;

/// Reads the probabilities of wood of an image, row by row, 0 to 1, for its `[width, height]`.
pub type MaskReader<'a> =
    dyn Fn(&SegmentationImage, [usize; 2]) -> Result<Vec<f32>, LabelsError> + Sync + 'a;

/// Where masks come from.
pub enum SegmentationSource<'a> {
    /// A segmenter, run on every image.
    Segmenter {
        /// Its name in the evaluation.
        name: String,
        /// The segmenter.
        segmenter: &'a dyn Segmenter,
    },
    /// Probabilities of wood that another program wrote.
    Masks {
        /// Their name in the evaluation.
        name: String,
        /// Reads those of an image.
        read: &'a MaskReader<'a>,
    },
}

impl SegmentationSource<'_> {
    /// Its name in the evaluation.
    pub fn name(&self) -> &str {
        match self {
            Self::Segmenter { name, .. } | Self::Masks { name, .. } => name,
        }
    }
}

/// How segmenters are evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SegmentationOptions {
    /// Probability of wood from which on a pixel is marked, 0.01 to 0.99 in hundredths; the nearest of these counts.
    pub threshold: f64,
    /// Distance in pixels within which wood is found and a mark is right.
    pub tolerance_px: f64,
    /// Seed of the bootstrap.
    pub seed: u64,
    /// Count only what lies within so many radii of the apples that are boxed in each frame, where only that has been
    /// drawn in; `None` counts the whole image.
    pub apple_radii: Option<f64>,
}

impl SegmentationOptions {
    /// These options over the whole image.
    pub const fn new(threshold: f64, tolerance_px: f64, seed: u64) -> Self {
        Self {
            threshold,
            tolerance_px,
            seed,
            apple_radii: None,
        }
    }
}

/// Figures with intervals, in this order.
const FIGURES: usize = 5;

/// The figures of one source by photograph, each a part of a whole: both add up over photographs.
struct Counted(Vec<[[f64; 2]; FIGURES]>);

impl Counted {
    /// The figure of this number where photograph i counts `weights[i]` times; `None` where there is nothing to count.
    fn figure(&self, number: usize, weights: &[u64]) -> Option<[f64; 1]> {
        let [mut part, mut whole] = [0.0; 2];
        for (shares, &times) in self.0.iter().zip(weights) {
            part += times as f64 * shares[number][0];
            whole += times as f64 * shares[number][1];
        }
        (whole > 0.0).then(|| [part / whole])
    }
}

/// Parts and wholes of recall of wide and of thin wood, precision, intersection over union, share of posts marked.
fn shares(sum: &PixelCounts, threshold: usize) -> [[f64; 2]; FIGURES] {
    let lines = |classes: &[Vec<f64>]| {
        let hit: f64 = classes.iter().map(|lines| reaching(lines, threshold)).sum();
        [hit, classes.iter().flatten().sum()]
    };
    let marked = reaching(&sum.all, threshold) as f64;
    let wood: u64 = sum.wood.iter().sum();
    let common = reaching(&sum.wood, threshold) as f64;
    [
        lines(&sum.lines[WIDE..]),
        lines(&sum.lines[WIDE - 1..WIDE]),
        [reaching(&sum.near, threshold) as f64, marked],
        [common, marked + wood as f64 - common],
        [reaching(&sum.posts, threshold), sum.posts.iter().sum()],
    ]
}

/// Measures every source on every image, images in parallel.
///
/// `done` is called once for each image, from any thread. The result depends on images, sources and options alone,
/// whatever the number of threads. `second` are a second person's strokes of some of the images.
///
/// # Errors
///
/// The first image that cannot be read or segmented, whose strokes lie outside of it, or whose mask cannot be used.
pub fn evaluate_segmentation(
    name: &str,
    images: &[SegmentationImage],
    second: &[ImageStrokes],
    sources: &[SegmentationSource<'_>],
    options: &SegmentationOptions,
    done: &(dyn Fn() + Sync),
) -> Result<SegmentationEvaluation, LabelsError> {
    let counts: Vec<(Vec<PixelCounts>, f64)> = images
        .par_iter()
        .map(|image| {
            let counts = count(image, sources, options);
            done();
            counts
        })
        .collect::<Result<_, _>>()?;
    let (by_image, lengths): (Vec<Vec<PixelCounts>>, Vec<f64>) = counts.into_iter().unzip();
    let mut photographs: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (number, image) in images.iter().enumerate() {
        photographs
            .entry(photograph(&image.name))
            .or_default()
            .push(number);
    }
    let threshold = nearest_level(options.threshold);
    let counted: Vec<Counted> = (0..sources.len())
        .map(|source| {
            let photograph = |numbers: &Vec<usize>| {
                let mut sum = PixelCounts::zero();
                for &number in numbers {
                    sum.add(&by_image[number][source], 1);
                }
                shares(&sum, threshold)
            };
            Counted(photographs.values().map(photograph).collect())
        })
        .collect();
    let resampled = |counted: &[&Counted], figure: usize| {
        let of = |counted: &&Counted, weights: &[u64], (): &mut ()| counted.figure(figure, weights);
        Resampled::new(counted, photographs.len(), options.seed, of)
    };
    let results = sources.iter().enumerate().map(|(s, source)| {
        let of_source: Vec<&PixelCounts> = by_image.iter().map(|counts| &counts[s]).collect();
        let estimate = |figure| Some(resampled(&[&counted[s]], figure)?.estimate(0, 0));
        result(source, images, &of_source, estimate, threshold)
    });
    let difference = |[first, second]: [usize; 2], figure| {
        let pair = resampled(&[&counted[first], &counted[second]], figure)?;
        Some(pair.difference(0, 1, 0))
    };
    let strokes: Vec<ImageStrokes> = images.iter().filter_map(|i| i.strokes().cloned()).collect();
    let mut summary = summary(name, &strokes, photographs.len());
    if images.iter().any(|image| image.strokes().is_none()) {
        summary.truth = TruthKind::Masks;
        summary.images = images.len();
        summary.wood_length_px = lengths.iter().sum();
    }
    Ok(SegmentationEvaluation {
        schema: SEGMENTATION_SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        strokes: summary,
        tolerance_px: options.tolerance_px,
        threshold: marking_threshold(options),
        seed: options.seed,
        resamples: RESAMPLES,
        agreement: agreement(&strokes, second, options.tolerance_px),
        results: results.collect(),
        differences: differences(sources, difference),
    })
}

/// The probability from which on a pixel is marked.
pub(crate) fn marking_threshold(options: &SegmentationOptions) -> f64 {
    level(nearest_level(options.threshold))
}

/// The number of the threshold next to a probability.
fn nearest_level(threshold: f64) -> usize {
    let number = (threshold * (LEVELS + 1) as f64).round() - 1.0;
    number.clamp(0.0, (LEVELS - 1) as f64) as usize
}

/// What each source sees in one image, counted, and the length of the centre lines of wood.
fn count(
    image: &SegmentationImage,
    sources: &[SegmentationSource<'_>],
    options: &SegmentationOptions,
) -> Result<(Vec<PixelCounts>, f64), LabelsError> {
    let tolerance = options.tolerance_px;
    let pixels = ColorImage::read(&image.path)?;
    let size = [pixels.width, pixels.height];
    let truth = Truth::of(image, size, tolerance, options.apple_radii)?;
    let of_source = |source: &SegmentationSource<'_>| {
        let p = match source {
            SegmentationSource::Segmenter { segmenter, .. } => segmenter
                .segment(&pixels)
                .map_err(|source| LabelsError::Segmentation {
                    image: image.path.clone(),
                    source: Box::new(source),
                })?
                .role(Role::Wood),
            SegmentationSource::Masks { read, .. } => read(image, size)?,
        };
        if p.len() != pixels.pixels.len() {
            let problem = format!(
                "{}x{} pixels, and `{}` has {} probabilities",
                size[0],
                size[1],
                source.name(),
                p.len()
            );
            return Err(LabelsError::malformed(
                &image.path,
                &problem,
                "give one for each pixel of the image",
            ));
        }
        Ok(PixelCounts::of(&truth, &p, tolerance))
    };
    let counts: Result<Vec<_>, _> = sources.iter().map(of_source).collect();
    Ok((counts?, truth.wood_length()))
}

fn summary(name: &str, images: &[ImageStrokes], photographs: usize) -> StrokeSummary {
    let of = |class| images.iter().flat_map(move |image| image.of(class));
    StrokeSummary {
        name: name.to_owned(),
        truth: TruthKind::Strokes,
        images: images.len(),
        photographs,
        wood: of(StrokeClass::Wood).count(),
        wood_length_px: of(StrokeClass::Wood).map(Stroke::length).sum(),
        post_length_px: of(StrokeClass::Post).map(Stroke::length).sum(),
    }
}

fn result(
    source: &SegmentationSource<'_>,
    images: &[SegmentationImage],
    counts: &[&PixelCounts],
    estimate: impl Fn(usize) -> Option<Estimate>,
    threshold: usize,
) -> SegmentationResult {
    let mut sum = PixelCounts::zero();
    for counts in counts {
        sum.add(counts, 1);
    }
    let calibration = calibration(&sum);
    SegmentationResult {
        name: source.name().to_owned(),
        segmenter: match source {
            SegmentationSource::Segmenter { segmenter, .. } => Some(segmenter.report()),
            SegmentationSource::Masks { .. } => None,
        },
        recall_wide: estimate(0),
        recall_thin: estimate(1),
        precision: estimate(2),
        iou: estimate(3),
        posts: estimate(4),
        by_width: by_width(&sum, threshold),
        curve: (0..LEVELS)
            .map(|level| level_figures(&sum, level))
            .collect(),
        calibration_error: calibration_error(&calibration),
        calibration,
        worst: worst(images, counts, threshold),
    }
}

fn level_figures(sum: &PixelCounts, number: usize) -> LevelFigures {
    let [recall_wide, recall_thin, precision, _, posts] = shares(sum, number);
    let or = |[part, whole]: [f64; 2], other: f64| if whole > 0.0 { part / whole } else { other };
    LevelFigures {
        threshold: level(number),
        recall_wide: or(recall_wide, 0.0),
        recall_thin: or(recall_thin, 0.0),
        precision: or(precision, 1.0),
        posts: or(posts, 0.0),
    }
}

fn by_width(sum: &PixelCounts, threshold: usize) -> Vec<WidthRecall> {
    let recall = |(width, lines): (&super::counts::WidthClass, &Vec<f64>)| {
        let length_px: f64 = lines.iter().sum();
        let hit = reaching(lines, threshold);
        WidthRecall {
            width: *width,
            length_px,
            recall: if length_px > 0.0 {
                hit / length_px
            } else {
                0.0
            },
        }
    };
    WIDTHS.iter().zip(&sum.lines).map(recall).collect()
}

fn calibration(sum: &PixelCounts) -> Vec<CalibrationBin> {
    let middle = |bin: usize| (bin as f64 + 0.5) / BINS as f64;
    let bin = |(number, &(pixels, wood, p)): (usize, &(u64, u64, f64))| {
        let mean = |sum: f64, none: f64| {
            if pixels > 0 {
                sum / pixels as f64
            } else {
                none
            }
        };
        CalibrationBin {
            pixels,
            probability: mean(p, middle(number)),
            share: mean(wood as f64, 0.0),
        }
    };
    sum.calibration.iter().enumerate().map(bin).collect()
}

fn calibration_error(bins: &[CalibrationBin]) -> f64 {
    let pixels: u64 = bins.iter().map(|bin| bin.pixels).sum();
    let off = |bin: &CalibrationBin| bin.pixels as f64 * (bin.probability - bin.share).abs();
    bins.iter().map(off).sum::<f64>() / pixels.max(1) as f64
}

fn worst(
    images: &[SegmentationImage],
    counts: &[&PixelCounts],
    threshold: usize,
) -> Vec<WorstSegmentation> {
    let one = |(image, counts): (&SegmentationImage, &&PixelCounts)| {
        let missed = |lines: &Vec<f64>| lines.iter().sum::<f64>() - reaching(lines, threshold);
        WorstSegmentation {
            image: image.name.clone(),
            missed_px: counts.lines.iter().map(missed).sum(),
            false_pixels: reaching(&counts.all, threshold) - reaching(&counts.near, threshold),
        }
    };
    let mut all: Vec<WorstSegmentation> = images.iter().zip(counts).map(one).collect();
    // A falsely marked pixel is about a pixel of length of the thinnest wood, some of thicker.
    let badness = |image: &WorstSegmentation| {
        image.missed_px + image.false_pixels as f64 / WIDTHS[WIDE].from_px
    };
    all.retain(|image| badness(image) > 0.0);
    all.sort_by(|a, b| badness(b).total_cmp(&badness(a)));
    all.truncate(WORST);
    all
}

fn differences(
    sources: &[SegmentationSource<'_>],
    difference: impl Fn([usize; 2], usize) -> Option<Estimate>,
) -> Vec<SegmentationDifference> {
    let mut differences = Vec::new();
    for (first, a) in sources.iter().enumerate() {
        for (second, b) in sources.iter().enumerate().skip(first + 1) {
            let of = |figure| difference([first, second], figure);
            if let (Some(recall_wide), Some(precision), Some(iou)) = (of(0), of(2), of(3)) {
                differences.push(SegmentationDifference {
                    first: a.name().to_owned(),
                    second: b.name().to_owned(),
                    recall_wide,
                    precision,
                    iou,
                });
            }
        }
    }
    differences
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_are_hundredths() {
        for (given, expected) in [(0.5, 0.5), (0.0, 0.01), (1.0, 0.99), (0.333, 0.33)] {
            assert!((level(nearest_level(given)) - expected).abs() < 1e-12);
        }
    }
}
