use super::class::StrokeClass;
use super::path::Stroke;

/// The strokes of one image.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ImageStrokes {
    /// The image's file name, or the name of a frame's folder.
    pub name: String,
    /// Its strokes, in the order of the file; none where nothing long and thin shows.
    pub strokes: Vec<Stroke>,
}

impl ImageStrokes {
    /// The strokes of the image of this name.
    pub fn new(name: impl Into<String>, strokes: Vec<Stroke>) -> Self {
        Self {
            name: name.into(),
            strokes,
        }
    }

    /// Those of a class.
    pub fn of(&self, class: StrokeClass) -> impl Iterator<Item = &Stroke> {
        self.strokes
            .iter()
            .filter(move |stroke| stroke.class == class)
    }
}
