//! The files that `pomona pick` writes for a frame.

use crate::output_folder::{OutputFolder, RecordFile};
use std::path::Path;

/// The answers of one frame.
pub(crate) const PICKS: &str = "picks.json";
/// The picture of one frame.
pub(crate) const PICTURE: &str = "picture.png";
/// The recording of one frame; runs of builds without the feature remove it all the same.
pub(crate) const RECORDING: &str = "recording.mcap";

/// The name under which the cloud of an apple is written.
pub(crate) fn cloud_name(id: usize) -> String {
    format!("apple-{id}.ply")
}

/// Claims the names of these files in `folder`.
pub(crate) fn claim(folder: &Path) -> anyhow::Result<OutputFolder> {
    let record = RecordFile {
        name: PICKS,
        schema: "pomona.picks/",
    };
    OutputFolder::claim(folder, &[record], is_ours)
}

/// Whether a run may have written a file of this name beside the answers.
fn is_ours(name: &str) -> bool {
    let is_cloud = |name: &str| {
        let id = name.strip_prefix("apple-")?.strip_suffix(".ply")?;
        id.parse::<usize>().ok()
    };
    let is_message = |name: &str| {
        let message = name
            .strip_prefix("ros-")
            .and_then(|n| n.strip_suffix(".yaml"));
        message.is_some_and(|n| !n.is_empty())
    };
    let is_fixed = [PICTURE, RECORDING].contains(&name);
    is_fixed || is_cloud(name).is_some() || is_message(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_a_run_may_write() {
        for name in [PICTURE, RECORDING, &cloud_name(3), "ros-path.yaml"] {
            assert!(is_ours(name), "{name}");
        }
        for name in ["apple-x.ply", "apple-.ply", "ros-.yaml", "notes.txt"] {
            assert!(!is_ours(name), "{name}");
        }
    }
}
