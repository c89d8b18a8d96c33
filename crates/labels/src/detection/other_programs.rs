use crate::dataset::listing::{files_below, is_about_labels, is_label};
use crate::dataset::{LabelledDataset, LabelledImage};
use crate::error::LabelsError;
use pomona_cloud::{BoxImage, CocoDataset, ImageKey, LabelledBox, read_coco_results, read_labels};
use pomona_detect::{ClassChoice, Detection};
use std::collections::HashMap;
use std::path::Path;

/// Reads the boxes that another program detected in the images of `dataset`; only those of `class`, where one is given.
///
/// `path` is a COCO result list (images by their number in the COCO file, or by their name), a COCO file whose boxes
/// have scores, or a folder with a YOLO or VOC file for each image, itself or in its `labels/`. An image that is not
/// mentioned has no detections. A YOLO or VOC box without a score has the score 1.
///
/// # Errors
///
/// [`LabelsError`]: files that cannot be read, and detections in an image that the data set does not hold.
pub fn read_detections(
    path: impl AsRef<Path>,
    dataset: &LabelledDataset,
    class: Option<&ClassChoice>,
) -> Result<Vec<Vec<Detection>>, LabelsError> {
    let path = path.as_ref();
    let index = ImageIndex::new(dataset);
    let mut boxes: Vec<Vec<LabelledBox>> = vec![Vec::new(); dataset.images.len()];
    if path.is_dir() {
        from_folder(path, dataset, &index, &mut boxes)?;
    } else {
        from_file(path, &index, &mut boxes)?;
    }
    let is_of = |label: &LabelledBox| match class {
        None => true,
        Some(ClassChoice::Number(number)) => label.class_number == Some(*number as u64),
        Some(ClassChoice::Name(name)) => label.class_name.as_deref() == Some(name),
    };
    let all = || boxes.iter().flatten();
    if all().next().is_some() && !all().any(is_of) {
        return Err(LabelsError::malformed(
            path,
            "no detection is of the class asked for",
            "give another by --class",
        ));
    }
    let detection = |label: &LabelledBox| Detection {
        x_min: label.bounds.x_min,
        y_min: label.bounds.y_min,
        x_max: label.bounds.x_max,
        y_max: label.bounds.y_max,
        score: label.bounds.score,
        class: label
            .class_number
            .and_then(|n| usize::try_from(n).ok())
            .unwrap_or_default(),
    };
    let of_image =
        |boxes: &Vec<LabelledBox>| boxes.iter().filter(|l| is_of(l)).map(detection).collect();
    Ok(boxes.iter().map(of_image).collect())
}

fn from_folder(
    folder: &Path,
    dataset: &LabelledDataset,
    index: &ImageIndex,
    boxes: &mut [Vec<LabelledBox>],
) -> Result<(), LabelsError> {
    let labels = folder.join("labels");
    let place = if labels.is_dir() {
        labels
    } else {
        folder.to_owned()
    };
    let files = files_below(&place)?;
    let mut any = false;
    for file in files.iter().filter(|f| is_label(f) && !is_about_labels(f)) {
        let below = file.strip_prefix(&place).unwrap_or(file).with_extension("");
        let parts: Vec<_> = below.iter().map(|part| part.to_string_lossy()).collect();
        let image = index.find(&parts.join("/")).ok_or_else(|| {
            let problem = format!("no image of this name in {}", dataset.name);
            LabelsError::malformed(
                file,
                &problem,
                "remove it, or give the labels of its image too",
            )
        })?;
        if !boxes[image].is_empty() {
            return Err(LabelsError::malformed(
                file,
                "its image has detections of another file",
                "keep one of the two",
            ));
        }
        let LabelledImage {
            width,
            height,
            path,
            ..
        } = &dataset.images[image];
        let about = BoxImage::new(*width, *height).at(path);
        boxes[image] = read_labels(file, &about)?.value;
        any = true;
    }
    if any {
        return Ok(());
    }
    Err(LabelsError::malformed(
        &place,
        "no YOLO, VOC or COCO file",
        "give the folder with a file of boxes for each image, or a COCO result list",
    ))
}

fn from_file(
    path: &Path,
    index: &ImageIndex,
    boxes: &mut [Vec<LabelledBox>],
) -> Result<(), LabelsError> {
    let unknown = |name: &str| {
        let problem = format!("detections in image {name}, which the labels do not name");
        LabelsError::malformed(path, &problem, "give the detections in these images only")
    };
    let text = std::fs::read(path).map_err(|source| LabelsError::Io {
        path: path.to_owned(),
        source,
    })?;
    let first = text.iter().find(|byte| !byte.is_ascii_whitespace());
    if first == Some(&b'{') {
        for image in CocoDataset::read(path)?.images {
            match index.find(&image.file_name) {
                Some(at) => boxes[at].extend(image.boxes),
                None if image.boxes.is_empty() => {}
                None => return Err(unknown(&image.file_name)),
            }
        }
        return Ok(());
    }
    for result in read_coco_results(path)? {
        let key = &result.image;
        let at = index
            .identified(key)
            .or_else(|| index.find(&key.to_string()));
        let Some(at) = at else {
            return Err(unknown(&key.to_string()));
        };
        boxes[at].push(result.label);
    }
    Ok(())
}

/// Images by their names, with or without path and extension; ambiguous names are left out.
struct ImageIndex {
    names: HashMap<String, Option<usize>>,
    keys: HashMap<ImageKey, usize>,
}

impl ImageIndex {
    fn new(dataset: &LabelledDataset) -> Self {
        let mut names: HashMap<String, Option<usize>> = HashMap::new();
        let mut keys = HashMap::new();
        // A whole path takes precedence over a short name.
        for (at, image) in dataset.images.iter().enumerate() {
            names.insert(image.name.clone(), Some(at));
            keys.extend(image.coco_id.clone().map(|id| (id, at)));
        }
        for (at, image) in dataset.images.iter().enumerate() {
            let file = image.name.rsplit('/').next().unwrap_or(&image.name);
            for short in [
                without_extension(&image.name),
                file,
                without_extension(file),
            ] {
                let known = names.entry(short.to_owned()).or_insert(Some(at));
                if *known != Some(at) && dataset.images.iter().all(|other| other.name != short) {
                    *known = None;
                }
            }
        }
        Self { names, keys }
    }

    fn find(&self, name: &str) -> Option<usize> {
        let file = name.rsplit('/').next().unwrap_or(name);
        let candidates = [name, without_extension(name), file, without_extension(file)];
        // A frame's image is called after its folder.
        let frame = name
            .rsplit_once('/')
            .filter(|_| without_extension(file) == "color");
        let candidates = candidates
            .into_iter()
            .chain(frame.map(|(folder, _)| folder.rsplit('/').next().unwrap_or(folder)));
        candidates
            .into_iter()
            .find_map(|name| self.names.get(name).copied().flatten())
    }

    /// By what identifies it in a COCO file.
    fn identified(&self, key: &ImageKey) -> Option<usize> {
        self.keys.get(key).copied()
    }
}

/// A file's name without the extension of a picture.
fn without_extension(name: &str) -> &str {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    let is_picture = ["png", "jpg", "jpeg"]
        .iter()
        .any(|e| ending.eq_ignore_ascii_case(e));
    if is_picture { stem } else { name }
}
