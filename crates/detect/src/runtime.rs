//! Runs a network: ONNX Runtime where the machine has it, else the runtime that is built in.
//!
//! The model's file is read and checked here, the same way for both, so that a damaged or foreign file
//! gets the same message from either and both name the same inputs and outputs.
#![cfg_attr(
    not(all(feature = "onnxruntime", feature = "embedded")),
    allow(
        dead_code,
        reason = "what both runtimes share may have one user or none"
    )
)]

mod apart;
#[cfg(feature = "embedded")]
mod embedded;
mod file_kind;
mod idle;
#[cfg(feature = "onnxruntime")]
mod library;
mod model;
#[cfg(feature = "onnxruntime")]
mod onnxruntime;
#[cfg(feature = "onnxruntime")]
mod places;
mod protobuf;
#[cfg(feature = "onnxruntime")]
mod shared_object;
mod summary;

use crate::{DetectError, Element, Network, Port, RuntimeChoice, Tensor};
use model::Model;
use std::path::PathBuf;

/// Where a model comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelSource {
    /// An ONNX file; weights that it keeps in other files are looked for beside it.
    File(PathBuf),
    /// A model that is part of the program.
    BuiltIn {
        /// Its name in reports and messages.
        name: &'static str,
        /// The ONNX file's content.
        bytes: &'static [u8],
    },
}

/// Most numbers that one input may hold, 2²⁸: 1 GiB.
const MOST_NUMBERS: usize = 1 << 28;

/// Opens a network.
///
/// `threads` is how many threads one run uses, at least 1. One network serves any number of threads at
/// once, so 1 is best where images or tiles are spread over the cores, and more where there is but one.
///
/// # Errors
///
/// [`DetectError::Read`] for a file that cannot be read, [`DetectError::Model`] for one that is no usable
/// model, [`DetectError::Runtime`] where no runtime of the asked kind serves.
pub fn open_network(
    source: &ModelSource,
    choice: &RuntimeChoice,
    threads: usize,
) -> Result<Box<dyn Network>, DetectError> {
    let model = Model::read(source)?;
    let open = match choice {
        RuntimeChoice::Embedded => embedded(None)?,
        RuntimeChoice::OnnxRuntime | RuntimeChoice::Library(_) => onnx_runtime(choice)?,
        RuntimeChoice::Automatic => match onnx_runtime(choice) {
            Ok(open) => open,
            Err(error) => embedded(Some(error.to_string())).map_err(|_| error)?,
        },
    };
    open(model, threads.max(1))
}

/// Opens a model, with so many threads to a run, in a runtime that serves.
type Open = Box<dyn FnOnce(Model, usize) -> Result<Box<dyn Network>, DetectError>>;

#[cfg(feature = "onnxruntime")]
fn onnx_runtime(choice: &RuntimeChoice) -> Result<Open, DetectError> {
    let library = library::load(choice)?;
    Ok(Box::new(|model, threads| {
        let network = onnxruntime::OnnxRuntime::open(model, library, threads)?;
        Ok(Box::new(network))
    }))
}

#[cfg(not(feature = "onnxruntime"))]
fn onnx_runtime(_choice: &RuntimeChoice) -> Result<Open, DetectError> {
    Err(left_out("ONNX Runtime", "onnxruntime"))
}

#[cfg(feature = "embedded")]
#[expect(
    clippy::unnecessary_wraps,
    reason = "a build without it has only an error"
)]
fn embedded(fallback_reason: Option<String>) -> Result<Open, DetectError> {
    Ok(Box::new(|model, threads| {
        let network = embedded::Embedded::open(model, threads, fallback_reason)?;
        Ok(Box::new(network))
    }))
}

#[cfg(not(feature = "embedded"))]
fn embedded(_fallback_reason: Option<String>) -> Result<Open, DetectError> {
    Err(left_out("the embedded runtime", "embedded"))
}

#[cfg(not(all(feature = "onnxruntime", feature = "embedded")))]
fn left_out(runtime: &str, feature: &str) -> DetectError {
    DetectError::Runtime {
        runtime: runtime.to_owned(),
        problem: "left out of this build".to_owned(),
        remedy: format!(
            "build pomona-detect with its feature `{feature}`, or choose the other runtime"
        ),
    }
}

/// Brings the given tensors into the order of `ports`, or tells which does not suit.
fn matched<'a>(
    model: &str,
    ports: &[Port],
    given: &'a [Tensor],
) -> Result<Vec<&'a Tensor>, DetectError> {
    let refuse = |place: String, problem: String| DetectError::Model {
        model: model.to_owned(),
        place,
        problem,
        remedy: "feed what the model's inputs declare".to_owned(),
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
        let suits = tensor.shape.len() == port.shape.len()
            && tensor
                .shape
                .iter()
                .zip(&port.shape)
                .all(|(&given, declared)| declared.is_none_or(|declared| declared == given));
        if !suits {
            let problem = format!(
                "is {}, given was {:?}",
                summary::shape_text(&port.shape),
                tensor.shape
            );
            return Err(refuse(place(), problem));
        }
        let numbers = product(&tensor.shape).filter(|&count| count <= MOST_NUMBERS);
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

/// How many numbers a tensor of this shape holds; `None` where nothing can hold as many.
fn product(shape: &[usize]) -> Option<usize> {
    shape
        .iter()
        .try_fold(1_usize, |all, &axis| all.checked_mul(axis))
}

/// An 8-bit input takes whole numbers from 0 to 255: the nearest one.
fn to_u8(value: f32) -> u8 {
    value.round() as u8
}

/// A network's failure to take one of its inputs or give one of its outputs.
fn unreadable(model: &str, kind: &str, port: &Port, element: &str) -> DetectError {
    let element = match port.element {
        Element::Other => element.to_owned(),
        known => format!("{known:?}"),
    };
    DetectError::Model {
        model: model.to_owned(),
        place: format!("{kind} `{}`", port.name),
        problem: format!("stores {element}, which cannot be converted"),
        remedy: "export the model in 32-bit floating point".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(matched("m", &[port()], &given).unwrap().len(), 1);
    }

    #[test]
    fn what_does_not_suit_is_named() {
        let message = |given: &[Tensor]| matched("m", &[port()], given).unwrap_err().to_string();
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
