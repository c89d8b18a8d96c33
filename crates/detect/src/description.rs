mod values;

use crate::{
    error::DetectError,
    family::{Coordinates, Family},
};
use pomona_cloud::ClassChoice;
use pomona_network::{
    ChannelOrder, Malformed, NetworkError, Padding, Preparation, TilingChoice, TilingOptions,
    description,
};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// What a model's file does not say about it, from a small TOML beside it; everything is optional.
///
/// ```
/// use pomona_detect::{Family, ModelDescription};
///
/// let text = "family = 'yolov8'\nclasses = ['leaf', 'apple']\ninput_size = [640, 480]\n";
/// let description = ModelDescription::parse(text, "orchard.toml")?;
/// assert_eq!(description.family, Some(Family::YoloV8));
///
/// let error = ModelDescription::parse("famly = 'yolov8'", "orchard.toml").unwrap_err();
/// assert!(error.to_string().contains("orchard.toml: line 1, `famly`"));
/// assert!(error.to_string().contains("`family`"));
/// # Ok::<(), pomona_detect::DetectError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ModelDescription {
    /// The model's name, for the record.
    pub name: Option<String>,
    /// The model's licence, for the reader.
    #[serde(alias = "license")]
    pub licence: Option<String>,
    /// Where the model comes from, for the reader.
    pub source: Option<String>,
    /// Anything else, for the reader.
    pub notes: Option<String>,
    /// How its outputs are read; recognised where absent.
    pub family: Option<Family>,
    /// Names of all its classes, in its order.
    pub classes: Option<Vec<String>>,
    /// The class that counts.
    pub class: Option<ClassChoice>,
    /// Width and height in pixels of its input, where the model leaves them open.
    pub input_size: Option<[usize; 2]>,
    /// Pixels of the input for each cell, from the finest grid to the coarsest.
    pub strides: Option<Vec<usize>>,
    /// Width and height in pixels of the input of the anchors, those of the finest grid first.
    pub anchors: Option<Vec<[f32; 2]>>,
    /// Order of the colour channels.
    pub channels: Option<ChannelOrder>,
    /// What each value, 0 to 255, is multiplied by before mean and std: 1/255 or 1.
    pub scale: Option<f32>,
    /// Subtracted from each scaled channel, in the network's order.
    pub mean: Option<[f32; 3]>,
    /// Divides each channel, in the network's order.
    pub std: Option<[f32; 3]>,
    /// Where the image lies in the input.
    pub padding: Option<Padding>,
    /// Grey value, 0 to 255, of what the image does not cover.
    pub fill: Option<u8>,
    /// What decoded boxes are measured in; recognised from their centres where absent.
    pub coordinates: Option<Coordinates>,
    /// Lowest score of a box, 0 to 1.
    pub threshold: Option<f64>,
    /// `IoU` above which of two boxes only the better one is kept, 0 to 1.
    pub nms_iou: Option<f64>,
    /// Longest side in pixels of the image of a tile.
    pub tile: Option<usize>,
    /// Pixels of the image that neighbouring tiles share.
    pub tile_overlap: Option<usize>,
    /// Whether a tiled image is also processed as a whole.
    pub whole_pass: Option<bool>,
}

impl ModelDescription {
    /// Where a model's description lies: `DIR/MODEL.toml` for `DIR/MODEL.onnx`.
    pub fn path_beside(model: &Path) -> PathBuf {
        description::path_beside(model)
    }

    /// Reads the description beside a model; one that says nothing where there is no such file.
    ///
    /// # Errors
    ///
    /// [`NetworkError::Read`], [`NetworkError::Model`].
    pub fn beside(model: &Path) -> Result<Self, DetectError> {
        match description::read_beside(model)? {
            Some((text, origin)) => Self::parse(&text, &origin),
            None => Ok(Self::default()),
        }
    }

    /// Reads a description's text; `origin` names it in messages.
    ///
    /// # Errors
    ///
    /// [`NetworkError::Model`] for what is not TOML, for a key that does not exist, and for a value that is
    /// none of those the key can have.
    pub fn parse(text: &str, origin: &str) -> Result<Self, DetectError> {
        let remedy = "docs/detection.md lists the keys and their values";
        let description: Self = description::parse(text, origin, remedy)?;
        description
            .check()
            .map_err(|fault| NetworkError::model(origin, fault))?;
        Ok(description)
    }

    /// How images are prepared for a model of this family.
    pub fn preparation(&self, family: Family) -> Preparation {
        let mut preparation = family.preparation();
        preparation.channels = self.channels.unwrap_or(preparation.channels);
        preparation.scale = self.scale.unwrap_or(preparation.scale);
        preparation.mean = self.mean.unwrap_or(preparation.mean);
        preparation.std = self.std.unwrap_or(preparation.std);
        preparation.padding = self.padding.unwrap_or(preparation.padding);
        preparation.fill = self.fill.unwrap_or(preparation.fill);
        preparation
    }

    /// How images are tiled for the model, by this choice.
    pub fn tiling(&self, choice: TilingChoice) -> TilingOptions {
        let mut options = TilingOptions::default();
        options.choice = choice;
        options.tile = self.tile;
        options.overlap = self.tile_overlap.unwrap_or(options.overlap);
        options.whole_pass = self.whole_pass.unwrap_or(options.whole_pass);
        options
    }

    /// Refuses values that make no sense for any model.
    pub(crate) fn check(&self) -> Result<(), Malformed> {
        let refused = [
            self.classes.as_deref().and_then(description::class_names),
            self.input_size.and_then(description::input_size),
            self.strides.as_deref().and_then(values::strides),
            self.anchors.as_deref().and_then(values::anchors),
            self.scale.and_then(description::scale),
            self.mean.and_then(description::mean),
            self.std.and_then(description::std),
            self.threshold
                .and_then(|share| description::not_a_share(share, "threshold", "a score")),
            self.nms_iou
                .and_then(|share| description::not_a_share(share, "nms_iou", "an IoU")),
            self.tile.and_then(description::tile),
            self.tile
                .zip(self.tile_overlap)
                .and_then(|(tile, overlap)| description::tile_overlap(tile, overlap)),
        ];
        refused.into_iter().flatten().next().map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn message(text: &str) -> String {
        ModelDescription::parse(text, "m.toml")
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn every_key_is_read() {
        let text = "
            name = 'apples'\nlicence = 'MIT'\nsource = 'here'\nnotes = 'small'\nfamily = 'yolov7'
            classes = ['apple', 'leaf']\nclass = 'apple'\ninput_size = [416, 320]\nstrides = [16, 32]
            anchors = [[10, 14], [23.5, 27]]\nchannels = 'bgr'\nscale = 1\nmean = [1, 2, 3.5]
            std = [1, 1, 2]\npadding = 'top-left'\nfill = 0\ncoordinates = 'normalized'
            threshold = 0.3\nnms_iou = 0.5\ntile = 400\ntile_overlap = 90\nwhole_pass = false";
        let description = ModelDescription::parse(text, "m.toml").unwrap();
        assert_eq!(description.family, Some(Family::YoloV5));
        assert_eq!(
            description.class,
            Some(ClassChoice::Name("apple".to_owned()))
        );
        assert_eq!(description.anchors, Some(vec![[10.0, 14.0], [23.5, 27.0]]));
        let preparation = description.preparation(Family::YoloV5);
        assert_eq!(preparation.channels, ChannelOrder::Bgr);
        assert_eq!(preparation.padding, Padding::TopLeft);
        assert_eq!((preparation.scale, preparation.fill), (1.0, 0));
        assert_eq!(description.whole_pass, Some(false));
        // Those are all keys, but for the other spelling of `licence`.
        let unknown = message("zzz = 1");
        let list = unknown.split_once("`: ").unwrap().1;
        let known = description::known_keys(list.split_once(';').unwrap().0);
        let named = text.lines().filter_map(|line| line.split_once(" = "));
        let named: Vec<&str> = named.map(|(key, _)| key.trim()).collect();
        for key in known.iter().filter(|key| **key != "license") {
            assert!(named.contains(key), "{key}");
        }
        assert!(known.len() > named.len(), "{unknown}");
        let number = ModelDescription::parse("class = 47\nlicense = 'x'", "m.toml");
        assert_eq!(number.unwrap().class, Some(ClassChoice::Number(47)));
    }

    #[test]
    fn messages_name_file_line_and_key() {
        let unknown = message("name = 'x'\nanchor = [[1, 2]]");
        assert!(
            unknown.starts_with("m.toml: line 2, `anchor`: unknown field"),
            "{unknown}"
        );
        assert!(unknown.contains("nearest keys are `anchors`"), "{unknown}");
        let family = message("family = 'yolo99'");
        assert!(
            family.contains("line 1, `family`") && family.contains("`yolox`"),
            "{family}"
        );
        let class = message("class = [1]");
        assert!(class.contains("a class's name or number"), "{class}");
        assert!(message("fill = 300").contains("`fill`"));
        assert!(message("threshold = \"high\"").contains("`threshold`"));
        assert!(message("= =").contains("line 1"));
    }

    #[test]
    fn values_that_make_no_sense_are_refused() {
        for (text, key) in [
            ("classes = []", "classes"),
            ("classes = ['a', 'a']", "classes"),
            ("input_size = [0, 416]", "input_size"),
            ("input_size = [416, 1000000]", "input_size"),
            ("strides = []", "strides"),
            ("strides = [16, 8]", "strides"),
            ("strides = [0, 8]", "strides"),
            ("anchors = []", "anchors"),
            ("anchors = [[1, 0]]", "anchors"),
            ("anchors = [[nan, 1]]", "anchors"),
            ("scale = 0", "scale"),
            ("scale = inf", "scale"),
            ("mean = [0, nan, 0]", "mean"),
            ("std = [1, 1, 0]", "std"),
            ("threshold = 1.5", "threshold"),
            ("threshold = nan", "threshold"),
            ("nms_iou = -0.1", "nms_iou"),
            ("tile = 0", "tile"),
            ("tile = 100\ntile_overlap = 60", "tile_overlap"),
        ] {
            let message = message(text);
            assert!(
                message.starts_with(&format!("m.toml: `{key}`: ")),
                "{text}: {message}"
            );
        }
    }

    #[test]
    fn a_model_without_a_description_says_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let model = folder.path().join("apples.onnx");
        assert_eq!(
            ModelDescription::beside(&model).unwrap(),
            ModelDescription::default()
        );
        fs::write(folder.path().join("apples.toml"), "fill = 3").unwrap();
        assert_eq!(ModelDescription::beside(&model).unwrap().fill, Some(3));
        fs::write(folder.path().join("apples.toml"), "fil = 3").unwrap();
        let message = ModelDescription::beside(&model).unwrap_err().to_string();
        assert!(message.contains("apples.toml: line 1"), "{message}");
    }
}
