//! What a model's file is: read, checked, and summarised, before an inference backend sees it.

pub(crate) mod fields;
mod file_kind;
pub(crate) mod protobuf;
mod summary;

use crate::{
    error::NetworkError,
    source::ModelSource,
    tensor::{Element, Port, element_count},
};
use file_kind::foreign_kind;
use pomona_files::Malformed;
use std::borrow::Cow;
use std::path::{Component, Path};
use std::sync::Arc;
use summary::Summary;

/// An ONNX file that was read and looks right.
#[cfg_attr(
    not(any(feature = "embedded", feature = "onnxruntime")),
    expect(dead_code, reason = "no inference backend in this build reads it")
)]
pub(crate) struct OnnxFile {
    /// Its file, or its name if it is built in.
    pub(crate) name: String,
    pub(crate) bytes: Cow<'static, [u8]>,
    pub(crate) inputs: Vec<Port>,
    pub(crate) outputs: Vec<Port>,
    pub(crate) opset: Option<i64>,
    pub(crate) metadata: Vec<(String, String)>,
    /// Weights in other files, by their paths in the model.
    pub(crate) external: Vec<(String, Arc<[u8]>)>,
}

/// Most numbers that one input may hold, 2²⁸: 1 GiB.
pub(crate) const LARGEST_INPUT: usize = 1 << 28;

/// Largest file that protobuf can hold, in bytes.
const LARGEST_FILE: u64 = (1 << 31) - 1;

impl OnnxFile {
    /// Reads a model, and what it keeps in other files.
    pub(crate) fn read(source: &ModelSource) -> Result<Self, NetworkError> {
        let (name, bytes, folder) = match source {
            ModelSource::File(path) => {
                let bytes = read_file(path)?;
                (path.display().to_string(), bytes.into(), path.parent())
            }
            ModelSource::BuiltIn { name, bytes } => {
                ((*name).to_owned(), Cow::Borrowed(*bytes), None)
            }
        };
        if let Some(fault) = foreign_kind(&bytes) {
            return Err(NetworkError::model(name, fault));
        }
        let summary = Summary::parse(&bytes).and_then(|summary| {
            check_ports(&summary)?;
            Ok(summary)
        });
        let summary = summary.map_err(|fault| NetworkError::model(&*name, fault))?;
        let external = summary
            .external
            .iter()
            .map(|location| Ok((location.clone(), read_weights(folder, location)?)))
            .collect::<Result<_, Malformed>>()
            .map_err(|fault| NetworkError::model(&*name, fault))?;
        Ok(Self {
            name,
            bytes,
            inputs: summary.inputs,
            outputs: summary.outputs,
            opset: summary.opset,
            metadata: summary.metadata,
            external,
        })
    }

    /// What an inference backend says about the model, as an error.
    #[cfg_attr(
        not(any(feature = "embedded", feature = "onnxruntime")),
        expect(dead_code, reason = "no inference backend in this build reads it")
    )]
    pub(crate) fn refused(&self, runtime: &str, place: &str, said: &str) -> NetworkError {
        let opset = match self.opset {
            Some(opset) => format!("operators of opset {opset}"),
            None => "operators of no stated opset".to_owned(),
        };
        let fault = Malformed::new(
            place,
            format!("{runtime} refuses the network, {opset}: {}", said.trim()),
            "export it with an opset from 11 to 17 and standard operators, or try the other runtime",
        );
        NetworkError::model(&*self.name, fault)
    }
}

fn read_file(path: &Path) -> Result<Vec<u8>, NetworkError> {
    let unreadable = |source| NetworkError::Read {
        path: path.to_owned(),
        source,
    };
    let about = std::fs::metadata(path).map_err(unreadable)?;
    if about.is_file() && about.len() > LARGEST_FILE {
        let problem = format!(
            "{} bytes: no ONNX file is larger than {LARGEST_FILE}",
            about.len()
        );
        let remedy = "give a network's .onnx file, or export the weights to a file of their own";
        let fault = Malformed::new("whole file", problem, remedy);
        return Err(NetworkError::model(path.display().to_string(), fault));
    }
    std::fs::read(path).map_err(unreadable)
}

/// Reads weights that are in another file beside the model.
fn read_weights(folder: Option<&Path>, location: &str) -> Result<Arc<[u8]>, Malformed> {
    let fault = |problem: String, remedy: &str| {
        Malformed::new(format!("weights in `{location}`"), problem, remedy)
    };
    let Some(folder) = folder else {
        return Err(fault(
            "a built-in model has no folder".to_owned(),
            "export it with all weights inside",
        ));
    };
    let path = Path::new(location);
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if location.is_empty() || !path.components().all(is_inside) {
        return Err(fault(
            "lies outside the model's folder, from where nothing is read".to_owned(),
            "put the file beside the model and export it so",
        ));
    }
    let path = folder.join(path);
    let bytes = std::fs::read(&path).map_err(|error| {
        fault(
            format!("{} cannot be read: {error}", path.display()),
            "copy the file that was exported with the model to that place",
        )
    })?;
    Ok(bytes.into())
}

/// Refuses a network without an image among its inputs, without outputs, or with inputs that cannot be filled.
fn check_ports(summary: &Summary) -> Result<(), Malformed> {
    if !summary.inputs.iter().any(is_image) {
        let inputs: Vec<String> = summary
            .inputs
            .iter()
            .map(|port| format!("`{}` {}", port.name, port.shape_text()))
            .collect();
        let problem = match inputs.as_slice() {
            [] => "there are none".to_owned(),
            _ => format!("none takes a colour image: {}", inputs.join(", ")),
        };
        let remedy = "give a network with an input [1, 3, height, width]";
        return Err(Malformed::new("inputs", problem, remedy));
    }
    if summary.outputs.is_empty() {
        let remedy = "give a network that was exported with its outputs";
        return Err(Malformed::new("outputs", "there are none", remedy));
    }
    for port in &summary.inputs {
        if port.element == Element::Other {
            return Err(unconvertible("input", port, "another kind of number"));
        }
        let least: Vec<usize> = port.shape.iter().map(|axis| axis.unwrap_or(1)).collect();
        if element_count(&least).is_none_or(|count| count > LARGEST_INPUT) {
            return Err(Malformed::new(
                format!("input `{}`", port.name),
                format!("{} is larger than any image", port.shape_text()),
                "export the model for images of a usual size, such as 416 or 640",
            ));
        }
    }
    Ok(())
}

/// The fault of an input or output whose numbers cannot be converted from or to `f32`; `element` is what it stores.
pub(crate) fn unconvertible(kind: &str, port: &Port, element: &str) -> Malformed {
    Malformed::new(
        format!("{kind} `{}`", port.name),
        format!("stores {element}, which cannot be converted"),
        "export the model in 32-bit floating point",
    )
}

/// Whether a colour image goes in here: four axes, and three channels as the second or last.
fn is_image(port: &Port) -> bool {
    let three = |axis: Option<usize>| axis.is_none_or(|length| length == 3);
    matches!(port.shape.as_slice(), &[_, second, _, last] if three(second) || three(last))
}
