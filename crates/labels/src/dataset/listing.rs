use crate::error::LabelsError;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders within folders that are looked into at most: a link may lead round in a circle.
const DEEPEST: usize = 8;

/// What a folder holds, by name; hidden files are passed over.
pub(super) fn entries(folder: &Path) -> Result<Vec<PathBuf>, LabelsError> {
    let io = |source| LabelsError::Io {
        path: folder.to_owned(),
        source,
    };
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        if !entry.file_name().to_string_lossy().starts_with('.') {
            paths.push(entry.path());
        }
    }
    paths.sort();
    Ok(paths)
}

/// All files below a folder, by name.
pub(crate) fn files_below(folder: &Path) -> Result<Vec<PathBuf>, LabelsError> {
    fn walk(folder: &Path, depth: usize, into: &mut Vec<PathBuf>) -> Result<(), LabelsError> {
        for path in entries(folder)? {
            if !path.is_dir() {
                into.push(path);
            } else if depth < DEEPEST {
                walk(&path, depth + 1, into)?;
            }
        }
        Ok(())
    }
    let mut files = Vec::new();
    walk(folder, 0, &mut files)?;
    Ok(files)
}

/// Whether the name ends as that of a picture that can be read.
pub(super) fn is_image(path: &Path) -> bool {
    has_ending(path, &["png", "jpg", "jpeg"])
}

/// Whether the name ends as that of a label file.
pub(crate) fn is_label(path: &Path) -> bool {
    has_ending(path, &["txt", "xml", "json"])
}

/// Whether a file is of those that stand among labels and are none.
pub(crate) fn is_about_labels(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_ascii_lowercase();
    matches!(
        &*name,
        "classes.txt" | "predefined_classes.txt" | "notes.json"
    ) || name.starts_with("readme")
        || name.starts_with("license")
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    endings.iter().any(|e| ending.eq_ignore_ascii_case(e))
}

/// A path below `folder` as text with `/` between its parts.
pub(super) fn name_below(path: &Path, folder: &Path) -> String {
    let below = path.strip_prefix(folder).unwrap_or(path);
    let parts = below.iter().map(|part| part.to_string_lossy());
    parts.collect::<Vec<_>>().join("/")
}

/// The last part of a path, or of what it stands for where it is `.`.
pub(super) fn folder_name(path: &Path) -> String {
    let name = path.file_name().map(ToOwned::to_owned);
    let name = name.or_else(|| path.canonicalize().ok()?.file_name().map(ToOwned::to_owned));
    name.unwrap_or_default().to_string_lossy().into_owned()
}
