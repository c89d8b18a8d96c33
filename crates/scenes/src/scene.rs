use crate::error::SceneError;
use crate::truth::{TRUTH_FILE, Truth};
use pomona_cloud::Frame;
use pomona_files::{FileError, temporary_beside};
use std::path::{Path, PathBuf};

/// A frame and its ground truth.
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
    /// name. A scene that was there before is replaced; a folder with any other file is refused.
    ///
    /// # Errors
    ///
    /// [`SceneError::Occupied`] where the folder holds files that no scene has, [`SceneError::File`] and
    /// [`SceneError::Frame`] where a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), SceneError> {
        let folder = folder.as_ref();
        if let Some(path) = foreign_entry(folder)? {
            return Err(SceneError::Occupied { path });
        }
        let part = temporary_beside(folder);
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
        std::fs::create_dir_all(folder).map_err(|e| FileError::write(folder, e))?;
        self.frame.write(folder)?;
        self.truth.write(folder.join(TRUTH_FILE))
    }
}

/// The files of a scene's folder.
const FILES: [&str; 5] = [
    "color.png",
    "depth.png",
    "camera.json",
    "boxes.xml",
    TRUTH_FILE,
];

/// Something in the folder that no scene puts there: in a folder without a truth, anything.
fn foreign_entry(folder: &Path) -> Result<Option<PathBuf>, SceneError> {
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(FileError::read(folder, e).into()),
    };
    let is_scene = folder.join(TRUTH_FILE).is_file();
    for entry in entries {
        let entry = entry.map_err(|e| FileError::read(folder, e))?;
        let ours = is_scene
            && entry
                .file_name()
                .to_str()
                .is_some_and(|name| FILES.contains(&name));
        if !ours || entry.path().is_dir() {
            return Ok(Some(entry.path()));
        }
    }
    Ok(None)
}

fn replace(folder: &Path, part: &Path) -> Result<(), SceneError> {
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(|e| FileError::write(folder, e))?;
    }
    std::fs::rename(part, folder).map_err(|e| FileError::write(folder, e))?;
    Ok(())
}
