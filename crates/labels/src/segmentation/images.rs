use super::mask::{MaskValues, TruthMask};
use crate::error::LabelsError;
use crate::strokes::ImageStrokes;
use pomona_cloud::Frame;
use std::path::{Path, PathBuf};

/// Folders beside a file or within the folder given in which images are looked for.
const INSIDE: [&str; 4] = ["", "images", "train/images", "val/images"];

/// Endings of images.
const ENDINGS: [&str; 6] = ["png", "jpg", "jpeg", "PNG", "JPG", "JPEG"];

/// The ending of a mask of wood where a folder holds other images too.
const OF_WOOD: &str = ".wood.png";

/// The ending of a mask where no file in the folder has the other.
const PNG: &str = ".png";

/// An image of which the wood is known.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SegmentationImage {
    /// Its file name, or the name of a frame's folder.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// Where its wood is.
    pub truth: SegmentationTruth,
}

/// Where the wood of an image is.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SegmentationTruth {
    /// Centre lines drawn by eye.
    Strokes(ImageStrokes),
    /// A mask, read when the image is.
    Mask(TruthMask),
}

impl SegmentationImage {
    /// Its strokes, where these are the truth.
    pub fn strokes(&self) -> Option<&ImageStrokes> {
        match &self.truth {
            SegmentationTruth::Strokes(strokes) => Some(strokes),
            SegmentationTruth::Mask(_) => None,
        }
    }
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
        direct
            .chain(frame_images(folder, name))
            .find(|p| p.is_file())
    };
    let image = |strokes: ImageStrokes| {
        let path = find(&strokes.name)
            .ok_or_else(|| not_there(folder, &strokes.name, &file.display().to_string()))?;
        Ok(SegmentationImage {
            name: strokes.name.clone(),
            path,
            truth: SegmentationTruth::Strokes(strokes),
        })
    };
    strokes.into_iter().map(image).collect()
}

/// The images in `folder`, or in its `images/`, of which there is a mask in the folder `masks`, in the order of their
/// names.
///
/// Masks are `NAME.wood.png`, or where there is none of these `NAME.png`: 255 is wood, 0 is none. `classes` is the file
/// that a frame's folder holds in their place, and the number of wood in it; `masks` may be one such frame, or a
/// folder of them.
///
/// # Errors
///
/// [`LabelsError::Io`], and [`LabelsError::Malformed`] for a folder without masks and for a mask without an image.
pub fn masked_images(
    folder: &Path,
    masks: &Path,
    (classes, wood): (&str, u8),
) -> Result<Vec<SegmentationImage>, LabelsError> {
    let of_frame = |frame: &Path| {
        let path = frame.join(classes);
        let name = frame.file_name()?.to_string_lossy().into_owned();
        let values = MaskValues::Classes { wood };
        path.is_file().then_some((name, TruthMask { path, values }))
    };
    let found = if let Some(frame) = of_frame(masks) {
        vec![frame]
    } else {
        let inside = entries(masks)?;
        let mut found: Vec<_> = inside.iter().filter_map(|path| of_frame(path)).collect();
        found.extend(masks_of_wood(&inside));
        found.sort_by(|a, b| a.0.cmp(&b.0));
        found
    };
    if found.is_empty() {
        let problem = format!("neither NAME{OF_WOOD}, NAME{PNG} nor a frame's {classes} is in it");
        let remedy = "give the folder of the masks of these images";
        return Err(LabelsError::malformed(masks, &problem, remedy));
    }
    let image = |(name, mask): (String, TruthMask)| {
        let files = INSIDE.iter().flat_map(|inside| {
            ENDINGS.map(|ending| folder.join(inside).join(format!("{name}.{ending}")))
        });
        let path = files
            .chain(frame_images(folder, &name))
            .find(|path| path.is_file() && !is_same(path, &mask.path))
            .ok_or_else(|| not_there(folder, &name, &mask.path.display().to_string()))?;
        let is_file = path.file_stem().is_some_and(|stem| *stem == *name);
        let own = path.file_name().filter(|_| is_file);
        Ok(SegmentationImage {
            name: own.map_or(name, |own| own.to_string_lossy().into_owned()),
            path,
            truth: SegmentationTruth::Mask(mask),
        })
    };
    found.into_iter().map(image).collect()
}

/// The masks of wood among files, each with the name of its image.
fn masks_of_wood(files: &[PathBuf]) -> Vec<(String, TruthMask)> {
    let with = |ending: &str| -> Vec<(String, TruthMask)> {
        let mask = |path: &PathBuf| {
            let name = path.file_name()?.to_string_lossy();
            let name = name.strip_suffix(ending).filter(|_| path.is_file())?;
            let mask = TruthMask {
                path: path.clone(),
                values: MaskValues::Wood,
            };
            Some((name.to_owned(), mask))
        };
        files.iter().filter_map(mask).collect()
    };
    let of_wood = with(OF_WOOD);
    if of_wood.is_empty() {
        with(PNG)
    } else {
        of_wood
    }
}

/// What is in a folder.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, LabelsError> {
    let refused = |source| LabelsError::Io {
        path: folder.to_owned(),
        source,
    };
    let entries = std::fs::read_dir(folder).map_err(refused)?;
    entries
        .map(|entry| Ok(entry.map_err(refused)?.path()))
        .collect()
}

/// Where the colour image of the frame of this name may be: in its folder within `folder`, or in that itself.
fn frame_images(folder: &Path, name: &str) -> impl Iterator<Item = PathBuf> {
    let own = folder.ends_with(name).then(|| folder.to_owned());
    std::iter::once(folder.join(name))
        .chain(own)
        .flat_map(|frame| Frame::COLOR_FILES.map(|color| frame.join(color)))
}

/// Whether two paths are of one file.
fn is_same(a: &Path, b: &Path) -> bool {
    a == b
        || a.canonicalize()
            .ok()
            .is_some_and(|a| b.canonicalize().ok() == Some(a))
}

fn not_there(folder: &Path, name: &str, named_by: &str) -> LabelsError {
    let problem = format!("{name}, which {named_by} names, is not there");
    let remedy = "give the folder of the images, or of their `images/`";
    LabelsError::malformed(folder, &problem, remedy)
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
