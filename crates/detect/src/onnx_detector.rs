use crate::{
    classes,
    decode::{Decoder, class_count, decode, recognise},
    description::ModelDescription,
    detection::{Detection, Detector, DetectorReport},
    error::DetectError,
    family::Family,
    fuse::{View, fuse},
    metadata::{Metadata, Task},
    options::DetectorOptions,
    suppress::{Scope, suppress},
};
use pomona_cloud::{ColorImage, PixelWindow};
use pomona_network::{
    ImageNetwork, Letterbox, Malformed, Network, NetworkError, Tensor, Tiling, check_image,
    input_size,
};

/// Lowest score of a box where neither options nor description say.
const DEFAULT_THRESHOLD: f64 = 0.25;

/// `IoU` above which of two boxes only the better one is kept, where neither options nor description say.
const DEFAULT_NMS_IOU: f64 = 0.45;

/// A detector of the YOLO family: a network, and what its outputs mean.
///
/// An image is cut into tiles where it is large, each is scaled to the network's input, and the boxes of all tiles
/// are mapped back to the image and fused. The tiles are spread over the cores; their number changes nothing.
pub struct OnnxDetector {
    network: ImageNetwork,
    name: String,
    decoder: Decoder,
    nms_iou: f64,
    tiling: Tiling,
    class_name: Option<String>,
    notes: Vec<String>,
}

impl OnnxDetector {
    /// A detector around a network; `name` is the model's file, or its name in messages.
    ///
    /// The options' model and runtime are not read: the network is loaded already.
    ///
    /// # Errors
    ///
    /// [`DetectError::Network`] for a network of no known family, one that its description contradicts, or a grid
    /// without tiles; [`DetectError::Setting`] for a threshold that makes no sense.
    pub fn new(
        network: Box<dyn Network>,
        name: impl Into<String>,
        description: &ModelDescription,
        options: &DetectorOptions,
    ) -> Result<Self, DetectError> {
        let name = name.into();
        check_share("threshold", options.threshold)?;
        check_share("nms_iou", options.nms_iou)?;
        let recognised = Recognised::new(&*network, description, options);
        let Recognised {
            decoder,
            class_name,
            notes,
        } = recognised.map_err(|fault| NetworkError::model(&*name, fault))?;
        let tiling = Tiling::new(&description.tiling(options.tiling), decoder.input)?;
        let preparation = description.preparation(decoder.family);
        let network = ImageNetwork::new(network, decoder.input, preparation);
        Ok(Self {
            network: network.map_err(|fault| NetworkError::model(&*name, fault))?,
            name,
            decoder,
            nms_iou: options
                .nms_iou
                .or(description.nms_iou)
                .unwrap_or(DEFAULT_NMS_IOU),
            tiling,
            class_name,
            notes,
        })
    }

    /// How the network's outputs are read.
    pub fn family(&self) -> Family {
        self.decoder.family
    }

    /// Width and height of the network's input in pixels.
    pub fn input_size(&self) -> [usize; 2] {
        self.network.input_size()
    }

    /// The windows of an image of `[width, height]` pixels that the network is run on.
    pub fn windows(&self, image: [usize; 2]) -> Vec<PixelWindow> {
        self.tiling.windows(image)
    }

    /// What one window shows, in pixels of an image of this size: the outputs decoded, mapped back, and suppressed.
    fn view(
        &self,
        size: [usize; 2],
        letterbox: Letterbox,
        outputs: &[Tensor],
    ) -> Result<View, DetectError> {
        let boxes = decode(&self.decoder, outputs);
        let mut detections = boxes.map_err(|fault| NetworkError::model(&*self.name, fault))?;
        let [width, height] = size.map(|side| side as f64);
        for detection in &mut detections {
            let [x_min, y_min] = letterbox.to_image([detection.x_min, detection.y_min]);
            let [x_max, y_max] = letterbox.to_image([detection.x_max, detection.y_max]);
            *detection = Detection {
                x_min: x_min.clamp(0.0, width),
                y_min: y_min.clamp(0.0, height),
                x_max: x_max.clamp(0.0, width),
                y_max: y_max.clamp(0.0, height),
                ..*detection
            };
        }
        // A box that lay in the padding alone has no area now, and is removed.
        suppress(&mut detections, self.nms_iou, Scope::PerClass);
        let [across, down] = letterbox.scale();
        Ok(View {
            window: letterbox.window(),
            scale: (across * down).sqrt(),
            detections,
        })
    }

    /// Longest side in pixels of the image below which a box of the pass over the whole image is dropped: half of the
    /// tiles' overlap. One of the tiles shows whatever is so small whole, and larger.
    fn smallest_of_whole_pass(&self) -> f64 {
        self.tiling.overlap() as f64 / 2.0
    }
}

impl Detector for OnnxDetector {
    fn detect(&self, image: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        Ok(self.fused(&self.views(image)?, image))
    }

    fn detect_at(
        &self,
        image: &ColorImage,
        lowest_scores: &[f64],
    ) -> Result<Vec<Vec<Detection>>, DetectError> {
        let views = self.views(image)?;
        // Suppression goes from the best box down, so that those left out here have removed none of the rest.
        let above = |lowest: &f64| {
            let mut views = views.clone();
            for view in &mut views {
                view.detections.retain(|d| d.score >= *lowest);
            }
            self.fused(&views, image)
        };
        Ok(lowest_scores.iter().map(above).collect())
    }

    fn report(&self) -> DetectorReport {
        DetectorReport {
            name: self.name.clone(),
            family: Some(self.decoder.family.name().to_owned()),
            class_name: self.class_name.clone(),
            runtime: Some(self.network.network().report()),
            notes: self.notes.clone(),
        }
    }
}

impl OnnxDetector {
    /// What each window of an image shows.
    fn views(&self, image: &ColorImage) -> Result<Vec<View>, DetectError> {
        check_image(image)?;
        let size = [image.width, image.height];
        let windows = self.tiling.windows(size);
        let read = |letterbox, outputs: Vec<Tensor>| self.view(size, letterbox, &outputs);
        let mut views = self.network.run_windows(image, &windows, read)?;
        if views.len() == 1 {
            return Ok(views);
        }
        let smallest = self.smallest_of_whole_pass();
        for view in &mut views {
            if [view.window.width(), view.window.height()] == size {
                let side = |d: &Detection| (d.x_max - d.x_min).max(d.y_max - d.y_min);
                view.detections.retain(|d| side(d) >= smallest);
            }
        }
        Ok(views)
    }

    fn fused(&self, views: &[View], image: &ColorImage) -> Vec<Detection> {
        match views {
            [view] => view.detections.clone(),
            views => fuse(views, [image.width, image.height], self.nms_iou),
        }
    }
}

/// What a network's inputs and outputs, its description and the options say together.
struct Recognised {
    decoder: Decoder,
    class_name: Option<String>,
    /// What was assumed.
    notes: Vec<String>,
}

impl Recognised {
    fn new(
        network: &dyn Network,
        description: &ModelDescription,
        options: &DetectorOptions,
    ) -> Result<Self, Malformed> {
        description.check()?;
        let mut description = description.clone();
        let metadata = Metadata::new(network.metadata());
        if description.classes.is_none() {
            description.classes.clone_from(&metadata.names);
        }
        let (inputs, outputs) = (network.inputs(), network.outputs());
        let [width, height] = input_size(inputs, description.input_size)?;
        let known = width.zip(height).map(<[usize; 2]>::from);
        let family = recognise(inputs, outputs, known, &description, &metadata)?;
        let mut notes = Vec::new();
        let input = known.unwrap_or_else(|| {
            let usual = family.input_side();
            let [width, height] = [width, height].map(|side| side.unwrap_or(usual));
            notes.push(format!(
                "the model leaves its input's size open: {width}x{height} pixels are assumed, as {family} has them; \
                 state `input_size` in the description beside it"
            ));
            [width, height]
        });
        let count = class_count(family, outputs, input, &description, &metadata);
        let choice = options.class.as_ref().or(description.class.as_ref());
        let chosen = classes::choose(choice, description.classes.as_deref(), count)?;
        notes.extend(chosen.note);
        let decoder = Decoder {
            family,
            stated: description.family.is_some(),
            input,
            wanted: chosen.classes,
            class_is_guess: chosen.is_guess,
            has_more: metadata.task == Task::BoxesAndMore,
            threshold: options
                .threshold
                .or(description.threshold)
                .unwrap_or(DEFAULT_THRESHOLD),
            classes: description.classes.as_ref().map(Vec::len),
            strides: description.strides,
            anchors: description.anchors,
            coordinates: description.coordinates,
            ports: outputs.to_vec(),
        };
        let class_name = (!chosen.names.is_empty()).then(|| chosen.names.join(", "));
        Ok(Self {
            decoder,
            class_name,
            notes,
        })
    }
}

/// Refuses a setting outside 0 to 1.
fn check_share(setting: &'static str, value: Option<f64>) -> Result<(), DetectError> {
    match value {
        Some(value) if !(0.0..=1.0).contains(&value) => Err(DetectError::Setting {
            setting,
            value: value.to_string(),
            problem: "outside 0 to 1".to_owned(),
            remedy: "give a number from 0 to 1".to_owned(),
        }),
        _ => Ok(()),
    }
}
