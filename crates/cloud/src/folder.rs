//! Names in a frame's folder, and its own.

use std::path::Path;

/// The names of the colour image in a frame's folder.
pub(crate) const COLOR_FILES: [&str; 6] = [
    "color.png",
    "color.jpg",
    "color.jpeg",
    "rgb.png",
    "rgb.jpg",
    "rgb.jpeg",
];

/// The folder's own name, also where the path is `.` or ends in `..`.
pub(crate) fn folder_name(dir: &Path) -> String {
    let name = dir.file_name().map(ToOwned::to_owned);
    let name = name.or_else(|| dir.canonicalize().ok()?.file_name().map(ToOwned::to_owned));
    name.unwrap_or_default().to_string_lossy().into_owned()
}
