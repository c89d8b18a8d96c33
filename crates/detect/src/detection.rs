use crate::error::DetectError;
use pomona_cloud::{ColorImage, PixelBox};
use pomona_network::RuntimeReport;
use serde::Serialize;

/// A box detected in an image.
///
/// Edges in pixels of the image, counted from its left and upper edge: the first pixel spans 0 to 1. A box may
/// reach beyond the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// Left edge.
    pub x_min: f64,
    /// Upper edge.
    pub y_min: f64,
    /// Right edge.
    pub x_max: f64,
    /// Lower edge.
    pub y_max: f64,
    /// How sure the detector is, 0 to 1.
    pub score: f64,
    /// Number of the class in the model's own list.
    pub class: usize,
}

impl Detection {
    /// Area in square pixels; 0 for an inverted box.
    pub fn area(&self) -> f64 {
        (self.x_max - self.x_min).max(0.0) * (self.y_max - self.y_min).max(0.0)
    }

    /// Area common to two boxes over the area that both cover, 0 to 1; 0 where both are empty.
    pub fn iou(&self, other: &Self) -> f64 {
        let width = self.x_max.min(other.x_max) - self.x_min.max(other.x_min);
        let height = self.y_max.min(other.y_max) - self.y_min.max(other.y_min);
        let common = width.max(0.0) * height.max(0.0);
        let union = self.area() + other.area() - common;
        if union > 0.0 { common / union } else { 0.0 }
    }

    /// The box as box files hold it, under this name.
    pub fn to_pixel_box(&self, name: impl Into<String>) -> PixelBox {
        PixelBox {
            name: name.into(),
            x_min: self.x_min,
            y_min: self.y_min,
            x_max: self.x_max,
            y_max: self.y_max,
            score: self.score,
        }
    }
}

/// Detects objects in a colour image.
///
/// One detector serves many threads. The same image gives the same detections, best first.
pub trait Detector: Send + Sync {
    /// What is seen in `image`, best first.
    ///
    /// # Errors
    ///
    /// [`DetectError`]; an image without apples is not one.
    fn detect(&self, image: &ColorImage) -> Result<Vec<Detection>, DetectError>;

    /// What it would give in `image` for each of these lowest scores, in their order: where boxes of several tiles are
    /// joined, those that a higher threshold leaves out have no say in it.
    ///
    /// By default the boxes of that score of what [`Detector::detect`] gives.
    ///
    /// # Errors
    ///
    /// As [`Detector::detect`].
    fn detect_at(
        &self,
        image: &ColorImage,
        lowest_scores: &[f64],
    ) -> Result<Vec<Vec<Detection>>, DetectError> {
        let all = self.detect(image)?;
        let above = |lowest: &f64| all.iter().filter(|d| d.score >= *lowest).copied().collect();
        Ok(lowest_scores.iter().map(above).collect())
    }

    /// Which detector this is, for the record.
    fn report(&self) -> DetectorReport;
}

/// Which detector ran, and how: part of the output, so that a result can be traced.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct DetectorReport {
    /// Name of the detector or of the model's file.
    pub name: String,
    /// How its outputs were read, such as `yolox`; absent where it has no such choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub family: Option<String>,
    /// Name of the class that counts, or the names of several; absent where the model's classes have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub class_name: Option<String>,
    /// The inference backend; absent where none of ours ran.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runtime: Option<RuntimeReport>,
    /// What was assumed about the model, and how to state it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

impl DetectorReport {
    /// The report of a detector of this name, without further information.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }
}
