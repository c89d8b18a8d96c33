use crate::error::SceneError;
use crate::truth::{TRUTH_FILE, Truth};
use pomona_cloud::{Frame, GrayImage};
use pomona_files::{FileError, temporary_beside};
use std::path::{Path, PathBuf};

/// A frame and its ground truth.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// What a program is given.
    pub frame: Frame,
    /// What it should find.
    pub truth: Truth,
    /// The [`SceneClass`] of each pixel of the colour image; `None` where it is not known.
    pub classes: Option<GrayImage>,
    /// The stretches of wood that the colour image shows; `None` where they are not known.
    pub wood: Option<Vec<VisibleWood>>,
}

/// A stretch of a limb of wood that shows in the colour image, as a person would draw it: its centre line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct VisibleWood {
    /// Right, down and half width, pixels, the upper left corner of the image being (0, 0).
    pub points: Vec<[f64; 3]>,
    /// Mean depth, metres.
    pub depth_m: f64,
}

impl Scene {
    /// A frame and its truth, without the classes of its pixels and the wood that shows.
    pub fn new(frame: Frame, truth: Truth) -> Self {
        Self {
            frame,
            truth,
            classes: None,
            wood: None,
        }
    }

    /// Writes the frame's files, `classes.png` and `truth.json` into `folder`, whole or not at all.
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
        if let Some(classes) = &self.classes {
            classes.write(folder.join(CLASSES_FILE))?;
        }
        self.truth.write(folder.join(TRUTH_FILE))
    }
}

/// The file of a scene's [`SceneClass`]es.
pub const CLASSES_FILE: &str = "classes.png";

/// What a pixel shows, as its value in [`Scene::classes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
#[non_exhaustive]
pub enum SceneClass {
    /// Leaves, the backdrop and the sky.
    Rest = 0,
    /// Branches and spurs.
    Wood = 1,
    /// Green stems: the stalks of fruit, and those of leaves.
    Peduncle = 2,
    /// Apples.
    Fruit = 3,
}

/// The files of a scene's folder.
const FILES: [&str; 6] = [
    "color.png",
    "depth.png",
    "camera.json",
    "boxes.xml",
    CLASSES_FILE,
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
