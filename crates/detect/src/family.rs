use pomona_network::{ChannelOrder, Padding, Preparation};
use serde::Deserialize;
use std::fmt;

/// How a network's outputs are to be read.
///
/// `N` is the number of rows, `C` that of the classes, `A` that of the anchors of each cell. Boxes are centre, width
/// and height; 'decoded' ones in pixels of the input, or in shares of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[non_exhaustive]
pub enum Family {
    /// `YOLOv3` and `YOLOv3-tiny` as they leave the last convolutions: for each stride an output
    /// `[1, A·(5+C), h, w]`, its axes also in the order of Keras or with the anchors on an axis of their own; logits
    /// throughout.
    ///
    /// Redmon and Farhadi, `YOLOv3`: An Incremental Improvement, arXiv 1804.02767, section 2.1.
    #[serde(rename = "yolov3")]
    YoloV3,
    /// The ONNX model zoo's `YOLOv3` and `YOLOv3-tiny`, with their own suppression inside: boxes `[1, N, 4]` as y
    /// and x of two corners, scores `[1, C, N]`, chosen ones `[M, 3]` or `[1, M, 3]` as batch, class and row.
    #[serde(rename = "yolov3-nms")]
    YoloV3Nms,
    /// `YOLOv4`, v5 and v7: `[1, N, 5+C]`, decoded: box, objectness and each class.
    #[serde(rename = "yolov5", alias = "yolov4", alias = "yolov7")]
    YoloV5,
    /// `YOLOv8`, v9 and v11: `[1, 4+C, N]`, decoded: box and each class; `[1, N, 4+C]` too.
    #[serde(
        rename = "yolov8",
        alias = "yolov9",
        alias = "yolov11",
        alias = "yolo11"
    )]
    YoloV8,
    /// What suppresses its boxes itself, such as `YOLOv10`, YOLO26 and Ultralytics' exports with `nms=True`: `[1, N, 6]`,
    /// left, upper, right and lower edge, score and number of the class; numbers behind them are not read.
    ///
    /// Wang et al., `YOLOv10`: Real-Time End-to-End Object Detection, arXiv 2405.14458, section 3.1.
    #[serde(rename = "end2end", alias = "yolov10", alias = "yolo26")]
    EndToEnd,
    /// YOLOX: `[1, N, 5+C]`, one row for each cell, its box relative to the cell and in units of the stride; or in
    /// pixels of the input, where the model was exported with its boxes decoded.
    ///
    /// Ge et al., YOLOX: Exceeding YOLO Series in 2021, arXiv 2107.08430, section 2.1.
    #[serde(rename = "yolox")]
    YoloX,
}

impl Family {
    /// Its name in descriptions and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::YoloV3 => "yolov3",
            Self::YoloV3Nms => "yolov3-nms",
            Self::YoloV5 => "yolov5",
            Self::YoloV8 => "yolov8",
            Self::EndToEnd => "end2end",
            Self::YoloX => "yolox",
        }
    }

    /// How images are prepared for it where its description does not say.
    pub fn preparation(self) -> Preparation {
        let mut preparation = Preparation::default();
        match self {
            Self::YoloV3 | Self::YoloV3Nms => preparation.fill = 128,
            Self::YoloV5 | Self::YoloV8 | Self::EndToEnd => {}
            Self::YoloX => {
                preparation.channels = ChannelOrder::Bgr;
                preparation.scale = 1.0;
                preparation.padding = Padding::TopLeft;
            }
        }
        preparation
    }

    /// Side in pixels of its square input where neither model nor description says.
    pub fn input_side(self) -> usize {
        match self {
            Self::YoloV3 | Self::YoloV3Nms => 416,
            Self::YoloV5 | Self::YoloV8 | Self::EndToEnd | Self::YoloX => 640,
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What decoded boxes are measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Coordinates {
    /// Pixels of the input.
    Pixels,
    /// Shares of the input's width and height.
    Normalized,
}
