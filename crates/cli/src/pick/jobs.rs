use super::files;
use crate::output_folder::OutputFolder;
use anyhow::{anyhow, bail};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// One frame's folder and that of its answers.
pub(super) struct Job {
    pub(super) frame: PathBuf,
    pub(super) output: OutputFolder,
}

/// The work on each of `frames`, with the names of its files claimed: in `out` itself for one frame, in a folder each
/// for several. `of_one_frame` is an option whose file belongs to one frame.
pub(super) fn jobs(
    frames: &[PathBuf],
    out: &Path,
    of_one_frame: Option<&str>,
) -> anyhow::Result<Vec<Job>> {
    let job = |frame: &Path, out: &Path| -> anyhow::Result<Job> {
        Ok(Job {
            frame: frame.to_owned(),
            output: files::claim(out)?,
        })
    };
    if let [frame] = frames {
        return Ok(vec![job(frame, out)?]);
    }
    if let Some(option) = of_one_frame {
        bail!(
            "{option} is for one frame, but {} are given; give each a run of its own, or put boxes into the frames' \
             folders",
            frames.len()
        );
    }
    let mut seen: HashMap<PathBuf, &Path> = HashMap::new();
    let mut jobs = Vec::new();
    for frame in frames {
        let id = folder_name(frame)?;
        if let Some(other) = seen.insert(id.clone(), frame) {
            bail!(
                "{} and {}: both would be written to {}; rename one of the folders, or give each a run of its own",
                other.display(),
                frame.display(),
                out.join(id).display()
            );
        }
        jobs.push(job(frame, &out.join(id))?);
    }
    Ok(jobs)
}

/// The name of a frame's folder, also where the path is `.` or ends in `..`.
fn folder_name(frame: &Path) -> anyhow::Result<PathBuf> {
    if let Some(name) = frame.file_name() {
        return Ok(name.into());
    }
    let full = frame
        .canonicalize()
        .map_err(|e| anyhow!("{}: {e}; check the path", frame.display()))?;
    let name = full
        .file_name()
        .ok_or_else(|| anyhow!("{}: not a frame's folder", frame.display()))?;
    Ok(name.into())
}
