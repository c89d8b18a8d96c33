use crate::{
    DetectError, Detection, Detector, DetectorOptions, DetectorReport, Family, Letterbox,
    ModelDescription, Network, Preparation, Scope, View, classes,
    decode::{Decoder, class_count, recognise},
    fault::Fault,
    fuse, ports,
    ports::Inputs,
    suppress,
    tiling::Tiling,
};
use pomona_cloud::{ColorImage, PixelWindow};
use rayon::prelude::*;

/// Lowest score that counts where neither options nor description say.
const THRESHOLD: f64 = 0.25;

/// `IoU` above which two boxes are one apple where neither options nor description say.
const OVERLAP: f64 = 0.45;

/// A detector of the YOLO family: a network, and what its outputs mean.
///
/// An image is cut into tiles where it is large, each is scaled to the network's input, and the boxes of all tiles
/// are mapped back to the image and merged. The tiles are shared among the cores; their number changes nothing.
pub struct OnnxDetector {
    network: Box<dyn Network>,
    name: String,
    inputs: Inputs,
    input: [usize; 2],
    preparation: Preparation,
    decoder: Decoder,
    overlap: f64,
    tiling: Tiling,
    notes: Vec<String>,
}

impl OnnxDetector {
    /// A detector around a network; `name` is the model's file, or what else stands for it in messages.
    ///
    /// The options' model and runtime are not looked at: the network is loaded already.
    ///
    /// # Errors
    ///
    /// [`DetectError::Model`] for a network of no known family, or one that its description contradicts;
    /// [`DetectError::Setting`] for options that make no sense.
    pub fn new(
        network: Box<dyn Network>,
        name: impl Into<String>,
        description: &ModelDescription,
        options: &DetectorOptions,
    ) -> Result<Self, DetectError> {
        let name = name.into();
        share("threshold", options.threshold)?;
        share("overlap", options.overlap)?;
        let detector = Self::assemble(&*network, description, options);
        let (inputs, input, decoder, notes) = detector.map_err(|fault| fault.at(&*name))?;
        Ok(Self {
            tiling: Tiling::new(options.tiling, input, description)?,
            overlap: options.overlap.or(description.overlap).unwrap_or(OVERLAP),
            preparation: description.preparation(decoder.family),
            network,
            name,
            inputs,
            input,
            decoder,
            notes,
        })
    }

    fn assemble(
        network: &dyn Network,
        description: &ModelDescription,
        options: &DetectorOptions,
    ) -> Result<(Inputs, [usize; 2], Decoder, Vec<String>), Fault> {
        description.check()?;
        let mut description = description.clone();
        if description.classes.is_none() {
            description.classes = classes::from_metadata(network.metadata());
        }
        let description = &description;
        let inputs = Inputs::of(network.inputs())?;
        let image = &network.inputs()[inputs.image];
        let sides = ports::input_size(image, description.input_size)?;
        let known = ports::both(sides);
        let outputs = network.outputs();
        let family = recognise(network.inputs(), outputs, known, description)?;
        let mut notes = Vec::new();
        let input = known.unwrap_or_else(|| {
            let usual = family.input_side();
            let input = sides.map(|side| side.unwrap_or(usual));
            notes.push(format!(
                "the model leaves its input's size open: {}x{} pixels are assumed, as {family} has them; state \
                 `input_size` in the description beside it",
                input[0], input[1]
            ));
            input
        });
        let named = description.classes.as_ref().map(Vec::len);
        let count = class_count(family, outputs, input, description);
        let choice = options.class.as_ref().or(description.class.as_ref());
        let class = classes::choose(choice, description.classes.as_deref(), count)?;
        let decoder = Decoder {
            family,
            stated: description.family.is_some(),
            input,
            class,
            threshold: options
                .threshold
                .or(description.threshold)
                .unwrap_or(THRESHOLD),
            classes: named,
            strides: description.strides.clone(),
            anchors: description.anchors.clone(),
            coordinates: description.coordinates,
            ports: outputs.to_vec(),
        };
        Ok((inputs, input, decoder, notes))
    }

    /// How the network's outputs are read.
    pub fn family(&self) -> Family {
        self.decoder.family
    }

    /// Width and height of the network's input in pixels.
    pub fn input_size(&self) -> [usize; 2] {
        self.input
    }

    /// The windows of an image of `[width, height]` pixels that the network is run on.
    pub fn windows(&self, image: [usize; 2]) -> Vec<PixelWindow> {
        self.tiling.windows(image)
    }

    /// What is seen in one window, in pixels of the image.
    fn look(&self, image: &ColorImage, window: PixelWindow) -> Result<View, DetectError> {
        let letterbox = Letterbox::new(window, self.input, self.preparation.padding);
        let filled = letterbox.and_then(|l| Some((l, l.fill(image, &self.preparation)?)));
        let (letterbox, data) = filled.ok_or_else(|| not_an_image(image))?;
        let tensors = self.inputs.tensors(self.network.inputs(), self.input, data);
        let outputs = self.network.run(&tensors)?;
        let boxes = self.decoder.decode(&outputs);
        let mut detections = boxes.map_err(|fault| fault.at(&*self.name))?;
        for detection in &mut detections {
            let [x_min, y_min] = letterbox.to_image([detection.x_min, detection.y_min]);
            let [x_max, y_max] = letterbox.to_image([detection.x_max, detection.y_max]);
            *detection = Detection {
                x_min: x_min.clamp(0.0, image.width as f64),
                y_min: y_min.clamp(0.0, image.height as f64),
                x_max: x_max.clamp(0.0, image.width as f64),
                y_max: y_max.clamp(0.0, image.height as f64),
                ..*detection
            };
        }
        // What lay in the padding alone has no area now, and goes.
        suppress(&mut detections, self.overlap, Scope::PerClass);
        let [across, down] = letterbox.scale();
        Ok(View {
            window,
            scale: (across * down).sqrt(),
            detections,
        })
    }
}

impl Detector for OnnxDetector {
    fn detect(&self, image: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        let size = [image.width, image.height];
        let pixels = image.width.checked_mul(image.height);
        if size.contains(&0) || pixels != Some(image.pixels.len()) {
            return Err(not_an_image(image));
        }
        let windows = self.tiling.windows(size);
        let looked: Vec<_> = windows
            .into_par_iter()
            .map(|window| self.look(image, window))
            .collect();
        let mut views = looked.into_iter().collect::<Result<Vec<View>, _>>()?;
        if let [view] = &mut views[..] {
            return Ok(std::mem::take(&mut view.detections));
        }
        let smallest = self.tiling.smallest_in_whole_pass();
        for view in &mut views {
            if [view.window.width(), view.window.height()] == size {
                let side = |d: &Detection| (d.x_max - d.x_min).max(d.y_max - d.y_min);
                view.detections.retain(|d| side(d) >= smallest);
            }
        }
        Ok(fuse(&views, size, self.overlap))
    }

    fn report(&self) -> DetectorReport {
        DetectorReport {
            name: self.name.clone(),
            family: Some(self.decoder.family.name().to_owned()),
            runtime: Some(self.network.report()),
            notes: self.notes.clone(),
        }
    }
}

fn not_an_image(image: &ColorImage) -> DetectError {
    DetectError::Image {
        width: image.width,
        height: image.height,
        problem: format!("{} pixels", image.pixels.len()),
        remedy: "give an image of at least one pixel, with as many as its size says".to_owned(),
    }
}

/// Refuses a setting that is no share.
fn share(setting: &'static str, value: Option<f64>) -> Result<(), DetectError> {
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
