use crate::strokes::{ImageStrokes, PathSample, StrokeClass};

/// Width in pixels of the band along a stroke's edge that is neither wood nor not: a hand draws no better.
const UNSURE_BAND: f64 = 1.0;

/// The part of an image that has been drawn in: discs, each with its middle and radius in pixels.
pub(crate) type Discs = Vec<([f64; 2], f64)>;

/// What strokes say about each pixel of an image.
pub(crate) struct Truth {
    pub(crate) size: [usize; 2],
    /// The pixels of the strokes' bands.
    pub(crate) wood: Vec<bool>,
    /// The pixels within the tolerance of those.
    pub(crate) near: Vec<bool>,
    /// Pixels that do not count: near far wood, and not near wood.
    pub(crate) ignored: Vec<bool>,
    /// Pixels along the edges of bands, which do not count for calibration.
    pub(crate) unsure: Vec<bool>,
    /// Points on the centre lines of wood that lie in the image.
    pub(crate) wood_samples: Vec<PathSample>,
    /// The same of posts.
    pub(crate) post_samples: Vec<PathSample>,
}

impl Truth {
    /// The truth of an image of `[width, height]` pixels at a tolerance in pixels, within `discs` or the whole image.
    pub(crate) fn new(
        strokes: &ImageStrokes,
        size: [usize; 2],
        tolerance: f64,
        discs: Option<&Discs>,
    ) -> Self {
        let count = size[0] * size[1];
        let drawn = |[x, y]: [f64; 2]| {
            let holds = |([u, v], radius): &([f64; 2], f64)| (x - u).hypot(y - v) <= *radius;
            discs.is_none_or(|discs| discs.iter().any(holds))
        };
        let mut truth = Self {
            size,
            wood: vec![false; count],
            near: vec![false; count],
            ignored: vec![false; count],
            unsure: vec![false; count],
            wood_samples: samples(strokes, StrokeClass::Wood, size, drawn),
            post_samples: samples(strokes, StrokeClass::Post, size, drawn),
        };
        for (k, ignored) in truth.ignored.iter_mut().enumerate() {
            *ignored = !drawn([(k % size[0]) as f64 + 0.5, (k / size[0]) as f64 + 0.5]);
        }
        let margin = tolerance.max(UNSURE_BAND);
        for stroke in strokes.of(StrokeClass::Wood) {
            stroke.for_pixels_near(size, margin, |k, edge| {
                truth.wood[k] |= edge <= 0.0;
                truth.near[k] |= edge <= tolerance;
                truth.unsure[k] |= edge.abs() <= UNSURE_BAND;
            });
        }
        for stroke in strokes.of(StrokeClass::Far) {
            stroke.for_pixels_near(size, margin, |k, _| truth.ignored[k] |= !truth.near[k]);
        }
        truth
    }

    /// The pixel that holds a point inside the image.
    pub(crate) fn pixel(&self, sample: &PathSample) -> usize {
        let [width, height] = self.size;
        let u = (sample.point.x as usize).min(width - 1);
        let v = (sample.point.y as usize).min(height - 1);
        v * width + u
    }
}

fn samples(
    strokes: &ImageStrokes,
    class: StrokeClass,
    [width, height]: [usize; 2],
    drawn: impl Fn([f64; 2]) -> bool,
) -> Vec<PathSample> {
    let inside = |sample: &PathSample| {
        let (x, y) = (sample.point.x, sample.point.y);
        (0.0..=width as f64).contains(&x) && (0.0..=height as f64).contains(&y) && drawn([x, y])
    };
    strokes
        .of(class)
        .flat_map(|stroke| stroke.samples().filter(inside).collect::<Vec<_>>())
        .collect()
}
