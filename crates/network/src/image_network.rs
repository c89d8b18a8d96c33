use crate::{
    error::NetworkError, image_input::ImageInput, letterbox::Letterbox, network::Network,
    preparation::Preparation, tensor::Tensor,
};
use pomona_cloud::{ColorImage, PixelWindow};
use pomona_files::Malformed;
use rayon::prelude::*;

/// A network whose input is a colour image, run over windows of larger images.
pub struct ImageNetwork {
    network: Box<dyn Network>,
    image_input: ImageInput,
    /// Width and height of the network's input.
    input: [usize; 2],
    preparation: Preparation,
}

impl ImageNetwork {
    /// The network, fed with images of `[width, height]` pixels that are prepared so.
    ///
    /// # Errors
    ///
    /// The fault of inputs that are not one image, and perhaps its size.
    pub fn new(
        network: Box<dyn Network>,
        input: [usize; 2],
        preparation: Preparation,
    ) -> Result<Self, Malformed> {
        Ok(Self {
            image_input: ImageInput::of(network.inputs())?,
            network,
            input,
            preparation,
        })
    }

    /// The network itself.
    pub fn network(&self) -> &dyn Network {
        &*self.network
    }

    /// Width and height of the network's input in pixels.
    pub fn input_size(&self) -> [usize; 2] {
        self.input
    }

    /// Runs the network on each window, and reads each window's outputs by `read`; the answers in the order of the
    /// windows.
    ///
    /// The windows are spread over rayon's threads, whose number changes nothing. With several errors, it is that of
    /// the first window which is returned.
    ///
    /// # Errors
    ///
    /// [`NetworkError::Image`] for an image without pixels or whose size is not that of its pixels,
    /// [`NetworkError::Window`], whatever the network's run returns, and whatever `read` does.
    pub fn run_windows<T: Send, E: From<NetworkError> + Send>(
        &self,
        image: &ColorImage,
        windows: &[PixelWindow],
        read: impl Fn(Letterbox, Vec<Tensor>) -> Result<T, E> + Sync,
    ) -> Result<Vec<T>, E> {
        check_image(image)?;
        let answers: Vec<Result<T, E>> = windows
            .par_iter()
            .map(|&window| {
                let (letterbox, outputs) = self.run(image, window)?;
                read(letterbox, outputs)
            })
            .collect();
        answers.into_iter().collect()
    }

    /// The network's outputs for one window.
    fn run(
        &self,
        image: &ColorImage,
        window: PixelWindow,
    ) -> Result<(Letterbox, Vec<Tensor>), NetworkError> {
        let letterbox = Letterbox::new(window, self.input, self.preparation.padding);
        let sampled = letterbox.and_then(|l| Some((l, l.sample(image, &self.preparation)?)));
        let (letterbox, values) = sampled.ok_or(NetworkError::Window {
            width: image.width,
            height: image.height,
            window,
        })?;
        let inputs = self.network.inputs();
        let tensors = self.image_input.tensors(inputs, self.input, values);
        Ok((letterbox, self.network.run(&tensors)?))
    }
}

/// Whether an image has pixels, and as many as its size says: what a caller checks before it asks for windows of it.
///
/// # Errors
///
/// [`NetworkError::Image`].
pub fn check_image(image: &ColorImage) -> Result<(), NetworkError> {
    let pixels = image.pixels.len();
    if pixels > 0 && image.width.checked_mul(image.height) == Some(pixels) {
        return Ok(());
    }
    Err(NetworkError::Image {
        width: image.width,
        height: image.height,
        pixels,
    })
}
