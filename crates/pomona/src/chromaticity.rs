use nalgebra::Vector2;
use pomona_cloud::ColorImage;

/// Sum of the three channels below which a pixel is too dark to have a colour.
const LEAST_SUM: f64 = 45.0;

/// Shares of red and of green in the sum of the three channels of pixel `v * width + u`; `None` outside of the image and
/// where it is too dark to tell.
pub(crate) fn chromaticity(color: &ColorImage, pixel: usize) -> Option<Vector2<f64>> {
    let [r, g, b] = color.pixels.get(pixel)?.map(f64::from);
    let sum = r + g + b;
    (sum >= LEAST_SUM).then(|| Vector2::new(r / sum, g / sum))
}
