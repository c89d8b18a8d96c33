//! Images with strokes and marks whose figures are known, and a segmenter that reads wood off their colours.

use pomona_cloud::{ColorImage, PixelWindow};
use pomona_labels::{
    Estimate, ImageStrokes, LabelsError, SegmentationEvaluation, SegmentationImage,
    SegmentationOptions, SegmentationSource, WidthRecall, evaluate_segmentation, parse_strokes,
    segmentation_images,
};
use pomona_segment::{Classes, SegmentError, Segmentation, Segmenter, SegmenterReport};
use std::ops::Range;
use std::path::Path;
use tempfile::TempDir;

pub(crate) const WIDTH: usize = 100;
pub(crate) const HEIGHT: usize = 80;
pub(crate) const STROKES: &str = "strokes.txt";

/// Takes the brightness of a colour channel for the probability of wood.
#[derive(Clone, Copy)]
pub(crate) enum Channel {
    Red,
    Green,
}

impl Channel {
    fn name(self) -> &'static str {
        match self {
            Self::Red => "red",
            Self::Green => "green",
        }
    }
}

/// Reads the probability of wood off a colour channel; it does not look at blue pixels, nor at narrow images.
pub(crate) struct ByColor {
    pub(crate) channel: Channel,
    classes: Classes,
}

impl ByColor {
    pub(crate) fn new(channel: Channel) -> Self {
        Self {
            channel,
            classes: Classes::by_names(["rest", "wood"]).unwrap(),
        }
    }
}

impl Segmenter for ByColor {
    fn classes(&self) -> &Classes {
        &self.classes
    }

    fn segment_windows(
        &self,
        image: &ColorImage,
        _: &[PixelWindow],
    ) -> Result<Segmentation, SegmentError> {
        if image.width < 4 {
            return Err(SegmentError::Other {
                segmenter: self.channel.name().to_owned(),
                source: "too narrow".into(),
            });
        }
        let wood = |pixel: &[u8; 3]| match pixel {
            [_, _, 0] => f32::from(pixel[self.channel as usize]) / 255.0,
            _ => f32::NAN,
        };
        let wood: Vec<f32> = image.pixels.iter().map(wood).collect();
        let rest = wood.iter().map(|p| 1.0 - p).collect();
        let size = [image.width, image.height];
        Segmentation::new(size, self.classes.clone(), vec![rest, wood])
    }

    fn report(&self) -> SegmenterReport {
        SegmenterReport::new(self.channel.name())
    }
}

/// A piece of a row that a channel shows.
#[derive(Clone)]
pub(crate) struct Mark {
    channel: usize,
    row: usize,
    columns: Range<usize>,
    value: u8,
}

/// Sure wood in the red channel.
pub(crate) fn red(row: usize, columns: Range<usize>) -> Mark {
    Mark {
        channel: 0,
        row,
        columns,
        value: 255,
    }
}

/// Sure wood in the green channel.
pub(crate) fn green(row: usize, columns: Range<usize>) -> Mark {
    Mark {
        channel: 1,
        ..red(row, columns)
    }
}

/// Pixels that nobody looks at.
pub(crate) fn blue(row: usize, columns: Range<usize>) -> Mark {
    Mark {
        channel: 2,
        ..red(row, columns)
    }
}

pub(crate) fn of_value(mark: Mark, value: u8) -> Mark {
    Mark { value, ..mark }
}

pub(crate) fn painted([width, height]: [usize; 2], marks: &[Mark]) -> ColorImage {
    let mut image = ColorImage::filled(width, height, [0; 3]);
    for mark in marks {
        for u in mark.columns.clone() {
            image.pixels[mark.row * width + u][mark.channel] = mark.value;
        }
    }
    image
}

/// A folder of images with a file of strokes.
pub(crate) struct Orchard {
    pub(crate) dir: TempDir,
    strokes: String,
}

impl Orchard {
    pub(crate) fn new() -> Self {
        Self {
            dir: tempfile::tempdir().unwrap(),
            strokes: String::new(),
        }
    }

    /// One image with these strokes and marks.
    pub(crate) fn with(strokes: &str, marks: &[Mark]) -> Self {
        let mut orchard = Self::new();
        orchard.add("a.png", strokes, marks);
        orchard
    }

    pub(crate) fn add(&mut self, name: &str, strokes: &str, marks: &[Mark]) {
        let image = painted([WIDTH, HEIGHT], marks);
        image.write(self.dir.path().join(name)).unwrap();
        self.name(name, strokes);
    }

    pub(crate) fn name(&mut self, name: &str, strokes: &str) {
        let own = format!("image {name}\n{strokes}\n");
        self.strokes += &own;
    }

    pub(crate) fn images(&self) -> Result<Vec<SegmentationImage>, LabelsError> {
        let strokes = read(&self.strokes);
        segmentation_images(self.dir.path(), strokes, Path::new(STROKES))
    }

    pub(crate) fn measured(
        &self,
        sources: &[SegmentationSource<'_>],
        options: SegmentationOptions,
    ) -> Result<SegmentationEvaluation, LabelsError> {
        evaluate_segmentation("orchard", &self.images()?, &[], sources, &options, &|| {})
    }

    /// What the red channel is worth.
    pub(crate) fn red(&self) -> SegmentationEvaluation {
        self.channels(&[Channel::Red], OPTIONS)
    }

    pub(crate) fn channels(
        &self,
        channels: &[Channel],
        options: SegmentationOptions,
    ) -> SegmentationEvaluation {
        let segmenters: Vec<ByColor> = channels.iter().copied().map(ByColor::new).collect();
        let sources: Vec<_> = segmenters.iter().map(source).collect();
        self.measured(&sources, options).unwrap()
    }

    #[track_caller]
    pub(crate) fn refused(&self, words: &[&str]) {
        let segmenter = ByColor::new(Channel::Red);
        let message = self.measured(&[source(&segmenter)], OPTIONS).unwrap_err();
        says(&message, words);
    }
}

pub(crate) const OPTIONS: SegmentationOptions = SegmentationOptions::new(0.5, 3.0, 7);

pub(crate) fn source(segmenter: &ByColor) -> SegmentationSource<'_> {
    SegmentationSource::Segmenter {
        name: segmenter.channel.name().to_owned(),
        segmenter,
    }
}

pub(crate) fn read(strokes: &str) -> Vec<ImageStrokes> {
    parse_strokes(strokes, Path::new(STROKES)).unwrap()
}

#[track_caller]
pub(crate) fn says(error: &LabelsError, words: &[&str]) {
    let message = error.to_string();
    for word in words {
        assert!(message.contains(word), "no `{word}` in: {message}");
    }
}

#[track_caller]
pub(crate) fn is(figure: Option<Estimate>, expected: f64) {
    let figure = figure.expect("the figure exists");
    assert!(
        (figure.value - expected).abs() < 1e-12,
        "{figure:?}, not {expected}"
    );
}

/// Length and recall of each class of width, the finest first.
pub(crate) fn by_width(widths: &[WidthRecall]) -> Vec<(f64, f64)> {
    let rounded = |x: f64| (x * 1e9).round() / 1e9;
    let pair = |w: &WidthRecall| (rounded(w.length_px), rounded(w.recall));
    widths.iter().map(pair).collect()
}

/// Tiles of a branch, of which the red channel finds ever more, and the green one a tenth more than that.
pub(crate) fn row_of_trees(name: impl Fn(usize) -> String) -> Orchard {
    let mut orchard = Orchard::new();
    for tile in 0..12 {
        let seen = 5 + 7 * tile;
        let marks = [red(20, 0..seen), green(20, 0..seen + 10)];
        orchard.add(&name(tile), BRANCH, &marks);
    }
    orchard
}

/// A branch 4 px wide along the row 20: its band are the rows 18 to 22, and within 3 px of it lie the rows 15 to 25.
pub(crate) const BRANCH: &str = "wood 0,20.5,2 100,20.5,2\n";
/// A twig 3 px wide along the row 60: its band are the rows 59 to 61, and within 3 px of it lie the rows 56 to 64.
pub(crate) const TWIG: &str = "wood 0,60.5,1.5 100,60.5,1.5\n";
pub(crate) const WIRE: &str = "post 0,72.5,1 100,72.5,1\n";
