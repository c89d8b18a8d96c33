use super::distance::squared_distances;
use super::images::{SegmentationImage, SegmentationTruth};
use super::mask::{MaskPixels, TruthMask};
use super::skeleton::center_line;
use crate::error::LabelsError;
use crate::strokes::{ImageStrokes, PathSample, Stroke, StrokeClass, StrokePoint};
use pomona_cloud::{BoxChoice, BoxImage, Frame, PixelBox, read_boxes};

/// Width in pixels of the band along an edge of wood that is neither wood nor not: a hand draws no better.
const UNSURE_BAND: f64 = 1.0;

/// Distance in pixels of a pixel's centre from its edge.
const HALF_PIXEL: f64 = 0.5;

/// The part of an image that has been drawn in: discs, each with its middle and radius in pixels.
type Discs = Vec<([f64; 2], f64)>;

/// What strokes or a mask say about each pixel of an image.
pub(crate) struct Truth {
    pub(crate) size: [usize; 2],
    /// The pixels of wood: of the strokes' bands, or of the mask.
    pub(crate) wood: Vec<bool>,
    /// The pixels within the tolerance of those.
    pub(crate) near: Vec<bool>,
    /// Pixels of which nobody has said what they are.
    pub(crate) outside: Vec<bool>,
    /// Pixels that do not count: those, and those that are near far wood and not near wood.
    pub(crate) ignored: Vec<bool>,
    /// Pixels along the edges of wood, which do not count for calibration.
    pub(crate) unsure: Vec<bool>,
    /// Points on the centre lines of wood that lie in the image.
    pub(crate) wood_samples: Vec<PathSample>,
    /// The same of posts.
    pub(crate) post_samples: Vec<PathSample>,
}

impl Truth {
    /// The truth of an image of `[width, height]` pixels at a tolerance in pixels, within so many radii of the apples
    /// that are boxed beside it, or of the whole image.
    ///
    /// # Errors
    ///
    /// [`LabelsError`] for strokes outside of the image, for a mask that cannot be read or has another size, and
    /// where there are no boxes and radii are given.
    pub(crate) fn of(
        image: &SegmentationImage,
        size: [usize; 2],
        tolerance: f64,
        apple_radii: Option<f64>,
    ) -> Result<Self, LabelsError> {
        let discs = apple_radii.map(|radii| discs(image, size, radii));
        let discs = discs.transpose()?;
        let drawn = |[x, y]: [f64; 2]| {
            let holds = |([u, v], radius): &([f64; 2], f64)| (x - u).hypot(y - v) <= *radius;
            discs.as_ref().is_none_or(|discs| discs.iter().any(holds))
        };
        match &image.truth {
            SegmentationTruth::Strokes(strokes) => {
                are_inside(strokes, image, size)?;
                Ok(Self::of_strokes(strokes, size, tolerance, drawn))
            }
            SegmentationTruth::Mask(mask) => Self::of_mask(mask, size, tolerance, drawn),
        }
    }

    fn of_strokes(
        strokes: &ImageStrokes,
        size: [usize; 2],
        tolerance: f64,
        drawn: impl Fn([f64; 2]) -> bool,
    ) -> Self {
        let mut truth = Self {
            wood_samples: samples(strokes, StrokeClass::Wood, size, &drawn),
            post_samples: samples(strokes, StrokeClass::Post, size, &drawn),
            ..Self::nothing(size, drawn)
        };
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

    /// Distances are between centres of pixels.
    fn of_mask(
        mask: &TruthMask,
        size: [usize; 2],
        tolerance: f64,
        drawn: impl Fn([f64; 2]) -> bool,
    ) -> Result<Self, LabelsError> {
        let MaskPixels { wood, unseen } = mask.read(size)?;
        let mut wood_samples = center_line(&wood, size);
        wood_samples.retain(|sample| drawn([sample.point.x, sample.point.y]));
        let mut truth = Self::nothing(size, drawn);
        for (k, is_unseen) in unseen.iter().enumerate() {
            truth.outside[k] |= is_unseen;
            truth.ignored[k] |= is_unseen;
        }
        let from_wood = squared_distances(size, |k| wood[k]);
        let from_rest = squared_distances(size, |k| !wood[k]);
        for (k, (wood, rest)) in from_wood.iter().zip(&from_rest).enumerate() {
            truth.near[k] = wood.sqrt() <= tolerance;
            truth.unsure[k] = wood.max(*rest).sqrt() - HALF_PIXEL <= UNSURE_BAND;
        }
        Ok(Self {
            wood,
            wood_samples,
            ..truth
        })
    }

    /// An image without wood.
    fn nothing(size: [usize; 2], drawn: impl Fn([f64; 2]) -> bool) -> Self {
        let count = size[0] * size[1];
        let is_outside = |k: usize| {
            let (u, v) = (k % size[0], k / size[0]);
            !drawn([u as f64 + HALF_PIXEL, v as f64 + HALF_PIXEL])
        };
        let outside: Vec<bool> = (0..count).map(is_outside).collect();
        Self {
            size,
            wood: vec![false; count],
            near: vec![false; count],
            ignored: outside.clone(),
            outside,
            unsure: vec![false; count],
            wood_samples: Vec::new(),
            post_samples: Vec::new(),
        }
    }

    /// Length in pixels of the centre lines of wood.
    pub(crate) fn wood_length(&self) -> f64 {
        self.wood_samples.iter().map(|sample| sample.length).sum()
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

/// Whether every stroke has something in the image.
fn are_inside(
    strokes: &ImageStrokes,
    image: &SegmentationImage,
    size: [usize; 2],
) -> Result<(), LabelsError> {
    let outside = |stroke: &&Stroke| {
        let within = |x: f64, size: usize| (0.0..=size as f64).contains(&x);
        let inside = |p: &StrokePoint| within(p.x, size[0]) && within(p.y, size[1]);
        !stroke.points.iter().any(inside) && !stroke.samples().any(|sample| inside(&sample.point))
    };
    let Some(stroke) = strokes.strokes.iter().find(outside) else {
        return Ok(());
    };
    let first = stroke.points.first().map_or([f64::NAN; 2], |p| [p.x, p.y]);
    let problem = format!(
        "{}x{} pixels, and a stroke from ({}, {}) lies outside",
        size[0], size[1], first[0], first[1]
    );
    let remedy = "are the strokes of another image or size?";
    Err(LabelsError::malformed(&image.path, &problem, remedy))
}

/// So many radii about each apple that is boxed beside the image.
fn discs(image: &SegmentationImage, size: [usize; 2], radii: f64) -> Result<Discs, LabelsError> {
    let beside = |name: &&str| image.path.with_file_name(name);
    let Some(path) = Frame::BOX_FILES
        .iter()
        .map(beside)
        .find(|path| path.is_file())
    else {
        let problem = format!("no {} beside it", Frame::BOX_FILES.join(", "));
        let remedy = "count whole images, or give frames with boxes";
        return Err(LabelsError::malformed(&image.path, &problem, remedy));
    };
    let about = BoxImage::new(size[0], size[1]).at(&image.path);
    let boxes = read_boxes(path, &about, &BoxChoice::default())?.value;
    let disc = |b: &PixelBox| {
        let middle = [
            f64::midpoint(b.x_min, b.x_max),
            f64::midpoint(b.y_min, b.y_max),
        ];
        (
            middle,
            radii * (b.x_max - b.x_min).max(b.y_max - b.y_min) / 2.0,
        )
    };
    Ok(boxes.iter().map(disc).collect())
}
