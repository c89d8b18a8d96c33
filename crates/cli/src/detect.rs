//! `pomona detect`: the apples in colour images.

mod record;
#[cfg(test)]
mod tests;
mod text;

use crate::detector::{DetectorArguments, say_assumptions};
use crate::image_paths::{NamedImage, images};
use crate::output_folder::{OutputFolder, Staging};
use crate::progress;
use crate::terminal::{self, Terminal};
use clap::{Args, ValueEnum};
use pomona_cloud::{
    BoxFormat, CocoCategory, CocoDataset, CocoImage, ColorImage, LabelledBox, PixelBox, write_boxes,
};
use pomona_detect::{Detection, Detector, DetectorReport};
use pomona_view::{BoxKind, BoxMark, draw_boxes};
use record::{DetectionRecord, DetectionsRecord, ImageRecord, TimingRecord};
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLES: &str = "\
Examples:
  pomona detect photo.jpg --out out                  out/detections.json, boxes.json, photo-boxes.png
  pomona detect photos frames/a --format voc --out out
                                                     a VOC file for each image
  pomona detect photos --model mine.onnx --class apple --threshold 0.4 --out out
  pomona detect photos --runtime embedded --tiles 3x2 --out out
  pomona detect photos --out out --json | jq '.images[].detections | length'

An image is a PNG or a JPEG, the folder of a frame (its colour image), or a folder of images or frames.

Bad input ends with exit code 2 and writes nothing.";

/// The record.
const DETECTIONS: &str = "detections.json";
/// The boxes of all images in one COCO file.
const COCO: &str = "boxes.json";
/// What the boxes are of, as box files name it.
const CLASS: &str = "apple";

/// A form of box files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    /// One COCO JSON for all images.
    #[default]
    Coco,
    /// A VOC XML for each image.
    Voc,
    /// A YOLO text for each image, with scores.
    Yolo,
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct DetectArguments {
    /// Images, frames, or folders of them.
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// Output folder. Files of earlier runs are replaced.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Format of the boxes.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    format: Format,
    /// Print the record to standard output instead of the table.
    #[arg(long)]
    json: bool,
    /// Do not write pictures.
    #[arg(long)]
    no_picture: bool,
    #[command(flatten)]
    detector: DetectorArguments,
}

pub(crate) fn run(arguments: &DetectArguments, terminal: Terminal) -> anyhow::Result<()> {
    // What is wrong with the command line is said before a model is loaded.
    let images = images(&arguments.images)?;
    let output = claim(arguments, &images)?;
    let opening = Instant::now();
    let detector = arguments.detector.open()?;
    let job = Job {
        arguments,
        images: &images,
        output: &output,
        detector: &*detector,
        open_ms: milliseconds(opening),
    };
    job.run(terminal)
}

/// Says what was assumed about the model, and with -v why a runtime did not serve.
pub(crate) fn say(report: &DetectorReport, terminal: Terminal) {
    let runtime = report.runtime.as_ref();
    say_assumptions(&report.name, &report.notes, runtime, terminal);
}

/// What is to be done, and with what.
struct Job<'a> {
    arguments: &'a DetectArguments,
    images: &'a [NamedImage],
    output: &'a OutputFolder,
    detector: &'a dyn Detector,
    open_ms: f64,
}

impl Job<'_> {
    fn run(&self, terminal: Terminal) -> anyhow::Result<()> {
        let arguments = self.arguments;
        let report = self.detector.report();
        say(&report, terminal);
        let output = self.output.stage()?;
        let bar = progress::bar(self.images.len());
        let mut records = Vec::new();
        for image in self.images {
            bar.set_message(image.name.clone());
            records.push(detect(arguments, image, self.detector, &output, terminal)?);
            bar.inc(1);
        }
        bar.finish_and_clear();
        if arguments.format == Format::Coco {
            coco(&records, self.images).write(output.file(COCO))?;
        }
        let record = DetectionsRecord::new(report, self.open_ms, records);
        let json = serde_json::to_string_pretty(&record)? + "\n";
        output.write_text(DETECTIONS, &json)?;
        output.publish()?;
        if arguments.json {
            return terminal::print(&json);
        }
        let place = arguments.out.display();
        let table = text::table(&record, terminal);
        terminal::print(&format!("{table}\nwritten to {place}\n"))
    }
}

/// Detects in one image, and writes its picture and its own box file, if it gets one.
fn detect(
    arguments: &DetectArguments,
    image: &NamedImage,
    detector: &dyn Detector,
    output: &Staging<'_>,
    terminal: Terminal,
) -> anyhow::Result<ImageRecord> {
    let reading = Instant::now();
    let pixels = ColorImage::read(&image.path)?;
    if let Some(warning) = ColorImage::turned_by_exif(&image.path)? {
        terminal.warn(&image.name, &warning);
    }
    let read = milliseconds(reading);
    let detecting = Instant::now();
    let found = detector
        .detect(&pixels)
        .map_err(|e| anyhow::anyhow!("{}: {e}", image.path.display()))?;
    let detect = milliseconds(detecting);
    let (width, height) = (pixels.width, pixels.height);
    let named = |d: &Detection| d.to_pixel_box(CLASS);
    // What holds no pixel of the image cannot stand in a box file and is no apple in it.
    let found: Vec<Detection> = found
        .into_iter()
        .filter(|d| named(d).validate(width, height).is_ok())
        .collect();
    let boxes: Vec<PixelBox> = found.iter().map(named).collect();
    let own = own_box_file(arguments.format, &image.name);
    if let Some((name, format)) = &own {
        write_boxes(output.file(name), &boxes, width, height, *format)?;
    }
    let picture = (!arguments.no_picture).then(|| picture_name(&image.name));
    if let Some(name) = &picture {
        let marks: Vec<BoxMark> = boxes
            .into_iter()
            .map(|bounds| {
                let caption = format!("{:.2}", bounds.score);
                BoxMark::new(bounds, BoxKind::Detected).captioned(caption)
            })
            .collect();
        draw_boxes(&pixels, &marks)?.write(output.file(name))?;
    }
    Ok(ImageRecord {
        name: image.name.clone(),
        file: image.path.to_string_lossy().into_owned(),
        width,
        height,
        detections: found.iter().map(DetectionRecord::from).collect(),
        boxes: own.map_or_else(|| COCO.to_owned(), |(name, _)| name),
        picture,
        timing_ms: TimingRecord { read, detect },
    })
}

/// The box file of one image, where each has its own.
fn own_box_file(format: Format, name: &str) -> Option<(String, BoxFormat)> {
    match format {
        Format::Coco => None,
        Format::Voc => Some((format!("{name}.xml"), BoxFormat::Voc)),
        Format::Yolo => Some((format!("{name}.txt"), BoxFormat::Yolo)),
    }
}

fn picture_name(name: &str) -> String {
    format!("{name}-boxes.png")
}

/// The boxes of all images in one data set.
fn coco(records: &[ImageRecord], images: &[NamedImage]) -> CocoDataset {
    let pairs = records.iter().zip(images).zip(1..);
    let images = pairs.map(|((record, image), id)| {
        let boxes = record.detections.iter().map(|d| {
            let mut label = LabelledBox::new(d.to_pixel_box(CLASS));
            label.class_number = Some(1);
            label.class_name = Some(CLASS.to_owned());
            label
        });
        let mut labelled = CocoImage::new(id, &image.file_name);
        (labelled.width, labelled.height) = (record.width, record.height);
        labelled.boxes = boxes.collect();
        labelled
    });
    let mut dataset = CocoDataset::default();
    dataset.images = images.collect();
    dataset.categories = vec![CocoCategory::new(1, CLASS)];
    dataset
}

/// Claims the names of the files that this run writes.
fn claim(arguments: &DetectArguments, images: &[NamedImage]) -> anyhow::Result<OutputFolder> {
    let mut written = Vec::new();
    if arguments.format == Format::Coco {
        written.push(COCO.to_owned());
    }
    for image in images {
        written.extend(own_box_file(arguments.format, &image.name).map(|(name, _)| name));
        if !arguments.no_picture {
            written.push(picture_name(&image.name));
        }
    }
    let earlier = record::files_of_earlier_run(&arguments.out.join(DETECTIONS));
    OutputFolder::claim_listed(&arguments.out, DETECTIONS, &written, &earlier)
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
