use crate::{Port, Tensor, description::LARGEST_INPUT_SIDE, fault::Fault};

/// Which of a network's inputs is what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Inputs {
    /// The image, `[1, 3, height, width]`.
    pub(crate) image: usize,
    /// The size of the image, `[1, 2]`, which the zoo's `YOLOv3` wants to know.
    shape: Option<usize>,
}

impl Inputs {
    pub(crate) fn of(ports: &[Port]) -> Result<Self, Fault> {
        let image = ports.iter().position(|port| port.shape.len() == 4);
        let fault = |problem: String| {
            let remedy = "export a model that takes one image [1, 3, height, width], and perhaps its size [1, 2]";
            Err(Fault::new("inputs", problem, remedy))
        };
        let Some(image) = image else {
            let names: Vec<&str> = ports.iter().map(|port| port.name.as_str()).collect();
            return fault(format!("none of {names:?} has the four axes of an image"));
        };
        let is_shape = |port: &Port| matches!(port.shape[..], [_, None | Some(2)]);
        let shape = ports.iter().position(is_shape);
        for (k, port) in ports.iter().enumerate() {
            if k != image && Some(k) != shape {
                return fault(format!("`{}` is neither an image nor its size", port.name));
            }
        }
        Ok(Self { image, shape })
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
        let Some(at) = self.shape else {
            return vec![image];
        };
        let shape = Tensor {
            name: ports[at].name.clone(),
            shape: vec![1, 2],
            data: vec![height as f32, width as f32],
        };
        if at < self.image {
            vec![shape, image]
        } else {
            vec![image, shape]
        }
    }
}

/// Width and height of an image's input, as far as the model or its description says.
pub(crate) fn input_size(
    port: &Port,
    described: Option<[usize; 2]>,
) -> Result<[Option<usize>; 2], Fault> {
    let place = format!("input `{}`", port.name);
    let fault = |problem: &str, remedy: &str| Err(Fault::new(&*place, problem, remedy));
    let [batch, channels, height, width] = port.shape[..] else {
        return fault(
            "it has not the four axes of an image",
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
        let wanted = described.map(|size| size[k]);
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

/// Both sides, where both are known.
pub(crate) fn both([width, height]: [Option<usize>; 2]) -> Option<[usize; 2]> {
    Some([width?, height?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Element;

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
        let inputs = Inputs::of(&zoo).unwrap();
        let tensors = inputs.tensors(&zoo, [32, 64], vec![0.0; 3 * 32 * 64]);
        assert_eq!(tensors[0].shape, [1, 3, 64, 32]);
        assert_eq!(
            (&*tensors[1].name, &*tensors[1].data),
            ("image_shape", &[64.0, 32.0][..])
        );
        let turned = [zoo[1].clone(), zoo[0].clone()];
        assert_eq!(
            Inputs::of(&turned)
                .unwrap()
                .tensors(&turned, [1, 1], vec![0.0; 3])[0]
                .shape,
            [1, 2]
        );
        assert!(Inputs::of(&[]).is_err());
        assert!(Inputs::of(&[port("x", &[1, 5])]).is_err());
        let fault = Inputs::of(&[port("x", &[1, 3, 8, 8]), port("text", &[1, 7])]).unwrap_err();
        assert!(fault.problem.contains("`text`"), "{fault:?}");
    }

    #[test]
    fn sizes_come_from_model_and_description() {
        let size = |shape: &[usize], described| input_size(&port("x", shape), described);
        assert_eq!(size(&[1, 3, 8, 9], None), Ok([Some(9), Some(8)]));
        assert_eq!(size(&[0, 3, 0, 0], None), Ok([None, None]));
        assert_eq!(size(&[0, 0, 0, 9], Some([9, 7])), Ok([Some(9), Some(7)]));
        for (shape, described, word) in [
            (&[1, 3, 8, 9][..], Some([8, 8]), "width is 9, not 8"),
            (&[2, 3, 8, 8], None, "several images"),
            (&[1, 8, 8, 3], None, "channels come last"),
            (&[1, 1, 8, 8], None, "three channels"),
            (&[1, 3, 8, 10_000], None, "width is 10000"),
            (&[3, 8, 8], None, "four axes"),
        ] {
            let fault = size(shape, described).unwrap_err();
            assert!(fault.problem.contains(word), "{fault:?}");
        }
    }
}
