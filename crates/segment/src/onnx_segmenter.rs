use crate::{
    blend::{Tile, blend},
    classes::Classes,
    collage::Collage,
    description::{Activation, SegmentDescription},
    error::SegmentError,
    output::{Maps, Place, activate, channels},
    segmentation::Segmentation,
    segmenter::{Segmenter, SegmenterReport},
};
use pomona_cloud::{ColorImage, PixelWindow};
use pomona_network::{
    ImageNetwork, Letterbox, Malformed, Network, NetworkError, Tiling, TilingChoice, check_image,
    input_size,
};

/// Side of the input in pixels where neither the model nor its description says: that of the built-in model.
const USUAL_SIDE: usize = 416;

/// The grey that is run once where nobody says how a model's numbers are to be read.
const PROBE: [u8; 3] = [114; 3];

/// A network that gives each pixel its classes.
///
/// An image is cut into tiles where it is larger than the input; the tiles are spread over the cores, whose number
/// changes nothing.
pub struct OnnxSegmenter {
    network: ImageNetwork,
    name: String,
    classes: Classes,
    activation: Activation,
    /// Whether the output is one class against the rest.
    is_one: bool,
    tiling: Tiling,
    /// The grey around pieces of the image, where these may be put beside each other in the input.
    collage_fill: Option<u8>,
    notes: Vec<String>,
}

impl OnnxSegmenter {
    /// A segmenter around a network; `name` is the model's file, or its name in messages.
    ///
    /// # Errors
    ///
    /// [`SegmentError::Network`] for a network whose output is no map of classes, one that its description
    /// contradicts, or a grid without tiles.
    pub fn new(
        network: Box<dyn Network>,
        name: impl Into<String>,
        description: &SegmentDescription,
        tiling: TilingChoice,
    ) -> Result<Self, SegmentError> {
        Self::zoomed(network, name, description, tiling, 1.0)
    }

    /// The same with tiles that are enlarged by `zoom` for the network.
    pub(crate) fn zoomed(
        network: Box<dyn Network>,
        name: impl Into<String>,
        description: &SegmentDescription,
        tiling: TilingChoice,
        zoom: f64,
    ) -> Result<Self, SegmentError> {
        let name = name.into();
        let model = |fault: Malformed| NetworkError::model(&*name, fault);
        let [width, height] =
            input_size(network.inputs(), description.input_size).map_err(model)?;
        let declared = channels(network.outputs()).map_err(model)?;
        let mut notes = Vec::new();
        let input = [width, height].map(|side| side.unwrap_or(USUAL_SIDE));
        if width.is_none() || height.is_none() {
            notes.push(format!(
                "the model leaves its input's size open: {}x{} pixels are assumed; state `input_size` in the \
                 description beside it",
                input[0], input[1]
            ));
        }
        let mut tiles = description.tiling(tiling, input);
        let zoomed = |length: usize| (length as f64 / zoom).round() as usize;
        tiles.tile = tiles.tile.map(|tile| zoomed(tile).max(1));
        tiles.overlap = zoomed(tiles.overlap);
        let is_native =
            tiles.choice == TilingChoice::Automatic && tiles.tile == Some(input[0].max(input[1]));
        let tiling = Tiling::new(&tiles, input)?;
        let preparation = description.preparation();
        let collage_fill = is_native.then_some(preparation.fill);
        let network = ImageNetwork::new(network, input, preparation).map_err(model)?;
        let (channels, activation) = match (declared, description.activation) {
            (Some(channels), Some(activation)) => (channels, activation),
            (_, stated) => {
                let probe = probe(&network).map_err(|error| named(error, &name))?;
                let activation = stated.unwrap_or(probe.activation);
                if stated.is_none() {
                    let kind = if activation == Activation::None {
                        "probabilities"
                    } else {
                        "logits"
                    };
                    notes.push(format!(
                        "its numbers are taken for {kind}; state `activation` in the description beside it"
                    ));
                }
                (probe.channels, activation)
            }
        };
        let classes = description.classes(channels).map_err(model)?;
        if description.classes.is_none() {
            notes.push(format!(
                "its only channel is taken for `{}`; state `classes` in the description beside it",
                classes.names()[1]
            ));
        }
        Ok(Self {
            network,
            name,
            classes,
            activation,
            is_one: channels == 1,
            tiling,
            collage_fill,
            notes,
        })
    }

    /// Width and height of the network's input in pixels.
    pub fn input_size(&self) -> [usize; 2] {
        self.network.input_size()
    }

    /// The windows of an image of `[width, height]` pixels that the network is run on for all of its pixels.
    pub fn windows(&self, image: [usize; 2]) -> Vec<PixelWindow> {
        self.tiling.windows(image)
    }

    /// How often the network is run for [`Segmenter::segment_windows`] of an image of `[width, height]` pixels.
    pub fn runs_for_windows(&self, image: [usize; 2], windows: &[PixelWindow]) -> usize {
        self.tiles_about(image, windows).len()
    }

    /// How often it is run for [`Segmenter::segment_places`].
    pub fn runs_for_places(&self, image: [usize; 2], places: &[PixelWindow]) -> usize {
        match self.collage(image, places) {
            Some(collage) => collage.sheets(),
            None => self.runs_for_windows(image, places),
        }
    }

    /// The tiles that hold a pixel of a window.
    fn tiles_about(&self, image: [usize; 2], windows: &[PixelWindow]) -> Vec<PixelWindow> {
        let mut tiles = self.tiling.windows(image);
        tiles.retain(|tile| windows.iter().any(|window| overlap(tile, window)));
        tiles
    }

    /// A collage of these places, where the network need not be run as often for it as for their tiles.
    fn collage(&self, image: [usize; 2], places: &[PixelWindow]) -> Option<Collage> {
        self.collage_fill?;
        let collage = Collage::new(image, places, self.network.input_size())?;
        (collage.sheets() < self.runs_for_windows(image, places)).then_some(collage)
    }

    /// What the network sees in windows of an image.
    fn run(&self, image: &ColorImage, windows: &[PixelWindow]) -> Result<Vec<Tile>, SegmentError> {
        let read = |letterbox, outputs: Vec<_>| {
            let maps = Maps::of(&outputs);
            let tile = maps.and_then(|maps| self.tile(letterbox, &maps));
            tile.map_err(|fault| SegmentError::from(NetworkError::model(&*self.name, fault)))
        };
        self.network.run_windows(image, windows, read)
    }

    /// What one window shows.
    fn tile(&self, letterbox: Letterbox, maps: &Maps<'_>) -> Result<Tile, Malformed> {
        let window = letterbox.window();
        let expected = self.classes.len() - usize::from(self.is_one);
        if maps.channels != expected {
            let problem = format!("{} channels for {expected} classes", maps.channels);
            let remedy = "use a model that always answers with the same number of channels";
            return Err(Malformed::new("output", problem, remedy));
        }
        let input = self.network.input_size().map(|side| side as f64);
        let place = |u: usize, v: usize| {
            let centre = [(window.x0 + u) as f64 + 0.5, (window.y0 + v) as f64 + 0.5];
            let [x, y] = letterbox.to_input(centre);
            [x / input[0], y / input[1]]
        };
        let width = window.width();
        let columns: Vec<Place> = (0..width)
            .map(|u| Place::new(place(u, 0)[0], maps.width))
            .collect();
        let mut planes = vec![vec![0.0; width * window.height()]; self.classes.len()];
        let mut rows = vec![vec![0.0; width]; self.classes.len()];
        for v in 0..window.height() {
            let row = Place::new(place(0, v)[1], maps.height);
            for (channel, numbers) in rows[usize::from(self.is_one)..].iter_mut().enumerate() {
                maps.row(channel, row, &columns, numbers);
            }
            activate(self.activation, &mut rows, self.is_one);
            for (plane, row) in planes.iter_mut().zip(&rows) {
                plane[v * width..(v + 1) * width].copy_from_slice(row);
            }
        }
        Ok(Tile { window, planes })
    }
}

impl Segmenter for OnnxSegmenter {
    fn classes(&self) -> &Classes {
        &self.classes
    }

    fn segment_windows(
        &self,
        image: &ColorImage,
        windows: &[PixelWindow],
    ) -> Result<Segmentation, SegmentError> {
        check_windows(image, windows)?;
        let size = [image.width, image.height];
        let tiles = self.run(image, &self.tiles_about(size, windows))?;
        Ok(blend(
            size,
            self.classes.clone(),
            &tiles,
            self.tiling.overlap(),
        ))
    }

    fn segment_places(
        &self,
        image: &ColorImage,
        places: &[PixelWindow],
    ) -> Result<Segmentation, SegmentError> {
        check_windows(image, places)?;
        let size = [image.width, image.height];
        let (Some(collage), Some(fill)) = (self.collage(size, places), self.collage_fill) else {
            return self.segment_windows(image, places);
        };
        let sheets = self.run(&collage.image(image, fill), &collage.windows())?;
        let tiles = collage.tiles(&sheets);
        Ok(blend(
            size,
            self.classes.clone(),
            &tiles,
            Collage::overlap(),
        ))
    }

    fn report(&self) -> SegmenterReport {
        SegmenterReport {
            name: self.name.clone(),
            runtime: Some(self.network.network().report()),
            notes: self.notes.clone(),
        }
    }
}

/// Whether there is an image, and every window is one of it.
fn check_windows(image: &ColorImage, windows: &[PixelWindow]) -> Result<(), SegmentError> {
    check_image(image)?;
    for window in windows {
        let inside = window.x1 <= image.width && window.y1 <= image.height;
        if !inside || window.is_empty() {
            return Err(NetworkError::Window {
                width: image.width,
                height: image.height,
                window: *window,
            }
            .into());
        }
    }
    Ok(())
}

fn overlap(a: &PixelWindow, b: &PixelWindow) -> bool {
    a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1
}

/// What an answer tells about a network.
struct Probe {
    channels: usize,
    activation: Activation,
}

/// The answer to a grey image.
fn probe(network: &ImageNetwork) -> Result<Probe, SegmentError> {
    let [width, height] = network.input_size();
    let grey = ColorImage::filled(width, height, PROBE);
    let window = PixelWindow::full(width, height);
    let read = |_, outputs: Vec<_>| {
        let maps = Maps::of(&outputs).map_err(|fault| NetworkError::model("", fault))?;
        let activation = if maps.are_probabilities() {
            Activation::None
        } else if maps.channels == 1 {
            Activation::Sigmoid
        } else {
            Activation::Softmax
        };
        Ok::<_, SegmentError>(Probe {
            channels: maps.channels,
            activation,
        })
    };
    let mut probes = network.run_windows(&grey, &[window], read)?;
    probes.pop().ok_or_else(|| SegmentError::Other {
        segmenter: "network".to_owned(),
        source: "it gives no answer".into(),
    })
}

/// The same error with the model's name where it has none.
fn named(error: SegmentError, name: &str) -> SegmentError {
    match error {
        SegmentError::Network(NetworkError::Model {
            model,
            place,
            problem,
            remedy,
        }) if model.is_empty() => NetworkError::Model {
            model: name.to_owned(),
            place,
            problem,
            remedy,
        }
        .into(),
        other => other,
    }
}
