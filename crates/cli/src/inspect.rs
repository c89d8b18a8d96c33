mod camera;
mod cloud;
mod document;
mod facts;
mod folder;
mod image;
mod robot;

use crate::frame_arguments::FrameArguments;
use crate::terminal::{self, Terminal};
use anyhow::{anyhow, bail};
use clap::Args;
use facts::Facts;
use pomona_cloud::CloudFormat;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  pomona inspect frames/a                    size, camera, depth and boxes of a frame
  pomona inspect cloud.pcd cloud.ply         points, bounds and colours of clouds
  pomona inspect out/picks.json --json       as JSON, in metres

Frames, clouds (PCD, PLY, XYZ), images, cameras, box files, transforms, samples and reports of calibrations, settings, \
picks.json and truth.json are recognised, in pomona's form and in those of other programs. What is doubtful comes last.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct InspectArguments {
    /// Files and folders.
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Print JSON: one object for one path, an array for several; lengths in metres.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    frame: FrameArguments,
}

pub(crate) fn run(arguments: &InspectArguments, terminal: Terminal) -> anyhow::Result<()> {
    let count = arguments.paths.len();
    let mut known: Vec<Facts> = Vec::new();
    for path in &arguments.paths {
        match facts_of(path, arguments.frame) {
            Ok(facts) => {
                if !arguments.json {
                    let separator = if known.is_empty() { "" } else { "\n" };
                    terminal::print(&(separator.to_owned() + &facts.text(terminal)))?;
                }
                known.push(facts);
            }
            Err(error) if count == 1 => return Err(error),
            Err(error) => terminal.error(&error),
        }
    }
    if arguments.json {
        let json = match &*known {
            [facts] if count == 1 => serde_json::to_string_pretty(facts)?,
            facts => serde_json::to_string_pretty(facts)?,
        };
        terminal::print(&(json + "\n"))?;
    }
    if known.len() < count {
        bail!(
            "{} of {count} paths could not be read, for the reasons above",
            count - known.len()
        );
    }
    Ok(())
}

fn facts_of(path: &Path, read: FrameArguments) -> anyhow::Result<Facts> {
    if path.is_dir() {
        return folder::facts(path, read);
    }
    let start = first_bytes(path)?;
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    if image::is_image(&start) {
        return image::facts(path, &start);
    }
    if document::is_box_file(path, &start) {
        return document::boxes(path);
    }
    match extension.as_str() {
        "json" => document::json(path, read),
        "yaml" | "yml" => document::by_words(path, read),
        // Clouds have this extension too.
        "txt" if robot::is_transform(path) => robot::transform(path),
        "toml" => document::settings(path),
        _ if cloud::is_cloud(&start) || CloudFormat::from_path(path).is_some() => {
            cloud::facts(path)
        }
        "csv" => robot::samples(path),
        "urdf" | "xacro" | "launch" => robot::transform(path),
        _ => bail!(
            "{}: not a file that this program knows; it knows frames' folders, PCD, PLY, XYZ, PNG, JPEG, TIFF, NPY, and \
             JSON, YAML, TOML and XML files of its own",
            path.display()
        ),
    }
}

/// Enough of a file to tell what it is.
fn first_bytes(path: &Path) -> anyhow::Result<Vec<u8>> {
    let mut start = Vec::new();
    File::open(path)
        .and_then(|file| file.take(64).read_to_end(&mut start))
        .map_err(|e| anyhow!("{}: cannot be read: {e}; check the path", path.display()))?;
    Ok(start)
}
