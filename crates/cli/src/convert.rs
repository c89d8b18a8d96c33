use crate::frame_arguments::FrameArguments;
use crate::summary::plural;
use crate::terminal::{self, Terminal};
use anyhow::{anyhow, bail};
use clap::{Args, ValueEnum};
use pomona_cloud::{CloudFormat, PointCloud};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  pomona convert cloud.pcd cloud.ply
  pomona convert cloud.ply cloud.pcd --format pcd-binary-compressed
  pomona convert frames/a a.pcd           a frame as an organised, coloured cloud

The format of IN is recognised by its content. An existing OUT is replaced.";

/// Cloud formats, under the names of the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// PCD, text.
    PcdAscii,
    /// PCD, packed records.
    PcdBinary,
    /// PCD, compressed columns.
    PcdBinaryCompressed,
    /// PLY, text.
    PlyAscii,
    /// PLY, packed little-endian records.
    PlyBinary,
    /// PLY, packed big-endian records.
    PlyBinaryBe,
    /// `x y z [r g b]` lines.
    Xyz,
}

impl Format {
    fn format(self) -> CloudFormat {
        match self {
            Self::PcdAscii => CloudFormat::PcdAscii,
            Self::PcdBinary => CloudFormat::PcdBinary,
            Self::PcdBinaryCompressed => CloudFormat::PcdBinaryCompressed,
            Self::PlyAscii => CloudFormat::PlyAscii,
            Self::PlyBinary => CloudFormat::PlyBinaryLittleEndian,
            Self::PlyBinaryBe => CloudFormat::PlyBinaryBigEndian,
            Self::Xyz => CloudFormat::Xyz,
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ConvertArguments {
    /// A cloud (PCD, PLY, XYZ) or the folder of a frame.
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The file to write.
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// The format to write. Default: from the extension of OUT, binary if there is a choice.
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Drop points that are NaN or infinite; an organised cloud becomes unorganised.
    #[arg(long)]
    drop_nan: bool,
    #[command(flatten)]
    frame: FrameArguments,
}

pub(crate) fn run(arguments: &ConvertArguments, terminal: Terminal) -> anyhow::Result<()> {
    let (input, output) = (&arguments.input, &arguments.output);
    let by_name = || CloudFormat::from_path(output);
    let Some(format) = arguments.format.map(Format::format).or_else(by_name) else {
        bail!(
            "{}: its extension names no cloud format; use .pcd, .ply or .xyz, or give --format",
            output.display()
        );
    };
    if output.is_dir() {
        bail!("{}: is a folder; name a file", output.display());
    }
    let mut cloud = if input.is_dir() {
        from_frame(arguments, terminal)?
    } else {
        PointCloud::read(input)?
    };
    if arguments.drop_nan {
        cloud = finite_part(&cloud);
    }
    check(&cloud, input)?;
    cloud.write(output, format)?;
    terminal::print(&format!("{}: {}\n", output.display(), description(&cloud)))
}

fn from_frame(arguments: &ConvertArguments, terminal: Terminal) -> anyhow::Result<PointCloud> {
    let frame = arguments.frame.without_boxes(&arguments.input)?;
    for warning in frame.warnings.iter().chain(&frame.camera.doubts()) {
        terminal.warn(&frame.id, warning);
    }
    Ok(PointCloud::from_frame(&frame)?)
}

fn is_finite(cloud: &PointCloud, i: usize) -> bool {
    cloud.x[i].is_finite() && cloud.y[i].is_finite() && cloud.z[i].is_finite()
}

fn finite_part(cloud: &PointCloud) -> PointCloud {
    if cloud.finite_points().count() == cloud.len() {
        return cloud.clone();
    }
    cloud.select((0..cloud.len()).filter(|&i| is_finite(cloud, i)))
}

/// Refuses an empty cloud, and NaN points where they do not represent pixels without a reading.
fn check(cloud: &PointCloud, path: &Path) -> anyhow::Result<()> {
    let path = path.display();
    if cloud.is_empty() {
        bail!("{path}: the cloud is empty; give one with points");
    }
    let finite = cloud.finite_points().count();
    if finite == 0 {
        bail!(
            "{path}: no point of {} is finite; write the cloud again",
            cloud.len()
        );
    }
    if finite < cloud.len() && cloud.size.is_none() {
        let first = (0..cloud.len())
            .find(|&i| !is_finite(cloud, i))
            .unwrap_or_default();
        return Err(anyhow!(
            "{path}: {} of {} points are NaN or infinite, the first at index {first}, and the cloud is not organised; \
             give --drop-nan to leave them out",
            cloud.len() - finite,
            cloud.len()
        ));
    }
    Ok(())
}

/// A short description of a cloud.
fn description(cloud: &PointCloud) -> String {
    let missing = cloud.len() - cloud.finite_points().count();
    let parts = [
        Some(plural(cloud.len(), "point")),
        cloud
            .size
            .map(|(width, height)| format!("organised {width}x{height}")),
        cloud.colors.as_ref().map(|_| "with colours".to_owned()),
        (missing > 0).then(|| format!("{missing} without a reading")),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
