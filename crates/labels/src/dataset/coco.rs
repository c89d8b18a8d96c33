use super::images::{LabelForm, LabelledDataset, LabelledImage};
use super::listing::{entries, folder_name};
use crate::error::LabelsError;
use pomona_cloud::{CocoDataset, ColorImage};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The COCO file of a folder, in it or in its `annotations/`; `None` where there is none.
pub(super) fn find(folder: &Path) -> Result<Option<PathBuf>, LabelsError> {
    let mut files = entries(folder)?;
    let annotations = folder.join("annotations");
    if annotations.is_dir() {
        files.extend(entries(&annotations)?);
    }
    let found: Vec<PathBuf> = files
        .into_iter()
        .filter(|path| {
            path.extension()
                .is_some_and(|e| e.eq_ignore_ascii_case("json"))
        })
        .filter(|path| is_named_so(path) || names_images(path))
        .collect();
    match &*found {
        [] => Ok(None),
        [one] => Ok(Some(one.clone())),
        [first, second, ..] => Err(LabelsError::malformed(
            folder,
            &format!(
                "several COCO files, {} and {}",
                first.display(),
                second.display()
            ),
            "give the file itself in place of the folder",
        )),
    }
}

/// Whether the name is that of COCO files, which then is to say what is wrong with it.
fn is_named_so(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    matches!(&*name, "annotations.json" | "_annotations.coco.json") || name.starts_with("instances")
}

/// Whether a file holds boxes of images that it names.
fn names_images(path: &Path) -> bool {
    #[derive(Deserialize)]
    #[expect(dead_code, reason = "what counts is that it is there")]
    struct Dataset {
        images: Vec<Image>,
        annotations: Vec<IgnoredAny>,
    }
    #[derive(Deserialize)]
    #[expect(dead_code, reason = "what counts is that it is there")]
    struct Image {
        file_name: String,
    }
    let bytes = std::fs::read(path).unwrap_or_default();
    serde_json::from_slice::<Dataset>(&bytes).is_ok_and(|dataset| !dataset.images.is_empty())
}

/// Reads a COCO file and finds its images.
pub(super) fn read(file: &Path) -> Result<LabelledDataset, LabelsError> {
    let coco = CocoDataset::read(file)?;
    let places = places(file);
    let Some(first) = coco.images.first() else {
        return Err(LabelsError::malformed(
            file,
            "no `images`",
            "list the images, each with id and file_name",
        ));
    };
    let place = places
        .iter()
        .find(|place| place.join(&first.file_name).is_file());
    let Some(place) = place else {
        let looked: Vec<String> = places
            .iter()
            .map(|place| place.display().to_string())
            .collect();
        let problem = format!(
            "its image {} is in none of {}",
            first.file_name,
            looked.join(", ")
        );
        return Err(LabelsError::malformed(
            file,
            &problem,
            "put the images there",
        ));
    };
    let mut names = BTreeSet::new();
    let mut turned = Vec::new();
    let mut images = Vec::with_capacity(coco.images.len());
    for image in coco.images {
        let path = place.join(&image.file_name);
        let (width, height) = ColorImage::read_size(&path)?;
        turned.extend(ColorImage::turned_by_exif(&path)?.map(|warning| (path.clone(), warning)));
        let stated = (image.width, image.height);
        if stated != (0, 0) && stated != (width, height) {
            let problem = format!(
                "{} is stated to be {}x{} but is {width}x{height}",
                image.file_name, image.width, image.height
            );
            return Err(LabelsError::malformed(
                file,
                &problem,
                "give the boxes of this image, in its pixels",
            ));
        }
        if !names.insert(image.file_name.clone()) {
            let problem = format!("{} is listed twice in `images`", image.file_name);
            return Err(LabelsError::malformed(
                file,
                &problem,
                "list each image once",
            ));
        }
        images.push(LabelledImage {
            coco_id: Some(image.id),
            boxes: image.boxes,
            ..LabelledImage::new(image.file_name, path, width, height)
        });
    }
    let mut dataset = LabelledDataset::new(folder_name(file), LabelForm::Coco, images);
    dataset.warnings = turned;
    Ok(dataset)
}

/// Where the images of a COCO file may lie: beside it, in `images/`, in a folder named as the file ends
/// (`instances_val2017.json`), and the same one folder up, where the file is in `annotations/`.
fn places(file: &Path) -> Vec<PathBuf> {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let split = stem.rsplit_once('_').map(|(_, split)| split.to_owned());
    let beside = file.parent().unwrap_or(Path::new(""));
    let mut places = Vec::new();
    let is_below = beside.file_name().is_some_and(|name| name == "annotations");
    let above = beside.parent().filter(|_| is_below);
    for base in [Some(beside), above].into_iter().flatten() {
        places.extend([base.to_owned(), base.join("images")]);
        if let Some(split) = split.as_deref().filter(|split| !split.is_empty()) {
            places.extend([base.join(split), base.join("images").join(split)]);
        }
    }
    places
}
