//! Directions on real frames against strokes of wood drawn by eye.

use super::arguments::EvaluateArguments;
use super::real_pictures::{self, is_picture};
use super::real_text;
use super::results::{REPORT, json};
use crate::detector::Model;
use crate::progress;
use crate::terminal::Terminal;
use crate::wood::{self, SegmenterChoice};
use anyhow::{anyhow, bail};
use pomona_cloud::{ColorImage, GrayImage, PixelBox};
use pomona_evaluate::{
    AppleWoodTable, PickMethod, REAL_SCHEMA, RealFrame, RealOptions, measure_real,
    read_real_frames, real_csv, real_page,
};
use std::path::{Path, PathBuf};

const REAL: &str = "real.json";
const ROWS: &str = "real.csv";
/// What the record calls masks of another program.
const MASKS: &str = "masks";

pub(super) fn run(
    arguments: &EvaluateArguments,
    methods: &[&dyn PickMethod],
    terminal: Terminal,
) -> anyhow::Result<()> {
    let own = &arguments.real;
    let output = arguments
        .results
        .claim(REAL, REAL_SCHEMA, |name| name == ROWS || is_picture(name))?;
    let mut options = RealOptions::default();
    (options.seed, options.repeats) = (arguments.seed, own.repeats);
    if let Some(path) = &own.apples {
        options.apples = Some(AppleWoodTable::read(path)?);
    }
    if let Some(radii) = arguments.segmentation.apple_radii {
        options.apple_radii = radii;
    }
    let folders: Vec<PathBuf> = arguments.subjects.iter().map(PathBuf::from).collect();
    let mut frames = read_real_frames(&folders, arguments.segmentation.strokes.as_deref())?;
    options.wood = add_wood(arguments, &mut frames, terminal)?;
    let bar = progress::bar(methods.len() * frames.len() * options.answers());
    let report = measure_real(&frames, methods, &options, &|| bar.inc(1))?;
    bar.finish_and_clear();
    let files = output.stage()?;
    let pictures = real_pictures::write(&frames, &report, &files)?;
    files.write_text(REAL, &json(&report)?)?;
    files.write_text(ROWS, &real_csv(&report)?)?;
    files.write_text(REPORT, &real_page(&report, &pictures))?;
    files.publish()?;
    arguments
        .results
        .print(&report, &real_text::tables(&report, terminal))
}

/// Gives each frame the probability of wood that is asked for; what it comes from.
fn add_wood(
    arguments: &EvaluateArguments,
    frames: &mut [RealFrame],
    terminal: Terminal,
) -> anyhow::Result<Option<String>> {
    if let Some(folder) = &arguments.real.wood_masks {
        for frame in frames {
            frame.wood = Some(mask(folder, frame)?);
        }
        return Ok(Some(MASKS.to_owned()));
    }
    let model = match &*arguments.segmentation.segmenters {
        [] => &Model::BuiltIn,
        [SegmenterChoice::None] => return Ok(None),
        [SegmenterChoice::Model(model)] => model,
        _ => bail!("--segmenter is given twice; with --real give it once"),
    };
    let segmenter = wood::open(model, arguments.detection.settings().runtime(), terminal)?;
    for frame in frames {
        let boxes: Vec<PixelBox> = frame.boxes().to_vec();
        let boxes: Vec<&PixelBox> = boxes.iter().collect();
        let tell = |image: &ColorImage| wood::about(&segmenter, image, &boxes);
        frame.tell_wood(tell, arguments.real.repeats > 0)?;
    }
    Ok(Some(segmenter.report().name))
}

/// The mask of a frame in a folder.
fn mask(folder: &Path, frame: &RealFrame) -> anyhow::Result<GrayImage> {
    let path = folder.join(format!("{}.wood.png", frame.frame.id));
    if !path.is_file() {
        return Err(anyhow!(
            "{}: there is no such file; `pomona segment` writes one for each frame",
            path.display()
        ));
    }
    let mask = GrayImage::read(&path)?;
    let (width, height) = (frame.frame.color.width, frame.frame.color.height);
    if (mask.width, mask.height) != (width, height) {
        bail!(
            "{}: {}x{} pixels for a frame of {width}x{height}; write the mask in the frame's size",
            path.display(),
            mask.width,
            mask.height
        );
    }
    Ok(mask)
}
