use super::pixel_box::PixelBox;

/// A box with what its file says of its class.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LabelledBox {
    /// The box.
    pub bounds: PixelBox,
    /// Number of its class: the first number of a YOLO line, the `category_id` of COCO. VOC has none.
    pub class_number: Option<u64>,
    /// Name of its class: the `name` of VOC, that of the category in COCO. YOLO has none.
    pub class_name: Option<String>,
    /// Whether a detector has to find it.
    pub kind: LabelKind,
}

/// Whether a detector has to find what a label boxes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LabelKind {
    /// It has to.
    #[default]
    Object,
    /// It may or may not: `difficult` in VOC, `ignore` in COCO.
    Difficult,
    /// Many objects under one box, of which it may find any: `iscrowd` in COCO.
    Crowd,
}

impl LabelledBox {
    /// A box without further information.
    pub fn new(bounds: PixelBox) -> Self {
        Self {
            bounds,
            class_number: None,
            class_name: None,
            kind: LabelKind::Object,
        }
    }
}
