//! Any bytes as a network: what it declares, what it answers, how it is described, and the image it is shown.
//!
//! The fuzz target and the suite's own test run the same function.

use pomona_cloud::ColorImage;
use pomona_detect::{
    ClassChoice, Coordinates, Detection, Detector, DetectorOptions, Family, ModelDescription,
    OnnxDetector, TilingChoice,
};
use pomona_network::{
    ChannelOrder, Element, Network, NetworkError, Padding, Port, RuntimeReport, Tensor,
};

/// Makes a detector of these bytes, if they make one, and has it look at an image; whatever it then says must be a
/// box in the image, in order, and the same again. `None` where there was no detector or no answer.
pub(crate) fn detect_with(data: &[u8]) -> Option<Vec<Detection>> {
    let mut bytes = Bytes { data };
    let network = AnyNetwork::new(&mut bytes);
    let description = description(&mut bytes);
    let options = DetectorOptions::default().with(|o| {
        o.class = class(&mut bytes);
        o.threshold = bytes.option(Bytes::share);
        o.nms_iou = bytes.option(Bytes::share);
        o.tiling = match bytes.below(4) {
            0 => TilingChoice::Whole,
            1 => TilingChoice::Grid {
                columns: bytes.below(5),
                rows: 1 + bytes.below(4),
            },
            _ => TilingChoice::Automatic,
        };
    });
    let mut image = ColorImage::filled(bytes.below(150), bytes.below(150), [9, 99, 200]);
    if bytes.below(16) == 0 {
        image.pixels.pop();
    }
    let detector = OnnxDetector::new(Box::new(network), "any", &description, &options).ok()?;
    let found = detector.detect(&image).ok()?;
    for (k, detection) in found.iter().enumerate() {
        let Detection {
            x_min,
            y_min,
            x_max,
            y_max,
            score,
            ..
        } = *detection;
        assert!(
            0.0 <= x_min && x_min < x_max && x_max <= image.width as f64,
            "{detection:?}"
        );
        assert!(
            0.0 <= y_min && y_min < y_max && y_max <= image.height as f64,
            "{detection:?}"
        );
        assert!((0.0..=1.0).contains(&score), "{detection:?}");
        assert!(k == 0 || found[k - 1].score >= score);
    }
    assert_eq!(detector.detect(&image).ok().as_deref(), Some(&found[..]));
    Some(found)
}

/// Numbers out of bytes; zeros when they are used up.
struct Bytes<'a> {
    data: &'a [u8],
}

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.data.split_first() else {
            return 0;
        };
        self.data = rest;
        *first
    }

    fn below(&mut self, end: usize) -> usize {
        usize::from(self.byte()) % end
    }

    fn option<T>(&mut self, value: fn(&mut Self) -> T) -> Option<T> {
        (self.below(3) == 0).then(|| value(self))
    }

    /// A number of a kind that occurs in outputs, or should not.
    fn number(&mut self) -> f32 {
        let byte = self.byte();
        match byte {
            0..=99 => f32::from(byte) / 99.0,
            100..=199 => f32::from(byte) - 100.0,
            200..=229 => f32::from(byte) - 215.0,
            230 => f32::NAN,
            231 => f32::INFINITY,
            232 => f32::NEG_INFINITY,
            233 => f32::MAX,
            234 => f32::MIN,
            235 => f32::MIN_POSITIVE,
            236 => -0.0,
            _ => {
                let bits = [self.byte(), self.byte(), self.byte(), byte];
                f32::from_le_bytes(bits)
            }
        }
    }

    /// A score or a share, now and then something else.
    fn share(&mut self) -> f64 {
        match self.byte() {
            byte @ 0..=240 => f64::from(byte) / 240.0,
            _ => f64::from(self.number()),
        }
    }

    fn side(&mut self) -> usize {
        const SIDES: [usize; 16] = [1, 2, 3, 4, 5, 6, 8, 12, 18, 21, 24, 63, 0, 7, 64, 32];
        SIDES[self.below(SIDES.len())]
    }

    /// Any shape.
    fn shape(&mut self) -> Vec<usize> {
        let axes = self.below(6);
        let mut shape: Vec<usize> = (0..axes).map(|_| self.side()).collect();
        // A quarter of a million numbers are enough.
        while shape.iter().product::<usize>() > 1 << 18 {
            shape.pop();
        }
        shape
    }

    /// The shapes that a network of some family has for a square input of this side.
    fn shapes(&mut self, side: usize) -> Vec<Vec<usize>> {
        let cells = |stride: usize| (side / stride) * (side / stride);
        let rows = cells(8) + cells(16) + cells(32);
        let classes = 1 + self.below(3);
        let grid = |stride: usize, layout: usize| match layout {
            0 => vec![1, 3 * (5 + classes), side / stride, side / stride],
            1 => vec![1, side / stride, side / stride, 3 * (5 + classes)],
            2 => vec![1, 3, side / stride, side / stride, 5 + classes],
            _ => vec![1, side / stride, side / stride, 3, 5 + classes],
        };
        match self.below(7) {
            0 => vec![vec![1, 4 + classes, rows]],
            1 => vec![vec![1, rows, 5 + classes]],
            2 => vec![vec![1, 3 * rows, 5 + classes]],
            3 => {
                let layout = self.below(4);
                [16, 32].map(|stride| grid(stride, layout)).to_vec()
            }
            4 => {
                let layout = self.below(4);
                [32, 16, 8].map(|stride| grid(stride, layout)).to_vec()
            }
            5 => {
                let (found, left) = (1 + self.below(20), self.below(9));
                vec![vec![1, found, 4], vec![1, classes, found], vec![left, 3]]
            }
            _ => (0..self.below(5)).map(|_| self.shape()).collect(),
        }
    }
}

struct AnyNetwork {
    inputs: Vec<Port>,
    outputs: Vec<Port>,
    answers: Vec<Tensor>,
}

impl AnyNetwork {
    fn new(bytes: &mut Bytes<'_>) -> Self {
        let side = [32, 64, 96][bytes.below(3)];
        let declared = if bytes.below(5) == 0 { 0 } else { side };
        let mut inputs = vec![port(bytes, "image", &[1, 3, declared, declared])];
        let shapes = bytes.shapes(side);
        match bytes.below(20) {
            0 => {
                let shape = bytes.shape();
                inputs = vec![port(bytes, "image", &shape)];
            }
            1 => inputs.clear(),
            _ => {}
        }
        if shapes.len() == 3 && bytes.below(2) == 0 {
            inputs.push(port(bytes, "image_shape", &[1, 2]));
        }
        let mut outputs = Vec::new();
        let mut answers = Vec::new();
        for (k, shape) in shapes.into_iter().enumerate() {
            let name = format!("output{k}");
            let mut declared = port(bytes, &name, &shape);
            for side in &mut declared.shape {
                if bytes.below(12) == 0 {
                    *side = None;
                }
            }
            // What comes need not be what was declared.
            let mut shape = if bytes.below(20) == 0 {
                bytes.shape()
            } else {
                shape
            };
            let count: usize = shape.iter().product();
            // A few numbers over and over: there are far more cells than bytes.
            let some: Vec<f32> = (0..=bytes.below(40)).map(|_| bytes.number()).collect();
            let mut data: Vec<f32> = some.iter().copied().cycle().take(count).collect();
            match bytes.below(60) {
                0 => data.push(0.5),
                1 => shape.push(usize::MAX),
                _ => {}
            }
            outputs.push(declared);
            answers.push(Tensor { name, shape, data });
        }
        if bytes.below(40) == 0 {
            answers.pop();
        }
        Self {
            inputs,
            outputs,
            answers,
        }
    }
}

fn port(bytes: &mut Bytes<'_>, name: &str, shape: &[usize]) -> Port {
    Port {
        name: name.to_owned(),
        shape: shape
            .iter()
            .map(|&side| (side > 0).then_some(side))
            .collect(),
        element: [Element::F32, Element::F16, Element::I64, Element::Other][bytes.below(4)],
    }
}

impl Network for AnyNetwork {
    fn inputs(&self) -> &[Port] {
        &self.inputs
    }

    fn outputs(&self) -> &[Port] {
        &self.outputs
    }

    fn run(&self, _: &[Tensor]) -> Result<Vec<Tensor>, NetworkError> {
        Ok(self.answers.clone())
    }

    fn report(&self) -> RuntimeReport {
        RuntimeReport::new("any", "")
    }
}

fn class(bytes: &mut Bytes<'_>) -> Option<ClassChoice> {
    match bytes.below(20) {
        0 => Some(ClassChoice::Number(bytes.below(9))),
        1 => Some(ClassChoice::Name("apple".to_owned())),
        _ => None,
    }
}

fn description(bytes: &mut Bytes<'_>) -> ModelDescription {
    // Each key is rare: most of them contradict most networks.
    let rare = |bytes: &mut Bytes<'_>| bytes.below(12) == 0;
    let side = |bytes: &mut Bytes<'_>| [32, 64, 96, 1, 0, 50][bytes.below(6)];
    let positive = |bytes: &mut Bytes<'_>| bytes.number().abs();
    let mut description = ModelDescription::default();
    description.family = rare(bytes).then(|| {
        let families = [
            Family::YoloV3,
            Family::YoloV3Nms,
            Family::YoloV5,
            Family::YoloV8,
            Family::YoloX,
        ];
        families[bytes.below(families.len())]
    });
    description.classes = rare(bytes).then(|| {
        let names = 0..bytes.below(5);
        names.map(|k| format!("class {k}")).collect()
    });
    description.class = rare(bytes).then(|| ClassChoice::Number(bytes.below(3)));
    description.input_size = rare(bytes).then(|| [side(bytes), side(bytes)]);
    description.strides = rare(bytes).then(|| (0..bytes.below(4)).map(|_| bytes.side()).collect());
    description.anchors = rare(bytes).then(|| {
        let anchors = 0..3 * bytes.below(4);
        anchors
            .map(|_| [positive(bytes), positive(bytes)])
            .collect()
    });
    description.channels = bytes.option(|_| ChannelOrder::Bgr);
    description.scale = rare(bytes).then(|| bytes.number());
    description.mean = rare(bytes).then(|| [0; 3].map(|_| bytes.number()));
    description.std = rare(bytes).then(|| [0; 3].map(|_| bytes.number()));
    description.padding =
        bytes.option(|bytes| [Padding::Center, Padding::TopLeft, Padding::Stretch][bytes.below(3)]);
    description.fill = bytes.option(Bytes::byte);
    description.coordinates =
        bytes.option(|bytes| [Coordinates::Pixels, Coordinates::Normalized][bytes.below(2)]);
    description.threshold = rare(bytes).then(|| bytes.share());
    description.nms_iou = rare(bytes).then(|| bytes.share());
    description.tile = bytes.option(|bytes| 30 + bytes.below(200));
    description.tile_overlap = rare(bytes).then(|| bytes.below(120));
    description.whole_pass = bytes.option(|bytes| bytes.below(2) == 0);
    description
}
