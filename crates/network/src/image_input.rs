use crate::tensor::{Port, Tensor};
use pomona_files::Malformed;

/// Largest side of an input in pixels: beyond it, a slip of the pen would ask for gigabytes.
pub const LARGEST_INPUT_SIDE: usize = 8192;

/// Which of a network's inputs is the image, and which its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ImageInput {
    /// The image, `[1, 3, height, width]`.
    image: usize,
    /// The size of the image, `[1, 2]` as height and width, which the ONNX model zoo's `YOLOv3` takes.
    size: Option<usize>,
}

impl ImageInput {
    pub(crate) fn of(ports: &[Port]) -> Result<Self, Malformed> {
        let image = ports.iter().position(|port| port.shape.len() == 4);
        let fault = |problem: String| {
            let remedy = "export a model that takes one image [1, 3, height, width], and perhaps its size [1, 2]";
            Err(Malformed::new("inputs", problem, remedy))
        };
        let Some(image) = image else {
            let names: Vec<&str> = ports.iter().map(|port| port.name.as_str()).collect();
            return fault(format!("none of {names:?} has the four axes of an image"));
        };
        let is_size = |port: &Port| matches!(port.shape[..], [_, None | Some(2)]);
        let size = ports.iter().position(is_size);
        for (k, port) in ports.iter().enumerate() {
            if k != image && Some(k) != size {
                return fault(format!("`{}` is neither an image nor its size", port.name));
            }
        }
        Ok(Self { image, size })
    }

    /// The inputs in the order of the ports, for an image of this size that has these values.
    pub(crate) fn tensors(
        &self,
        ports: &[Port],
        [width, height]: [usize; 2],
        values: Vec<f32>,
    ) -> Vec<Tensor> {
        let image = Tensor {
            name: ports[self.image].name.clone(),
            shape: vec![1, 3, height, width],
            data: values,
        };
        let Some(at) = self.size else {
            return vec![image];
        };
        let size = Tensor {
            name: ports[at].name.clone(),
            shape: vec![1, 2],
            data: vec![height as f32, width as f32],
        };
        if at < self.image {
            vec![size, image]
        } else {
            vec![image, size]
        }
    }
}

/// Width and height in pixels of the image that a network with these inputs takes, as far as they are declared or
/// `stated` elsewhere; `None` for a side that neither gives.
///
/// # Errors
///
/// The fault of inputs that are not one colour image, `[1, 3, height, width]`, and perhaps its size, `[1, 2]`; of a
/// size that contradicts the stated one; of one beyond [`LARGEST_INPUT_SIDE`].
///
/// ```
/// use pomona_network::{Element, Port, input_size};
///
/// let shape = vec![Some(1), Some(3), None, None];
/// let inputs = [Port { name: "images".to_owned(), shape, element: Element::F32 }];
/// assert_eq!(input_size(&inputs, None), Ok([None, None]));
/// assert_eq!(input_size(&inputs, Some([640, 480])), Ok([Some(640), Some(480)]));
/// assert!(input_size(&inputs[..0], None).is_err());
/// ```
pub fn input_size(
    inputs: &[Port],
    stated: Option<[usize; 2]>,
) -> Result<[Option<usize>; 2], Malformed> {
    let port = &inputs[ImageInput::of(inputs)?.image];
    let place = format!("input `{}`", port.name);
    let fault = |problem: &str, remedy: &str| Err(Malformed::new(&*place, problem, remedy));
    let [batch, channels, height, width] = port.shape[..] else {
        return fault(
            "it does not have the four axes of an image",
            "export a model for images",
        );
    };
    if !matches!(batch, None | Some(1)) {
        return fault(
            "it takes several images at once",
            "export the model for a batch of 1",
        );
    }
    if !matches!(channels, None | Some(3)) {
        let last = width == Some(3);
        return if last {
            fault(
                "its channels come last",
                "export the model with channels first: [1, 3, height, width]",
            )
        } else {
            fault(
                "it does not take three channels",
                "export a model for colour images",
            )
        };
    }
    let mut sides = [width, height];
    for k in 0..2 {
        let wanted = stated.map(|size| size[k]);
        match (sides[k], wanted) {
            (Some(has), Some(wanted)) if has != wanted => {
                let problem = format!("its {} is {has}, not {wanted}", ["width", "height"][k]);
                return fault(
                    &problem,
                    "leave `input_size` out of the description, or correct it",
                );
            }
            (Some(has), _) if !(1..=LARGEST_INPUT_SIDE).contains(&has) => {
                let problem = format!("its {} is {has}", ["width", "height"][k]);
                return fault(
                    &problem,
                    "export the model for an input of 1 to 8192 pixels a side",
                );
            }
            (has, wanted) => sides[k] = has.or(wanted),
        }
    }
    Ok(sides)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Element;

    fn port(name: &str, shape: &[usize]) -> Port {
        Port {
            name: name.to_owned(),
            shape: shape
                .iter()
                .map(|&side| (side > 0).then_some(side))
                .collect(),
            element: Element::F32,
        }
    }

    #[test]
    fn inputs_are_told_apart() {
        let zoo = [port("input_1", &[0, 3, 0, 0]), port("image_shape", &[0, 2])];
        let inputs = ImageInput::of(&zoo).unwrap();
        let tensors = inputs.tensors(&zoo, [32, 64], vec![0.0; 3 * 32 * 64]);
        assert_eq!(tensors[0].shape, [1, 3, 64, 32]);
        assert_eq!(
            (&*tensors[1].name, &*tensors[1].data),
            ("image_shape", &[64.0, 32.0][..])
        );
        let turned = [zoo[1].clone(), zoo[0].clone()];
        assert_eq!(
            ImageInput::of(&turned)
                .unwrap()
                .tensors(&turned, [1, 1], vec![0.0; 3])[0]
                .shape,
            [1, 2]
        );
        assert!(ImageInput::of(&[]).is_err());
        assert!(ImageInput::of(&[port("x", &[1, 5])]).is_err());
        let fault = ImageInput::of(&[port("x", &[1, 3, 8, 8]), port("text", &[1, 7])]).unwrap_err();
        assert!(fault.problem.contains("`text`"), "{fault:?}");
    }

    #[test]
    fn sizes_come_from_model_and_description() {
        let size = |shape: &[usize], stated| input_size(&[port("x", shape)], stated);
        assert_eq!(size(&[1, 3, 8, 9], None), Ok([Some(9), Some(8)]));
        assert_eq!(size(&[0, 3, 0, 0], None), Ok([None, None]));
        assert_eq!(size(&[0, 0, 0, 9], Some([9, 7])), Ok([Some(9), Some(7)]));
        for (shape, stated, word) in [
            (&[1, 3, 8, 9][..], Some([8, 8]), "width is 9, not 8"),
            (&[2, 3, 8, 8], None, "several images"),
            (&[1, 8, 8, 3], None, "channels come last"),
            (&[1, 1, 8, 8], None, "three channels"),
            (&[1, 3, 8, 10_000], None, "width is 10000"),
            (&[3, 8, 8], None, "four axes"),
        ] {
            let fault = size(shape, stated).unwrap_err();
            assert!(fault.problem.contains(word), "{fault:?}");
        }
    }
}
