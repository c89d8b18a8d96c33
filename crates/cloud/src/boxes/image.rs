//! Which image of a box file is the one whose boxes are wanted.

use super::parsed::{ImageBoxes, Parsed};
use crate::folder::{COLOR_FILES, folder_name};
use pomona_files::{Malformed, Warning, WarningCode};
use std::path::{Path, PathBuf};

/// How many names a message lists.
const SHOWN: usize = 5;

/// The image whose boxes are wanted of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BoxImage {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Its file, by whose name it is found in a file with the boxes of several images.
    pub path: Option<PathBuf>,
}

/// How well a name in a box file fits the image; the best one counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Fit {
    /// The file's name, in another folder.
    OtherFolder,
    /// The file's name, or that of a frame's folder.
    Name,
    /// The file's name and its folder's.
    Whole,
}

impl BoxImage {
    /// An image of this size; a file with the boxes of several images is then refused.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            path: None,
        }
    }

    /// The same, and its file.
    #[must_use]
    pub fn at(self, path: impl Into<PathBuf>) -> Self {
        Self {
            path: Some(path.into()),
            ..self
        }
    }

    /// The boxes of this image; `file` is the box file.
    pub(super) fn choose(
        &self,
        file: &Path,
        parsed: Parsed,
    ) -> Result<(ImageBoxes, Vec<Warning>), Malformed> {
        let is_own = parsed.is_of_one
            && self
                .path
                .as_ref()
                .is_some_and(|image| image.parent() == file.parent());
        let Parsed {
            mut images,
            mut warnings,
            ..
        } = parsed;
        let file = file.file_name().unwrap_or_default().to_string_lossy();
        let Some(chosen) = self.position(&images)? else {
            return Ok((ImageBoxes::default(), warnings));
        };
        let others: usize = images.iter().map(|image| image.labels.len()).sum();
        let chosen = images.swap_remove(chosen);
        if let (Some(name), Some(path), false) = (&chosen.name, &self.path, is_own)
            && self.fit(name).is_none()
        {
            warnings.push(Warning::new(
                WarningCode::BoxImageAssumed,
                format!(
                    "{file}: its boxes are of {name}, the only image in it, which is taken for {}",
                    shown(path)
                ),
            ));
        }
        self.check_size(&chosen)?;
        if chosen.labels.is_empty() && others > 0 {
            warnings.push(Warning::new(
                WarningCode::NoBoxesOfImage,
                format!(
                    "{file}: none of its {others} boxes is of this image, {}; they are of other images",
                    chosen.name.as_deref().unwrap_or("which it lists")
                ),
            ));
        }
        Ok((chosen, warnings))
    }

    fn position(&self, images: &[ImageBoxes]) -> Result<Option<usize>, Malformed> {
        let fits = |image: &ImageBoxes| self.fit(image.name.as_deref()?);
        let best = images.iter().filter_map(fits).max();
        let those: Vec<usize> = match best {
            Some(best) => (0..images.len())
                .filter(|&k| fits(&images[k]) == Some(best))
                .collect(),
            None => Vec::new(),
        };
        match (&*those, images) {
            ([one], _) => Ok(Some(*one)),
            (_, []) => Ok(None),
            ([], [_]) => Ok(Some(0)),
            _ => self.without_name(images, &those),
        }
    }

    /// Of several images none or more than one fits.
    fn without_name(
        &self,
        images: &[ImageBoxes],
        those: &[usize],
    ) -> Result<Option<usize>, Malformed> {
        if self.path.is_none() {
            let with_boxes: Vec<usize> = (0..images.len())
                .filter(|&k| !images[k].labels.is_empty())
                .collect();
            match &*with_boxes {
                [] => return Ok(Some(0)),
                [one] => return Ok(Some(*one)),
                _ => {}
            }
        }
        let which: Vec<&ImageBoxes> = if those.is_empty() {
            images.iter().collect()
        } else {
            those.iter().map(|&k| &images[k]).collect()
        };
        let names: Vec<String> = which
            .iter()
            .take(SHOWN)
            .map(|image| image.title())
            .collect();
        let more = if which.len() > SHOWN { ", …" } else { "" };
        let problem = match (&self.path, those) {
            (None, _) => format!("boxes of several images: {}{more}", names.join(", ")),
            (Some(path), []) => format!(
                "boxes of {} images, {}{more}, and none of them is {}",
                images.len(),
                names.join(", "),
                shown(path)
            ),
            (Some(path), _) => format!(
                "several images could be {}: {}{more}",
                shown(path),
                names.join(", ")
            ),
        };
        let remedy = "keep those of this frame's image only, or name it in the file as it is here: FRAME/color.png, \
                      color.png, or the frame's name";
        Err(Malformed::new("images", problem, remedy))
    }

    fn check_size(&self, image: &ImageBoxes) -> Result<(), Malformed> {
        let (width, height) = (self.width as f64, self.height as f64);
        let Some((place, stated)) = &image.size else {
            return Ok(());
        };
        // Some tools write zeros where they do not know.
        if *stated == [0.0, 0.0] || *stated == [width, height] {
            return Ok(());
        }
        let [stated_width, stated_height] = stated;
        let turned = if [*stated_height, *stated_width] == [width, height] {
            ", which a viewer turns by 90 degrees if its EXIF data say so"
        } else {
            ""
        };
        let problem = format!(
            "boxes of an image of {stated_width}x{stated_height} but the image is {width}x{height}{turned}"
        );
        Err(Malformed::new(
            place,
            problem,
            "give the boxes of this image, in its pixels",
        ))
    }

    fn fit(&self, name: &str) -> Option<Fit> {
        let path = self.path.as_deref()?;
        let own = path.file_name()?.to_string_lossy().into_owned();
        let folder = path.parent().map(folder_name).unwrap_or_default();
        let mut parts = name.rsplit(['/', '\\']).filter(|part| !part.is_empty());
        let (named, named_folder) = (parts.next()?, parts.next());
        if own.eq_ignore_ascii_case(named) {
            return Some(match named_folder {
                Some(other) if other == folder => Fit::Whole,
                Some(_) => Fit::OtherFolder,
                None => Fit::Name,
            });
        }
        let is_frame = COLOR_FILES.iter().any(|f| own.eq_ignore_ascii_case(f));
        let stem = stem(named);
        let same = stem.eq_ignore_ascii_case(stem_of(&own))
            || (is_frame && stem.eq_ignore_ascii_case(&folder));
        same.then_some(Fit::Name)
    }
}

/// A file's name and its folder's.
fn shown(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match path
        .parent()
        .map(folder_name)
        .filter(|folder| !folder.is_empty())
    {
        Some(folder) => format!("{folder}/{name}"),
        None => name.into_owned(),
    }
}

/// A name without its ending, and without what Roboflow appends: `a_png.rf.0123abcd.jpg` was `a.png`.
fn stem(name: &str) -> &str {
    match name.split_once(".rf.") {
        Some((before, _)) => {
            let endings = ["_png", "_jpg", "_jpeg"];
            endings
                .iter()
                .find_map(|e| before.strip_suffix(e))
                .unwrap_or(before)
        }
        None => stem_of(name),
    }
}

/// A name without the ending of a picture.
fn stem_of(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, ending)) if !stem.is_empty() && ending.len() <= 4 => stem,
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LabelledBox, PixelBox};

    fn image(name: &str, boxes: usize) -> ImageBoxes {
        let label = LabelledBox::new(PixelBox {
            name: name.to_owned(),
            x_min: 1.0,
            y_min: 1.0,
            x_max: 2.0,
            y_max: 2.0,
            score: 1.0,
        });
        ImageBoxes {
            name: (!name.is_empty()).then(|| name.to_owned()),
            labels: vec![label; boxes],
            ..ImageBoxes::default()
        }
    }

    fn chosen(
        path: &str,
        images: &[ImageBoxes],
    ) -> Result<(Option<String>, Vec<WarningCode>), String> {
        let parsed = Parsed {
            images: images.to_vec(),
            ..Parsed::default()
        };
        let (image, warnings) = BoxImage::new(4, 4)
            .at(path)
            .choose(Path::new("boxes.json"), parsed)
            .map_err(|e| e.problem)?;
        let first = image.labels.first().map(|label| label.bounds.name.clone());
        Ok((first, warnings.into_iter().map(|w| w.code).collect()))
    }

    #[test]
    fn an_image_is_found_by_its_name_its_folder_or_its_frame() {
        let found = |path: &str, names: &[&str]| {
            let images: Vec<_> = names.iter().map(|name| image(name, 1)).collect();
            let (name, warnings) = chosen(path, &images).unwrap();
            assert!(warnings.is_empty(), "{warnings:?}");
            name.unwrap()
        };
        assert_eq!(
            found("a/color.png", &["a/color.png", "b/color.png"]),
            "a/color.png"
        );
        assert_eq!(
            found("f/b/color.png", &["a\\color.png", "b\\color.png"]),
            "b\\color.png"
        );
        assert_eq!(found("a/color.png", &["x.png", "Color.PNG"]), "Color.PNG");
        assert_eq!(
            found("a/color.png", &["x.png", "images/color.png"]),
            "images/color.png"
        );
        assert_eq!(found("a/color.png", &["b.jpg", "a.jpg"]), "a.jpg");
        assert_eq!(
            found("a/color.png", &["b_jpg.rf.0a1.jpg", "a_jpg.rf.9b.jpg"]),
            "a_jpg.rf.9b.jpg"
        );
        assert_eq!(found("photos/x.png", &["photos.png", "x.jpg"]), "x.jpg");
    }

    #[test]
    fn boxes_of_other_images_are_not_taken_silently() {
        let both = [image("color.png", 0), image("other.png", 3)];
        let (name, warnings) = chosen("a/color.png", &both).unwrap();
        assert_eq!(
            (name, &*warnings),
            (None, &[WarningCode::NoBoxesOfImage][..])
        );
        let (name, warnings) = chosen("a/color.png", &[image("IMG_7.jpg", 1)]).unwrap();
        assert_eq!(
            (name.as_deref(), &*warnings),
            (Some("IMG_7.jpg"), &[WarningCode::BoxImageAssumed][..])
        );
        assert_eq!(
            chosen("a/color.png", &[image("", 1)]).unwrap(),
            (Some(String::new()), vec![])
        );
        let none = chosen("a/color.png", &[image("x.png", 1), image("y.png", 1)]).unwrap_err();
        assert!(
            none.contains("x.png, y.png") && none.contains("a/color.png"),
            "{none}"
        );
        let several = chosen(
            "c/color.png",
            &[image("a/color.png", 1), image("b/color.png", 1)],
        )
        .unwrap_err();
        assert!(
            several.contains("several images could be c/color.png"),
            "{several}"
        );
    }
}
