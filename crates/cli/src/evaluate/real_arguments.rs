//! What is asked of real frames.

use super::segmentation::STROKED;
use clap::Args;
use std::path::PathBuf;

/// Heading of these options.
const HEADING: &str = "Real frames";

/// What `--real` measures.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct RealArguments {
    /// Measure directions on real frames: against the strokes of wood that a person drew in them (--strokes, or wood.txt
    /// in each frame's folder).
    #[arg(long, group = STROKED, requires = "subjects", conflicts_with_all = ["calipers", "detection", "count", "robot"], help_heading = HEADING)]
    pub(super) real: bool,
    /// Which apples' wood a person sees: CSV with the columns frame, `box_name` and wood (seen, doubtful or none). Default:
    /// it is seen where wood is drawn near the box (--apple-radii).
    #[arg(long, value_name = "FILE", requires = "real", conflicts_with = "apple_radii", help_heading = HEADING)]
    pub(super) apples: Option<PathBuf>,
    /// Tell the methods where wood is by the masks of another program: a folder with NAME.wood.png for each frame, grey,
    /// 255 where it is sure of wood.
    #[arg(long, value_name = "FOLDER", requires = "real", conflicts_with = "segmenters", help_heading = HEADING)]
    pub(super) wood_masks: Option<PathBuf>,
    /// Number of perturbed copies of each frame whose answers are compared with the frame's own; 0 saves time.
    #[arg(long, value_name = "N", default_value_t = 8, requires = "real", help_heading = HEADING)]
    pub(super) repeats: usize,
}
