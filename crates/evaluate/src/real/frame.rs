use super::brightness::{BRIGHTNESS_SHARE, brightened};
use crate::error::EvaluateError;
use pomona_cloud::{ColorImage, Frame, GrayImage, PixelBox};
use pomona_labels::{ImageStrokes, LabelsError, Stroke, StrokeClass, read_strokes};
use std::path::{Path, PathBuf};

/// The strokes of a frame, in its folder.
const STROKES: &str = "wood.txt";

/// A real frame and the strokes that a person drew in it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RealFrame {
    /// The frame, with boxes.
    pub frame: Frame,
    /// The strokes.
    pub strokes: ImageStrokes,
    /// The probability of wood (× 255) of each pixel, of a segmenter or another program; `None` where methods get none.
    pub wood: Option<GrayImage>,
    /// The same where the colour image is 15 % darker, for perturbed copies; `None`: as `wood`.
    pub darker_wood: Option<GrayImage>,
    /// The same where it is 15 % brighter.
    pub brighter_wood: Option<GrayImage>,
}

impl RealFrame {
    /// A frame with its strokes and without a probability of wood.
    pub fn new(frame: Frame, strokes: ImageStrokes) -> Self {
        Self {
            frame,
            strokes,
            wood: None,
            darker_wood: None,
            brighter_wood: None,
        }
    }

    /// Takes the probability of wood from what tells it for a colour image: for the frame's own, and with `copies` for
    /// those of perturbed copies too.
    ///
    /// # Errors
    ///
    /// Those of `tell`.
    pub fn tell_wood<E>(
        &mut self,
        tell: impl Fn(&ColorImage) -> Result<GrayImage, E>,
        copies: bool,
    ) -> Result<(), E> {
        self.wood = Some(tell(&self.frame.color)?);
        if copies {
            let [darker, brighter] = [1.0 - BRIGHTNESS_SHARE, 1.0 + BRIGHTNESS_SHARE]
                .map(|factor| tell(&brightened(&self.frame.color, factor)));
            (self.darker_wood, self.brighter_wood) = (Some(darker?), Some(brighter?));
        }
        Ok(())
    }

    /// Its boxes.
    pub fn boxes(&self) -> &[PixelBox] {
        self.frame.boxes.as_deref().unwrap_or_default()
    }

    /// The strokes of wood that belong to the tree: neither far wood nor stalks.
    pub fn wood_strokes(&self) -> impl Iterator<Item = &Stroke> {
        self.strokes.of(StrokeClass::Wood)
    }
}

/// Reads frames, each with its strokes: from `strokes`, which names images by their frames' folders, or from the file
/// `wood.txt` in the frame's folder.
///
/// # Errors
///
/// [`EvaluateError::Frame`] and [`EvaluateError::Labels`] for files that cannot be read; [`EvaluateError::Malformed`]
/// for a frame that stands twice, has no boxes or no strokes.
pub fn read_real_frames(
    folders: &[PathBuf],
    strokes: Option<&Path>,
) -> Result<Vec<RealFrame>, EvaluateError> {
    let shared = strokes
        .map(|path| Ok::<_, LabelsError>((path, read_strokes(path)?)))
        .transpose()?;
    let mut frames: Vec<RealFrame> = Vec::new();
    for folder in folders {
        let frame = Frame::read(folder)?;
        if frames.iter().any(|other| other.frame.id == frame.id) {
            let problem = format!("a frame named {} stands twice", frame.id);
            return Err(malformed(
                folder,
                problem,
                "give folders of names of their own",
            ));
        }
        if frame.boxes.as_ref().is_none_or(Vec::is_empty) {
            let remedy = format!(
                "put {} in it, a box for each apple",
                Frame::BOX_FILES.join(" or ")
            );
            return Err(malformed(
                folder,
                "the frame has no boxes".to_owned(),
                &remedy,
            ));
        }
        let own = folder.join(STROKES);
        let (path, images) = match &shared {
            Some((path, images)) => (*path, images.clone()),
            None if own.is_file() => (&*own, read_strokes(&own)?),
            None => {
                let problem = format!("no {STROKES} in it");
                return Err(malformed(
                    folder,
                    problem,
                    "draw one, or give --strokes FILE",
                ));
            }
        };
        let Some(strokes) = images.into_iter().find(|image| image.name == frame.id) else {
            let problem = format!("it has no line `image {}`", frame.id);
            return Err(malformed(
                path,
                problem,
                "begin the strokes of a frame with the name of its folder",
            ));
        };
        frames.push(RealFrame::new(frame, strokes));
    }
    Ok(frames)
}

fn malformed(path: &Path, problem: String, remedy: &str) -> EvaluateError {
    EvaluateError::Malformed {
        path: path.to_owned(),
        problem,
        remedy: remedy.to_owned(),
    }
}
