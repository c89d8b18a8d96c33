//! Writes ONNX files: what the tests and the benchmark need of the format, and networks made of noise.
//!
//! Numbers of the fields: `onnx.proto3`, ONNX 1.17.

/// Codes of the kinds of numbers.
pub(crate) const F32: i64 = 1;
/// 64-bit whole numbers.
pub(crate) const I64: i64 = 7;
/// Half precision.
pub(crate) const F16: i64 = 10;

/// A length, or the name of an axis that is left open.
#[derive(Clone, Copy)]
pub(crate) enum Axis {
    Fixed(i64),
    Open(&'static str),
}

/// What a node's attribute holds.
#[derive(Clone, Copy)]
pub(crate) enum Attribute<'a> {
    Int(i64),
    Ints(&'a [i64]),
    Float(f32),
    Text(&'a str),
}

/// A protobuf message in the making.
#[derive(Clone, Default)]
struct Message(Vec<u8>);

impl Message {
    fn raw_number(&mut self, mut number: u64) {
        while number >= 0x80 {
            self.0.push(number as u8 | 0x80);
            number >>= 7;
        }
        self.0.push(number as u8);
    }

    fn number(&mut self, field: u64, number: i64) {
        self.raw_number(field << 3);
        self.raw_number(number.cast_unsigned());
    }

    fn float(&mut self, field: u64, number: f32) {
        self.raw_number(field << 3 | 5);
        self.0.extend(number.to_le_bytes());
    }

    fn bytes(&mut self, field: u64, bytes: &[u8]) {
        self.raw_number(field << 3 | 2);
        self.raw_number(bytes.len() as u64);
        self.0.extend(bytes);
    }

    fn text(&mut self, field: u64, text: &str) {
        self.bytes(field, text.as_bytes());
    }

    fn message(&mut self, field: u64, message: &Self) {
        self.bytes(field, &message.0);
    }

    fn entry(&mut self, field: u64, key: &str, value: &str) {
        let mut entry = Self::default();
        entry.text(1, key);
        entry.text(2, value);
        self.message(field, &entry);
    }
}

/// A model in the making.
#[derive(Clone)]
pub(crate) struct Model {
    pub(crate) opset: i64,
    /// Of the input, the output and the weights.
    pub(crate) element: i64,
    graph: Message,
    metadata: Vec<(String, String)>,
    noise: Noise,
}

impl Model {
    /// Without anything in it; weights come from this seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            opset: 13,
            element: F32,
            graph: Message::default(),
            metadata: Vec::new(),
            noise: Noise(seed),
        }
    }

    /// The whole file.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let mut model = Message::default();
        model.number(1, 8);
        model.text(2, "pomona tests");
        let mut graph = self.graph.clone();
        graph.text(2, "network");
        model.message(7, &graph);
        let mut opset = Message::default();
        opset.text(1, "");
        opset.number(2, self.opset);
        model.message(8, &opset);
        for (key, value) in &self.metadata {
            model.entry(14, key, value);
        }
        model.0
    }

    pub(crate) fn metadata(&mut self, key: &str, value: &str) {
        self.metadata.push((key.to_owned(), value.to_owned()));
    }

    pub(crate) fn input(&mut self, name: &str, axes: &[Axis]) {
        self.port(11, name, self.element, axes);
    }

    pub(crate) fn output(&mut self, name: &str, axes: &[Axis]) {
        self.port(12, name, self.element, axes);
    }

    pub(crate) fn port(&mut self, field: u64, name: &str, element: i64, axes: &[Axis]) {
        let mut shape = Message::default();
        for axis in axes {
            let mut message = Message::default();
            match axis {
                Axis::Fixed(length) => message.number(1, *length),
                Axis::Open(name) => message.text(2, name),
            }
            shape.message(1, &message);
        }
        let mut tensor = Message::default();
        tensor.number(1, element);
        tensor.message(2, &shape);
        let mut kind = Message::default();
        kind.message(1, &tensor);
        let mut port = Message::default();
        port.text(1, name);
        port.message(2, &kind);
        self.graph.message(field, &port);
    }

    pub(crate) fn node(
        &mut self,
        operator: &str,
        inputs: &[&str],
        outputs: &[&str],
        attributes: &[(&str, Attribute)],
    ) {
        let mut node = Message::default();
        for name in inputs {
            node.text(1, name);
        }
        for name in outputs {
            node.text(2, name);
        }
        node.text(3, &format!("{operator} to {}", outputs[0]));
        node.text(4, operator);
        for (name, value) in attributes {
            let mut attribute = Message::default();
            attribute.text(1, name);
            let kind = match *value {
                Attribute::Float(number) => {
                    attribute.float(2, number);
                    1
                }
                Attribute::Int(number) => {
                    attribute.number(3, number);
                    2
                }
                Attribute::Text(text) => {
                    attribute.text(4, text);
                    3
                }
                Attribute::Ints(numbers) => {
                    for &number in numbers {
                        attribute.number(8, number);
                    }
                    7
                }
            };
            attribute.number(20, kind);
            node.message(5, &attribute);
        }
        self.graph.message(1, &node);
    }

    /// Weights with this content, whatever the shape claims.
    pub(crate) fn raw_weights(&mut self, name: &str, element: i64, shape: &[i64], bytes: &[u8]) {
        let mut tensor = tensor(name, element, shape);
        tensor.bytes(9, bytes);
        self.graph.message(5, &tensor);
    }

    /// Weights that are in another file.
    pub(crate) fn weights_elsewhere(&mut self, name: &str, shape: &[i64], file: &str) {
        let mut tensor = tensor(name, F32, shape);
        tensor.entry(13, "location", file);
        tensor.entry(13, "offset", "0");
        let length: i64 = shape.iter().product();
        tensor.entry(13, "length", &(4 * length).to_string());
        tensor.number(14, 1);
        self.graph.message(5, &tensor);
    }

    /// Weights of noise with this standard deviation.
    pub(crate) fn weights(&mut self, name: &str, shape: &[i64], deviation: f32) {
        let count: i64 = shape.iter().product();
        let values: Vec<f32> = (0..count).map(|_| deviation * self.noise.draw()).collect();
        let bytes: Vec<u8> = match self.element {
            F16 => values
                .iter()
                .flat_map(|&value| half::f16::from_f32(value).to_le_bytes())
                .collect(),
            _ => values
                .iter()
                .flat_map(|value| value.to_le_bytes())
                .collect(),
        };
        self.raw_weights(name, self.element, shape, &bytes);
    }

    /// A convolution that keeps or divides the size, with a bias, and a leaky rectifier unless it is a head.
    pub(crate) fn convolution(
        &mut self,
        from: &str,
        to: &str,
        channels: [i64; 2],
        kernel: i64,
        stride: i64,
        is_head: bool,
    ) {
        let [taken, given] = channels;
        let (weight, bias, sum) = (
            format!("{to}.weight"),
            format!("{to}.bias"),
            format!("{to}.sum"),
        );
        // Keeps the size of the numbers from layer to layer (He and others 2015, eq. 10, doi:10.1109/ICCV.2015.123).
        let deviation = (2.0 / (taken * kernel * kernel) as f32).sqrt();
        self.weights(&weight, &[given, taken, kernel, kernel], deviation);
        self.weights(&bias, &[given], 0.1);
        let pad = kernel / 2;
        let convolved = if is_head { to } else { sum.as_str() };
        self.node(
            "Conv",
            &[from, &weight, &bias],
            &[convolved],
            &[
                ("auto_pad", Attribute::Text("NOTSET")),
                ("dilations", Attribute::Ints(&[1, 1])),
                ("group", Attribute::Int(1)),
                ("kernel_shape", Attribute::Ints(&[kernel, kernel])),
                ("pads", Attribute::Ints(&[pad; 4])),
                ("strides", Attribute::Ints(&[stride, stride])),
            ],
        );
        if !is_head {
            self.node(
                "LeakyRelu",
                &[convolved],
                &[to],
                &[("alpha", Attribute::Float(0.1))],
            );
        }
    }

    /// The largest of each 2×2, at every second pixel or, padded to the right and below, at each.
    pub(crate) fn pool(&mut self, from: &str, to: &str, stride: i64) {
        let pad = i64::from(stride == 1);
        self.node(
            "MaxPool",
            &[from],
            &[to],
            &[
                ("auto_pad", Attribute::Text("NOTSET")),
                ("ceil_mode", Attribute::Int(0)),
                ("dilations", Attribute::Ints(&[1, 1])),
                ("kernel_shape", Attribute::Ints(&[2, 2])),
                ("pads", Attribute::Ints(&[0, 0, pad, pad])),
                ("storage_order", Attribute::Int(0)),
                ("strides", Attribute::Ints(&[stride, stride])),
            ],
        );
    }
}

fn tensor(name: &str, element: i64, shape: &[i64]) -> Message {
    let mut tensor = Message::default();
    for &axis in shape {
        tensor.number(1, axis);
    }
    tensor.number(2, element);
    tensor.text(8, name);
    tensor
}

/// Two convolutions and what stands between: `images` [1, 3, 32, 32] to `output` [1, 6, 8, 8].
pub(crate) fn small() -> Model {
    let side = Axis::Fixed(32);
    small_of(F32, &[Axis::Fixed(1), Axis::Fixed(3), side, side])
}

/// The same with other numbers or axes.
pub(crate) fn small_of(element: i64, axes: &[Axis]) -> Model {
    let mut model = Model::new(7);
    model.element = element;
    model.input("images", axes);
    model.convolution("images", "first", [3, 8], 3, 2, false);
    model.pool("first", "pooled", 2);
    model.convolution("pooled", "head", [8, 6], 1, 1, true);
    model.node("Sigmoid", &["head"], &["output"], &[]);
    let open = ["batch", "channel", "row", "column"].map(Axis::Open);
    model.output("output", &open);
    model
}

/// YOLOv3-tiny with two heads of three anchors each, for square images of `side` pixels, and noise for weights.
///
/// Source: Redmon and Farhadi 2018, arXiv:1804.02767, and its configuration `yolov3-tiny.cfg`.
pub(crate) fn yolov3_tiny(side: i64, classes: i64) -> Model {
    let mut model = Model::new(3);
    model.input(
        "images",
        &[
            Axis::Fixed(1),
            Axis::Fixed(3),
            Axis::Fixed(side),
            Axis::Fixed(side),
        ],
    );
    let widths = [3, 16, 32, 64, 128, 256, 512];
    let mut from = "images".to_owned();
    for (index, pair) in widths.windows(2).enumerate() {
        let (name, pooled) = (format!("c{index}"), format!("p{index}"));
        model.convolution(&from, &name, [pair[0], pair[1]], 3, 1, false);
        model.pool(&name, &pooled, if index == 5 { 1 } else { 2 });
        from = pooled;
    }
    let given = 3 * (5 + classes);
    model.convolution(&from, "c6", [512, 1024], 3, 1, false);
    model.convolution("c6", "c7", [1024, 256], 1, 1, false);
    model.convolution("c7", "c8", [256, 512], 3, 1, false);
    model.convolution("c8", "large", [512, given], 1, 1, true);
    model.convolution("c7", "c10", [256, 128], 1, 1, false);
    let scales: Vec<u8> = [1.0_f32, 1.0, 2.0, 2.0]
        .iter()
        .flat_map(|scale| scale.to_le_bytes())
        .collect();
    model.raw_weights("scales", F32, &[4], &scales);
    model.node(
        "Resize",
        &["c10", "", "scales"],
        &["wide"],
        &[
            (
                "coordinate_transformation_mode",
                Attribute::Text("asymmetric"),
            ),
            ("mode", Attribute::Text("nearest")),
            ("nearest_mode", Attribute::Text("floor")),
        ],
    );
    model.node(
        "Concat",
        &["wide", "c4"],
        &["joined"],
        &[("axis", Attribute::Int(1))],
    );
    model.convolution("joined", "c11", [384, 256], 3, 1, false);
    model.convolution("c11", "small", [256, given], 1, 1, true);
    for (name, stride) in [("large", 32), ("small", 16)] {
        let cells = Axis::Fixed(side / stride);
        model.output(name, &[Axis::Fixed(1), Axis::Fixed(given), cells, cells]);
    }
    model
}

/// Numbers that look drawn at random, the same ones for the same seed.
///
/// Source: `SplitMix64`, Steele, Lea and Flood 2014, fig. 16, doi:10.1145/2660193.2660195.
#[derive(Clone)]
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    /// Even over 0 to 1.
    pub(crate) fn even(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    /// Mean 0, standard deviation 1: the sum of twelve even ones.
    pub(crate) fn draw(&mut self) -> f32 {
        (0..12).map(|_| self.even()).sum::<f32>() - 6.0
    }
}
