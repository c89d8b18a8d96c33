use anyhow::{anyhow, bail};
use pomona_cloud::Frame;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// One image and the name that its results bear.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NamedImage {
    /// The file's name without its ending, or the frame's.
    pub(crate) name: String,
    /// The file.
    pub(crate) path: PathBuf,
    /// What a data set calls it: the file's name, for a frame's image with that of the frame's folder before it.
    pub(crate) file_name: String,
}

/// The colour images that arguments stand for: files, frames, folders of images or of frames.
pub(crate) fn images(arguments: &[PathBuf]) -> anyhow::Result<Vec<NamedImage>> {
    let mut images = Vec::new();
    for argument in arguments {
        if argument.is_dir() {
            images.extend(of_folder(argument)?);
        } else {
            images.push(named(argument));
        }
    }
    let mut seen: HashMap<&str, &Path> = HashMap::new();
    for image in &images {
        if let Some(first) = seen.insert(&image.name, &image.path) {
            bail!(
                "{} and {}: results of both would be named `{}`; give them in runs of their own",
                first.display(),
                image.path.display(),
                image.name
            );
        }
    }
    Ok(images)
}

fn of_folder(folder: &Path) -> anyhow::Result<Vec<NamedImage>> {
    if let Some(frame) = frame(folder) {
        return Ok(vec![frame]);
    }
    let refused = |e: std::io::Error| anyhow!("{}: {e}; check the folder", folder.display());
    let mut inside: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        inside.push(entry.map_err(refused)?.path());
    }
    inside.sort();
    let files: Vec<NamedImage> = inside
        .iter()
        .filter(|path| path.is_file() && is_image(path))
        .map(|path| named(path))
        .collect();
    if !files.is_empty() {
        return Ok(files);
    }
    let frames: Vec<NamedImage> = inside.iter().filter_map(|path| frame(path)).collect();
    if frames.is_empty() {
        bail!(
            "{}: neither a frame (color.png or color.jpg) nor images (PNG, JPEG) nor frames in it; give images",
            folder.display()
        );
    }
    Ok(frames)
}

fn is_image(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let known = ["png", "jpg", "jpeg"];
    let is_hidden = path
        .file_name()
        .is_some_and(|n| n.to_string_lossy().starts_with('.'));
    !is_hidden && known.iter().any(|e| ending.eq_ignore_ascii_case(e))
}

fn frame(folder: &Path) -> Option<NamedImage> {
    let path = Frame::color_file(folder)?;
    let own = folder.file_name().map(ToOwned::to_owned);
    let name = own.or_else(|| {
        folder
            .canonicalize()
            .ok()?
            .file_name()
            .map(ToOwned::to_owned)
    })?;
    let name = name.to_string_lossy().into_owned();
    Some(NamedImage {
        file_name: format!("{name}/{}", file_name(&path)),
        name,
        path,
    })
}

fn named(path: &Path) -> NamedImage {
    let stem = path.file_stem().unwrap_or_default();
    NamedImage {
        name: stem.to_string_lossy().into_owned(),
        path: path.to_owned(),
        file_name: file_name(path),
    }
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_frames_and_folders_of_both() {
        let dir = tempfile::tempdir().unwrap();
        let touch = |name: &str| {
            let path = dir.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        };
        for name in [
            "photos/b.JPG",
            "photos/a.png",
            "photos/.c.png",
            "photos/notes.txt",
            "f/two/color.jpg",
            "f/one/color.png",
        ] {
            touch(name);
        }
        let names = |arguments: &[&str]| -> Result<Vec<String>, String> {
            let paths: Vec<PathBuf> = arguments.iter().map(|a| dir.path().join(a)).collect();
            let found = images(&paths).map_err(|e| e.to_string())?;
            Ok(found.into_iter().map(|image| image.name).collect())
        };
        assert_eq!(names(&["photos", "f/one"]).unwrap(), ["a", "b", "one"]);
        assert_eq!(names(&["f", "photos/a.png"]).unwrap(), ["one", "two", "a"]);
        assert!(
            names(&["photos", "photos/a.png"])
                .unwrap_err()
                .contains("`a`")
        );
        touch("empty/x.txt");
        assert!(names(&["empty"]).unwrap_err().contains("give images"));
    }
}
