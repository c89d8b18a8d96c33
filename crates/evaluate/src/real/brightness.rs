use pomona_cloud::ColorImage;

/// Colour is this much darker or brighter: what a camera's exposure differs by from frame to frame.
pub(super) const BRIGHTNESS_SHARE: f64 = 0.15;

/// The frame's image with all channels multiplied by `factor`.
pub(super) fn brightened(image: &ColorImage, factor: f64) -> ColorImage {
    let scaled = |channel: u8| (f64::from(channel) * factor).round().min(255.0) as u8;
    let mut image = image.clone();
    for pixel in &mut image.pixels {
        *pixel = pixel.map(scaled);
    }
    image
}
