use crate::{
    error::NetworkError,
    onnx_file::LARGEST_INPUT,
    tensor::{Port, Tensor, element_count},
};
use pomona_files::Malformed;

/// The given tensors in the order of `ports`, or the error that names the one which does not fit.
pub(super) fn in_port_order<'a>(
    model: &str,
    ports: &[Port],
    given: &'a [Tensor],
) -> Result<Vec<&'a Tensor>, NetworkError> {
    let refuse = |place: String, problem: String| {
        NetworkError::model(
            model,
            Malformed::new(place, problem, "feed what the model's inputs declare"),
        )
    };
    if let Some(stray) = given
        .iter()
        .find(|tensor| ports.iter().all(|port| port.name != tensor.name))
    {
        return Err(refuse(
            format!("input `{}`", stray.name),
            "given, but the model has no such input".to_owned(),
        ));
    }
    let find = |port: &Port| {
        let place = || format!("input `{}`", port.name);
        let tensor = given
            .iter()
            .find(|tensor| tensor.name == port.name)
            .ok_or_else(|| refuse(place(), "not given".to_owned()))?;
        let fits = tensor.shape.len() == port.shape.len()
            && tensor
                .shape
                .iter()
                .zip(&port.shape)
                .all(|(&given, declared)| declared.is_none_or(|declared| declared == given));
        if !fits {
            let problem = format!("is {}, given was {:?}", port.shape_text(), tensor.shape);
            return Err(refuse(place(), problem));
        }
        let numbers = element_count(&tensor.shape).filter(|&count| count <= LARGEST_INPUT);
        if numbers != Some(tensor.data.len()) {
            let problem = format!(
                "{:?} given with {} numbers",
                tensor.shape,
                tensor.data.len()
            );
            return Err(refuse(place(), problem));
        }
        Ok(tensor)
    };
    ports.iter().map(find).collect()
}

/// What an 8-bit input takes: the nearest whole number from 0 to 255.
pub(super) fn to_u8(value: f32) -> u8 {
    value.round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Element;

    fn port() -> Port {
        Port {
            name: "images".into(),
            shape: vec![Some(1), Some(3), None, None],
            element: Element::F32,
        }
    }

    fn tensor(shape: &[usize], count: usize) -> Tensor {
        Tensor {
            name: "images".into(),
            shape: shape.to_vec(),
            data: vec![0.0; count],
        }
    }

    #[test]
    fn an_open_axis_takes_any_length() {
        let given = [tensor(&[1, 3, 4, 2], 24)];
        assert_eq!(in_port_order("m", &[port()], &given).unwrap().len(), 1);
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let message = |given: &[Tensor]| {
            in_port_order("m", &[port()], given)
                .unwrap_err()
                .to_string()
        };
        assert!(message(&[]).contains("input `images`: not given"));
        assert!(
            message(&[tensor(&[1, 4, 4, 2], 32)])
                .contains("is [1, 3, ?, ?], given was [1, 4, 4, 2]")
        );
        assert!(message(&[tensor(&[1, 3, 4, 2], 23)]).contains("with 23 numbers"));
        assert!(message(&[tensor(&[1, 3, usize::MAX, 2], 24)]).contains("with 24 numbers"));
        let mut stray = tensor(&[1], 1);
        stray.name = "x".into();
        assert!(message(&[stray]).contains("`x`: given, but"));
    }
}
