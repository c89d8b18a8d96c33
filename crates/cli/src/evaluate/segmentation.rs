use super::results::{REPORT, Results, json};
use super::segmentation_text;
use super::worst_sheet::{self, is_sheet, stem};
use crate::detector::{BUILT_IN, DetectorSettings, Model, parse_share};
use crate::output_folder::Staging;
use crate::progress;
use crate::segmenter::{open, say};
use crate::terminal::Terminal;
use crate::wood::{SegmenterChoice, parse_segmenter};
use anyhow::{anyhow, bail};
use clap::Args;
use pomona_cloud::{ColorImage, GrayImage};
use pomona_labels::{
    ImageStrokes, LabelsError, PixelVerdict, SEGMENTATION_SCHEMA, SegmentationEvaluation,
    SegmentationImage, SegmentationOptions, SegmentationSource, evaluate_segmentation,
    judge_pixels, masked_images, read_strokes, segmentation_images, segmentation_page,
};
use pomona_scenes::{CLASSES_FILE, SceneClass};
use pomona_segment::{Role, Segmenter};
use pomona_view::{ContactSheetImage, tint};
use std::path::{Path, PathBuf};

/// Heading of these options.
const HEADING: &str = "Segmentation";
/// The options of which one says what strokes are for.
pub(super) const STROKED: &str = "stroked";
const SEGMENTATION: &str = "segmentation.json";
/// The strokes of a folder, where `--strokes` is not given.
const STROKES: &str = "strokes.txt";
/// How much of the colour of marks covers the picture.
const OPACITY: f32 = 0.6;

/// What `--segmentation` measures.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct SegmentationArguments {
    /// Measure masks of wood on strokes drawn by eye, or on true masks: the folder of the images (or of their `images/`,
    /// or of frames).
    #[arg(long, value_name = "FOLDER", help_heading = HEADING, group = STROKED, conflicts_with_all = ["subjects", "methods", "variants", "SettingValues", "calipers", "detection"])]
    pub(super) segmentation: Option<PathBuf>,
    /// The strokes, also with --real. Default: strokes.txt in the folder; with --real wood.txt in each frame's folder.
    #[arg(long, value_name = "FILE", requires = STROKED, conflicts_with = "truth_masks", help_heading = HEADING)]
    pub(super) strokes: Option<PathBuf>,
    /// Masks as the truth in place of strokes: a folder with NAME.wood.png (or NAME.png) for each image, grey, 255 for
    /// wood and 0 for the rest; or a folder of frames with classes.png, as `pomona scenes` writes them. Images without
    /// a mask are left out.
    #[arg(long, value_name = "FOLDER", requires = "segmentation", help_heading = HEADING)]
    truth_masks: Option<PathBuf>,
    /// A second person's strokes of some of the images, for the agreement of their centre lines with these.
    #[arg(long, value_name = "FILE", requires = "segmentation", conflicts_with = "truth_masks", help_heading = HEADING)]
    second_strokes: Option<PathBuf>,
    /// A segmentation model to measure (ONNX), or `built-in`; may be repeated. Default: built-in, unless --masks are
    /// given. With --real the model that tells the methods where wood is, or `none`; default: built-in, unless
    /// --wood-masks are given.
    #[arg(long = "segmenter", value_name = "FILE", value_parser = parse_segmenter, requires = STROKED, help_heading = HEADING)]
    pub(super) segmenters: Vec<SegmenterChoice>,
    /// Masks of another program: a folder with NAME.wood.png (or NAME.png) for each image, grey, 255 where it is
    /// sure of wood; may be repeated.
    #[arg(long, value_name = "FOLDER", requires = "segmentation", help_heading = HEADING)]
    masks: Vec<PathBuf>,
    /// Probability of wood from which on a pixel is marked.
    #[arg(long, value_name = "P", default_value_t = 0.5, value_parser = parse_share, requires = "segmentation", help_heading = HEADING)]
    wood_threshold: f64,
    /// Distance in pixels within which wood is found and a mark is right.
    #[arg(long, value_name = "PX", default_value_t = 3.0, value_parser = parse_tolerance, requires = "segmentation", help_heading = HEADING)]
    tolerance_px: f64,
    /// Count only what lies within N radii of the apples boxed in each frame, where only that has been drawn in. With
    /// --real and without --apples: the wood of an apple is seen where wood is drawn within N radii (default 3).
    #[arg(long, value_name = "N", value_parser = parse_tolerance, requires = STROKED, help_heading = HEADING)]
    pub(super) apple_radii: Option<f64>,
    /// Scales at which models look at an image, separated by commas; the result is the mean.
    #[arg(long, value_name = "ZOOM", value_delimiter = ',', default_value = "1", requires = "segmentation", help_heading = HEADING)]
    zoom: Vec<f64>,
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    let value = text
        .parse()
        .ok()
        .filter(|value| (0.0..=100.0).contains(value));
    value.ok_or_else(|| "give a number from 0 to 100".to_owned())
}

/// Measures the segmenters on the first `count` images in `folder` that have strokes, or a true mask.
pub(super) fn run(
    own: &SegmentationArguments,
    settings: &DetectorSettings,
    folder: &Path,
    (count, seed): (Option<usize>, u64),
    results: &Results,
    terminal: Terminal,
) -> anyhow::Result<()> {
    let output = results.claim(SEGMENTATION, SEGMENTATION_SCHEMA, is_sheet)?;
    let (truth, mut images) = own.images(folder)?;
    images.truncate(count.unwrap_or(usize::MAX));
    let second = match &own.second_strokes {
        Some(path) => strokes(path, "--second-strokes")?,
        None => Vec::new(),
    };
    let opened = own.open(settings, terminal)?;
    let readers: Vec<_> = own.masks.iter().map(|folder| mask_reader(folder)).collect();
    let mut sources: Vec<SegmentationSource<'_>> = Vec::new();
    for (name, segmenter) in &opened {
        let name = name.clone();
        sources.push(SegmentationSource::Segmenter {
            name,
            segmenter: &**segmenter,
        });
    }
    for (folder, read) in own.masks.iter().zip(&readers) {
        let name = stem(folder);
        if sources.iter().any(|source| source.name() == name) {
            bail!(
                "--segmenter and --masks: `{name}` is given twice; give files and folders names of their own"
            );
        }
        sources.push(SegmentationSource::Masks { name, read });
    }
    let mut options = SegmentationOptions::new(own.wood_threshold, own.tolerance_px, seed);
    options.apple_radii = own.apple_radii;
    let bar = progress::bar(images.len());
    let evaluation =
        evaluate_segmentation(&stem(&truth), &images, &second, &sources, &options, &|| {
            bar.inc(1);
        })?;
    bar.finish_and_clear();
    let files = output.stage()?;
    let sheets = sheets(&images, &sources, &evaluation, &options, &files)?;
    files.write_text(SEGMENTATION, &json(&evaluation)?)?;
    files.write_text(REPORT, &segmentation_page(&evaluation, &sheets)?)?;
    files.publish()?;
    results.print(
        &evaluation,
        &segmentation_text::tables(&evaluation, terminal),
    )
}

impl SegmentationArguments {
    /// The file of strokes or the folder of masks, and the images that it names.
    fn images(&self, folder: &Path) -> anyhow::Result<(PathBuf, Vec<SegmentationImage>)> {
        if let Some(masks) = &self.truth_masks {
            let classes = (CLASSES_FILE, SceneClass::Wood as u8);
            let images = masked_images(folder, masks, classes).map_err(|error| match error {
                LabelsError::Io { .. } => {
                    anyhow!("{error}; give a folder of masks by --truth-masks")
                }
                error => error.into(),
            })?;
            return Ok((masks.clone(), images));
        }
        let file = self.strokes.clone().unwrap_or_else(|| folder.join(STROKES));
        let strokes = strokes(&file, "--strokes")?;
        let images = segmentation_images(folder, strokes, &file)?;
        Ok((file, images))
    }

    /// Opens the models, each under a name of its own.
    fn open(
        &self,
        settings: &DetectorSettings,
        terminal: Terminal,
    ) -> anyhow::Result<Vec<(String, Box<dyn Segmenter>)>> {
        let models = match (&*self.segmenters, &*self.masks) {
            ([], []) => &[SegmenterChoice::Model(Model::BuiltIn)][..],
            (models, _) => models,
        };
        let mut opened: Vec<(String, Box<dyn Segmenter>)> = Vec::new();
        for choice in models {
            let SegmenterChoice::Model(model) = choice else {
                bail!("--segmenter none: give a model to measure, or masks by --masks");
            };
            let name = match model {
                Model::BuiltIn => BUILT_IN.to_owned(),
                Model::File(path) => stem(path),
            };
            if opened.iter().any(|(other, _)| *other == name) {
                bail!(
                    "--segmenter: `{name}` is given twice; give each once, and files names of their own"
                );
            }
            let segmenter = open(model, settings.runtime(), settings.tiles(), &self.zoom)?;
            say(&segmenter.report(), terminal);
            opened.push((name, segmenter));
        }
        Ok(opened)
    }
}

/// Reads the strokes that `option` names.
fn strokes(file: &Path, option: &str) -> anyhow::Result<Vec<ImageStrokes>> {
    read_strokes(file).map_err(|error| match error {
        LabelsError::Io { .. } => {
            let masks = if option == "--strokes" {
                ", or masks by --truth-masks"
            } else {
                ""
            };
            anyhow!("{error}; give a file of strokes by {option}{masks}")
        }
        error => error.into(),
    })
}

/// Reads the masks in `folder`.
fn mask_reader(
    folder: &Path,
) -> impl Fn(&SegmentationImage, [usize; 2]) -> Result<Vec<f32>, LabelsError> + Sync {
    move |image, [width, height]| {
        let name = Path::new(&image.name);
        // A frame's folder has its whole name; an image's file loses its ending.
        let is_file = image.path.file_name() == name.file_name();
        let stem = if is_file {
            name.file_stem()
        } else {
            name.file_name()
        };
        let stem = stem.unwrap_or_default().to_string_lossy();
        let of_wood = folder.join(format!("{stem}.wood.png"));
        let path = if of_wood.is_file() {
            of_wood
        } else {
            folder.join(format!("{stem}.png"))
        };
        let mask = GrayImage::read(&path)?;
        if [mask.width, mask.height] != [width, height] {
            return Err(LabelsError::Malformed {
                path,
                problem: format!(
                    "{}x{} pixels for an image of {width}x{height}",
                    mask.width, mask.height
                ),
                remedy: "write the mask in the image's size".to_owned(),
            });
        }
        Ok(mask
            .values
            .iter()
            .map(|value| f32::from(*value) / 255.0)
            .collect())
    }
}

/// Writes the pictures of the worst images of each result; their names, empty where nothing is bad.
fn sheets(
    images: &[SegmentationImage],
    sources: &[SegmentationSource<'_>],
    evaluation: &SegmentationEvaluation,
    options: &SegmentationOptions,
    output: &Staging<'_>,
) -> anyhow::Result<Vec<String>> {
    let mut names = Vec::new();
    for (number, (result, source)) in evaluation.results.iter().zip(sources).enumerate() {
        let mut pictures = Vec::new();
        for worst in &result.worst {
            for image in images.iter().filter(|image| image.name == worst.image) {
                pictures.push(ContactSheetImage::new(
                    marked(image, source, options)?,
                    Vec::new(),
                    format!(
                        "-{:.0} +{} {}",
                        worst.missed_px, worst.false_pixels, worst.image
                    ),
                ));
            }
        }
        names.push(worst_sheet::write(&pictures, number + 1, output)?);
    }
    Ok(names)
}

/// The image with what is marked and right in green, marked and wrong in red, and missed in yellow; what does not count
/// is grey, and far wood is left as it is.
fn marked(
    image: &SegmentationImage,
    source: &SegmentationSource<'_>,
    options: &SegmentationOptions,
) -> anyhow::Result<ColorImage> {
    const RIGHT: [u8; 3] = [30, 235, 60];
    const WRONG: [u8; 3] = [255, 30, 30];
    const MISSED: [u8; 3] = [255, 222, 0];
    const OUTSIDE: [u8; 3] = [128; 3];
    let pixels = ColorImage::read(&image.path)?;
    let size = [pixels.width, pixels.height];
    let p = match source {
        SegmentationSource::Segmenter { segmenter, .. } => {
            segmenter.segment(&pixels)?.role(Role::Wood)
        }
        SegmentationSource::Masks { read, .. } => read(image, size)?,
    };
    let verdicts = judge_pixels(image, size, &p, options)?;
    let color = |k: usize| match verdicts[k] {
        PixelVerdict::Right => Some(RIGHT),
        PixelVerdict::Wrong => Some(WRONG),
        PixelVerdict::Missed => Some(MISSED),
        PixelVerdict::Outside => Some(OUTSIDE),
        _ => None,
    };
    Ok(tint(&pixels, color, OPACITY)?)
}
