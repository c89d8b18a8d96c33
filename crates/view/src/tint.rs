use crate::ViewError;
use pomona_cloud::ColorImage;

/// The image with some pixels tinted: those for which `color`, given the pixel's number row by row, has one are mixed
/// with it by `opacity`, 0 to 1.
///
/// ```
/// use pomona_cloud::ColorImage;
/// use pomona_view::tint;
///
/// let image = ColorImage::filled(2, 1, [100, 100, 100]);
/// let half_red = tint(&image, |pixel| (pixel == 1).then_some([200, 0, 0]), 0.5)?;
/// assert_eq!(half_red.pixels, [[100, 100, 100], [150, 50, 50]]);
/// # Ok::<(), pomona_view::ViewError>(())
/// ```
///
/// # Errors
///
/// [`ViewError`] for an image with fewer or more pixels than its size says.
pub fn tint(
    image: &ColorImage,
    color: impl Fn(usize) -> Option<[u8; 3]>,
    opacity: f32,
) -> Result<ColorImage, ViewError> {
    let (width, height) = (image.width, image.height);
    if image.pixels.is_empty() || width.checked_mul(height) != Some(image.pixels.len()) {
        return Err(ViewError::Size { width, height });
    }
    let opacity = opacity.clamp(0.0, 1.0);
    let mix = |under: u8, over: u8| {
        (f32::from(under) + opacity * (f32::from(over) - f32::from(under))).round() as u8
    };
    let pixels = image.pixels.iter().enumerate().map(|(number, pixel)| {
        color(number).map_or(*pixel, |over| {
            [0, 1, 2].map(|channel| mix(pixel[channel], over[channel]))
        })
    });
    Ok(ColorImage {
        width,
        height,
        pixels: pixels.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_that_lies_is_refused() {
        let image = ColorImage {
            width: 3,
            ..ColorImage::filled(2, 2, [0; 3])
        };
        assert!(tint(&image, |_| None, 0.5).is_err());
        assert!(tint(&ColorImage::filled(0, 0, [0; 3]), |_| None, 0.5).is_err());
    }
}
