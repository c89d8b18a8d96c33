//! `pomona segment`: what each pixel of colour images shows.

mod record;

use crate::image_paths::{NamedImage, images};
use crate::output_folder::{OutputFolder, Staging};
use crate::progress;
use crate::segmenter::{SegmenterArguments, say};
use crate::summary::plural;
use crate::terminal::{self, Terminal, one_line};
use clap::Args;
use pomona_cloud::{ColorImage, GrayImage};
use pomona_segment::{Classes, Role, Segmenter};
use pomona_view::tint;
use record::{ClassesRecord, SegmentedImage};
use std::path::PathBuf;
use std::time::Instant;

const EXAMPLES: &str = "\
Examples:
  pomona segment photo.jpg --out out                 out/photo.classes.png, photo.wood.png, photo-classes.png, classes.json
  pomona segment photos frames/a --out out
  pomona segment photos --model mine.onnx --out out  mine.toml beside it names its classes
  pomona segment photos --runtime embedded --tiles 3x2 --out out
  pomona segment photos --out out --json | jq '.images[].share.wood'

An image is a PNG or a JPEG, the folder of a frame (its colour image), or a folder of images or frames.

Bad input ends with exit code 2 and writes nothing.";

/// The record.
const RECORD: &str = "classes.json";

/// How much of a class's colour covers the image in the picture.
const OPACITY: f32 = 0.55;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct SegmentArguments {
    /// Images, frames, or folders of them.
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// Output folder. Files of earlier runs are replaced.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Print the record to standard output instead of the table.
    #[arg(long)]
    json: bool,
    /// Do not write pictures.
    #[arg(long)]
    no_picture: bool,
    #[command(flatten)]
    segmenter: SegmenterArguments,
}

/// The files of one image.
struct Names {
    classes: String,
    wood: String,
    picture: Option<String>,
}

impl Names {
    fn of(name: &str, with_picture: bool) -> Self {
        Self {
            classes: format!("{name}.classes.png"),
            wood: format!("{name}.wood.png"),
            picture: with_picture.then(|| format!("{name}-classes.png")),
        }
    }
}

pub(crate) fn run(arguments: &SegmentArguments, terminal: Terminal) -> anyhow::Result<()> {
    // What is wrong with the command line is said before a model is loaded.
    let images = images(&arguments.images)?;
    let names: Vec<Names> = images
        .iter()
        .map(|image| Names::of(&image.name, !arguments.no_picture))
        .collect();
    let written: Vec<String> = names
        .iter()
        .flat_map(|n| {
            [
                Some(n.classes.clone()),
                Some(n.wood.clone()),
                n.picture.clone(),
            ]
        })
        .flatten()
        .collect();
    let earlier = record::files_of_earlier_run(&arguments.out.join(RECORD));
    let output = OutputFolder::claim_listed(&arguments.out, RECORD, &written, &earlier)?;
    let opening = Instant::now();
    let segmenter = arguments.segmenter.open()?;
    let open_ms = milliseconds(opening);
    let report = segmenter.report();
    say(&report, terminal);
    let files = output.stage()?;
    let bar = progress::bar(images.len());
    let mut segmented = Vec::new();
    for (image, names) in images.iter().zip(names) {
        bar.set_message(image.name.clone());
        segmented.push(segment(&*segmenter, image, names, &files)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let record = ClassesRecord::new(report, segmenter.classes(), open_ms, segmented);
    let json = serde_json::to_string_pretty(&record)? + "\n";
    files.write_text(RECORD, &json)?;
    files.publish()?;
    if arguments.json {
        return terminal::print(&json);
    }
    let place = arguments.out.display();
    terminal::print(&format!("{}\nwritten to {place}\n", table(&record)))
}

fn segment(
    segmenter: &dyn Segmenter,
    image: &NamedImage,
    names: Names,
    files: &Staging<'_>,
) -> anyhow::Result<SegmentedImage> {
    let pixels = ColorImage::read(&image.path)?;
    let begin = Instant::now();
    let seen = segmenter
        .segment(&pixels)
        .map_err(|e| anyhow::anyhow!("{}: {e}", image.path.display()))?;
    let segment_ms = milliseconds(begin);
    let likeliest = seen.likeliest();
    let classes = GrayImage {
        width: seen.width(),
        height: seen.height(),
        values: likeliest.clone(),
    };
    classes.write(files.file(&names.classes))?;
    seen.mask(Role::Wood).write(files.file(&names.wood))?;
    if let Some(name) = &names.picture {
        let roles = seen.classes().roles();
        let color = |k: usize| color(*roles.get(usize::from(likeliest[k]))?);
        tint(&pixels, color, OPACITY)?.write(files.file(name))?;
    }
    Ok(SegmentedImage {
        name: image.name.clone(),
        file: image.path.to_string_lossy().into_owned(),
        width: seen.width(),
        height: seen.height(),
        share: shares(seen.classes(), &likeliest),
        classes: names.classes,
        wood: names.wood,
        picture: names.picture,
        segment_ms,
    })
}

/// Of all pixels, the share of each class that is the likeliest there.
fn shares(classes: &Classes, likeliest: &[u8]) -> std::collections::BTreeMap<String, f64> {
    let share = |class: usize| {
        let count = likeliest
            .iter()
            .filter(|c| usize::from(**c) == class)
            .count();
        count as f64 / likeliest.len().max(1) as f64
    };
    classes
        .names()
        .iter()
        .enumerate()
        .map(|(class, name)| (name.clone(), share(class)))
        .collect()
}

/// The colour of a role in pictures; none for the rest.
pub(crate) fn color(role: Role) -> Option<[u8; 3]> {
    match role {
        Role::Wood => Some([255, 0, 255]),
        Role::Peduncle => Some([0, 255, 255]),
        Role::Fruit => Some([255, 40, 30]),
        Role::Post => Some([255, 170, 0]),
        _ => None,
    }
}

fn table(record: &ClassesRecord) -> String {
    let mut text = format!("{}\n", one_line(&record.what()));
    for image in &record.images {
        let shares = image.share.iter().filter(|(_, share)| **share > 0.0);
        let shares: Vec<String> = shares
            .map(|(name, share)| format!("{} {:.1} %", one_line(name), 100.0 * share))
            .collect();
        let line = format!(
            "{}  {}x{}  {}  {:.0} ms\n",
            one_line(&image.name),
            image.width,
            image.height,
            shares.join(", "),
            image.segment_ms
        );
        text += &line;
    }
    text + &format!("{} segmented\n", plural(record.images.len(), "image"))
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
