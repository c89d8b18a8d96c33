use super::labelled::LabelledBox;
use pomona_files::Warning;

/// What a box file says, before an image and a class are chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Parsed {
    pub(super) images: Vec<ImageBoxes>,
    /// The names of all classes that the file declares, whether it has boxes of them or not.
    pub(super) classes: Vec<String>,
    /// What is doubtful about it.
    pub(super) warnings: Vec<Warning>,
    /// Whether its format has a file for each image: beside the image it is of that one, whatever its name was before it
    /// became a frame's.
    pub(super) is_of_one: bool,
}

/// The boxes of one image.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ImageBoxes {
    /// The image's file, as the box file names it.
    pub(super) name: Option<String>,
    /// Where the file states the image's width and height, and which.
    pub(super) size: Option<(String, [f64; 2])>,
    pub(super) labels: Vec<LabelledBox>,
}

impl Parsed {
    /// The boxes of the one image that a file is about.
    pub(super) fn of_one(image: ImageBoxes) -> Self {
        Self {
            images: vec![image],
            is_of_one: true,
            ..Self::default()
        }
    }
}

impl ImageBoxes {
    /// Its name for a message.
    pub(super) fn title(&self) -> String {
        self.name
            .clone()
            .unwrap_or_else(|| "one without a name".to_owned())
    }
}
