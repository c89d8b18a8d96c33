use crate::error::LabelsError;
use crate::strokes::ImageStrokes;
use pomona_cloud::Frame;
use std::path::{Path, PathBuf};

/// Folders beside a file or within the folder given in which images are looked for.
const INSIDE: [&str; 4] = ["", "images", "train/images", "val/images"];

/// An image with strokes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SegmentationImage {
    /// Its strokes, and its name.
    pub strokes: ImageStrokes,
    /// Its file.
    pub path: PathBuf,
}

/// The images that `strokes` name, in `folder` or its `images/`; a name without an ending is a frame's folder.
///
/// # Errors
///
/// [`LabelsError::Malformed`] for strokes without an image, and for an image that is not there.
pub fn segmentation_images(
    folder: &Path,
    strokes: Vec<ImageStrokes>,
    file: &Path,
) -> Result<Vec<SegmentationImage>, LabelsError> {
    if strokes.is_empty() {
        return Err(LabelsError::malformed(
            file,
            "it names no image",
            "write `image NAME` before its strokes",
        ));
    }
    let find = |name: &str| {
        let direct = INSIDE.iter().map(|inside| folder.join(inside).join(name));
        let frame = Frame::COLOR_FILES
            .iter()
            .map(|color| folder.join(name).join(color));
        let own = folder
            .ends_with(name)
            .then(|| Frame::COLOR_FILES.iter().map(|color| folder.join(color)));
        direct
            .chain(frame)
            .chain(own.into_iter().flatten())
            .find(|path| path.is_file())
    };
    let image = |strokes: ImageStrokes| {
        let path = find(&strokes.name).ok_or_else(|| {
            let problem = format!(
                "{}, which {} names, is not there",
                strokes.name,
                file.display()
            );
            LabelsError::malformed(
                folder,
                &problem,
                "give the folder of the images, or of their `images/`",
            )
        })?;
        Ok(SegmentationImage { strokes, path })
    };
    strokes.into_iter().map(image).collect()
}

/// The photograph that a tile is cut from: its name up to the number at its end, `DSC_0012_7.jpg` of `DSC_0012`; the
/// whole name where there is no such number.
pub fn photograph(name: &str) -> &str {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    match stem.rsplit_once('_') {
        Some((photograph, tile))
            if !tile.is_empty() && tile.bytes().all(|b| b.is_ascii_digit()) =>
        {
            photograph
        }
        _ => stem,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_belong_to_photographs() {
        for (name, expected) in [
            ("DSC_1043_17kv1r17k_10.jpg", "DSC_1043_17kv1r17k"),
            ("orchard-1218", "orchard-1218"),
            ("a_.png", "a_"),
            ("photo.jpg", "photo"),
            ("12.jpg", "12"),
        ] {
            assert_eq!(photograph(name), expected);
        }
    }
}
