use super::decoder::Decoder;
use crate::detection::Detection;

/// Collects the boxes whose scores reach the threshold.
pub(super) struct Collector {
    pub(super) detections: Vec<Detection>,
    class: usize,
    threshold: f64,
}

impl Collector {
    pub(super) fn new(decoder: &Decoder) -> Self {
        Self {
            detections: Vec::new(),
            class: decoder.wanted.first().copied().unwrap_or_default(),
            threshold: decoder.threshold,
        }
    }

    /// Whether a score is kept; NaN is not.
    pub(super) fn counts(&self, score: f32) -> bool {
        f64::from(score) >= self.threshold && score.is_finite()
    }

    /// Adds a box by its centre and size, if it is one and its score counts.
    pub(super) fn add_centred(&mut self, [x, y, width, height]: [f32; 4], score: f32) {
        let [x, y, width, height] = [x, y, width, height].map(f64::from);
        let (half_width, half_height) = (width / 2.0, height / 2.0);
        self.add_corners(
            [
                x - half_width,
                y - half_height,
                x + half_width,
                y + half_height,
            ],
            score,
        );
    }

    /// Adds a box by its upper left and lower right corner, if it is one and its score counts.
    pub(super) fn add_corners(&mut self, [x_min, y_min, x_max, y_max]: [f64; 4], score: f32) {
        let finite = [x_min, y_min, x_max, y_max].iter().all(|x| x.is_finite());
        if finite && x_min < x_max && y_min < y_max && self.counts(score) {
            self.detections.push(Detection {
                x_min,
                y_min,
                x_max,
                y_max,
                score: f64::from(score).clamp(0.0, 1.0),
                class: self.class,
            });
        }
    }
}
