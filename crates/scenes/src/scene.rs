use crate::error::SceneError;
use crate::truth::{TRUTH_FILE, Truth};
use pomona_cloud::Frame;
use std::path::{Path, PathBuf};

/// A frame and what is true of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// What a program is given.
    pub frame: Frame,
    /// What it should find.
    pub truth: Truth,
}

impl Scene {
    /// Writes the frame's files and `truth.json` into `folder`, whole or not at all.
    ///
    /// The files come together in a folder beside it, which then takes its
    /// name. A scene that was there before is replaced; other files are not.
    ///
    /// # Errors
    ///
    /// [`SceneError::Occupied`] where the folder holds files and no
    /// `truth.json`, [`SceneError::Io`] and [`SceneError::Frame`] where a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), SceneError> {
        let folder = folder.as_ref();
        let occupied = is_occupied(folder)?;
        if occupied && !folder.join(TRUTH_FILE).is_file() {
            return Err(SceneError::Occupied {
                path: folder.into(),
            });
        }
        let part = beside(folder);
        let result = self
            .write_parts(&part)
            .and_then(|()| replace(folder, &part));
        if result.is_err() {
            // The error to report is the first one; what is left of the part is of no use.
            let _ = std::fs::remove_dir_all(&part);
        }
        result
    }

    fn write_parts(&self, folder: &Path) -> Result<(), SceneError> {
        std::fs::create_dir_all(folder).map_err(|e| SceneError::io(folder, e))?;
        self.frame.write(folder)?;
        self.truth.write(folder.join(TRUTH_FILE))
    }
}

fn is_occupied(folder: &Path) -> Result<bool, SceneError> {
    match std::fs::read_dir(folder) {
        Ok(mut entries) => Ok(entries.next().is_some()),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(false),
        Err(e) => Err(SceneError::io(folder, e)),
    }
}

/// A hidden sibling: on the same file system, so that it can be renamed.
fn beside(folder: &Path) -> PathBuf {
    let name = folder
        .file_name()
        .map_or_else(|| "scene".into(), |n| n.to_string_lossy());
    folder.with_file_name(format!(".{name}.part-{}", std::process::id()))
}

fn replace(folder: &Path, part: &Path) -> Result<(), SceneError> {
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(|e| SceneError::io(folder, e))?;
    }
    std::fs::rename(part, folder).map_err(|e| SceneError::io(folder, e))
}
