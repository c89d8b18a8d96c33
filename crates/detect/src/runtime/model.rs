use super::file_kind::FileKind;
use super::summary::{Flaw, Summary, shape_text};
use super::{MOST_NUMBERS, ModelSource, product, unreadable};
use crate::{DetectError, Element, Port};
use std::borrow::Cow;
use std::path::{Component, Path};
use std::sync::Arc;

/// A model that was read and looks right.
pub(super) struct Model {
    /// Its file, or its name if it is built in.
    pub(super) name: String,
    pub(super) bytes: Cow<'static, [u8]>,
    pub(super) inputs: Vec<Port>,
    pub(super) outputs: Vec<Port>,
    pub(super) opset: Option<i64>,
    pub(super) metadata: Vec<(String, String)>,
    /// Weights in other files, by their paths in the model.
    pub(super) external: Vec<(String, Arc<[u8]>)>,
}

/// Largest file that protobuf can hold, in bytes.
const LARGEST_FILE: u64 = (1 << 31) - 1;

impl Model {
    /// Reads a model, and what it keeps in other files.
    pub(super) fn read(source: &ModelSource) -> Result<Self, DetectError> {
        let (name, bytes, folder) = match source {
            ModelSource::File(path) => {
                let bytes = read_file(path)?;
                (path.display().to_string(), bytes.into(), path.parent())
            }
            ModelSource::BuiltIn { name, bytes } => {
                ((*name).to_owned(), Cow::Borrowed(*bytes), None)
            }
        };
        let refuse = |flaw: Flaw| refusal(&name, flaw);
        if let Some(kind) = FileKind::of(&bytes) {
            return Err(refuse(Flaw {
                place: "first bytes".to_owned(),
                problem: format!("is no ONNX model but {}", kind.what),
                remedy: kind.remedy,
            }));
        }
        let summary = Summary::parse(&bytes).map_err(refuse)?;
        check_ports(&name, &summary)?;
        let external = summary
            .external
            .iter()
            .map(|location| Ok((location.clone(), read_weights(&name, folder, location)?)))
            .collect::<Result<_, DetectError>>()?;
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

    /// What a runtime says about the model, as an error.
    pub(super) fn refused(&self, runtime: &str, place: &str, said: &str) -> DetectError {
        let opset = match self.opset {
            Some(opset) => format!("operators of opset {opset}"),
            None => "operators of no stated opset".to_owned(),
        };
        DetectError::Model {
            model: self.name.clone(),
            place: place.to_owned(),
            problem: format!("{runtime} refuses the network, {opset}: {}", said.trim()),
            remedy: "export it with an opset from 11 to 17 and standard operators, or try the other runtime"
                .to_owned(),
        }
    }
}

fn refusal(model: &str, flaw: Flaw) -> DetectError {
    DetectError::Model {
        model: model.to_owned(),
        place: flaw.place,
        problem: flaw.problem,
        remedy: flaw.remedy.to_owned(),
    }
}

fn read_file(path: &Path) -> Result<Vec<u8>, DetectError> {
    let unreadable = |source| DetectError::Read {
        path: path.to_owned(),
        source,
    };
    let about = std::fs::metadata(path).map_err(unreadable)?;
    if about.is_file() && about.len() > LARGEST_FILE {
        return Err(refusal(
            &path.display().to_string(),
            Flaw {
                place: "whole file".to_owned(),
                problem: format!(
                    "{} bytes: no ONNX file is larger than {LARGEST_FILE}",
                    about.len()
                ),
                remedy: "give a detector's .onnx file, or export the weights to a file of their own",
            },
        ));
    }
    std::fs::read(path).map_err(unreadable)
}

/// Reads weights that are in another file beside the model.
fn read_weights(
    model: &str,
    folder: Option<&Path>,
    location: &str,
) -> Result<Arc<[u8]>, DetectError> {
    let flaw = |problem: String, remedy| {
        let place = format!("weights in `{location}`");
        refusal(
            model,
            Flaw {
                place,
                problem,
                remedy,
            },
        )
    };
    let Some(folder) = folder else {
        return Err(flaw(
            "a built-in model has no folder".to_owned(),
            "export it with all weights inside",
        ));
    };
    let path = Path::new(location);
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if location.is_empty() || !path.components().all(is_inside) {
        return Err(flaw(
            "lies outside the model's folder, from where nothing is read".to_owned(),
            "put the file beside the model and export it so",
        ));
    }
    let path = folder.join(path);
    let bytes = std::fs::read(&path).map_err(|error| {
        flaw(
            format!("{} cannot be read: {error}", path.display()),
            "copy the file that was exported with the model to that place",
        )
    })?;
    Ok(bytes.into())
}

/// A detector has an image among its inputs, and both runtimes can fill them all.
fn check_ports(model: &str, summary: &Summary) -> Result<(), DetectError> {
    let flaw = |place: String, problem: String, remedy| {
        Err(refusal(
            model,
            Flaw {
                place,
                problem,
                remedy,
            },
        ))
    };
    if !summary.inputs.iter().any(is_image) {
        let inputs: Vec<String> = summary
            .inputs
            .iter()
            .map(|port| format!("`{}` {}", port.name, shape_text(&port.shape)))
            .collect();
        let problem = match inputs.as_slice() {
            [] => "there are none".to_owned(),
            _ => format!("none takes a colour image: {}", inputs.join(", ")),
        };
        return flaw(
            "inputs".to_owned(),
            problem,
            "give a detector with an input [1, 3, height, width]",
        );
    }
    if summary.outputs.is_empty() {
        return flaw(
            "outputs".to_owned(),
            "there are none".to_owned(),
            "give a detector that was exported with its outputs",
        );
    }
    for port in &summary.inputs {
        if port.element == Element::Other {
            return Err(unreadable(model, "input", port, "another kind of number"));
        }
        let least: Vec<usize> = port.shape.iter().map(|axis| axis.unwrap_or(1)).collect();
        if product(&least).is_none_or(|numbers| numbers > MOST_NUMBERS) {
            return flaw(
                format!("input `{}`", port.name),
                format!("{} is larger than any image", shape_text(&port.shape)),
                "export the model for images of a usual size, such as 416 or 640",
            );
        }
    }
    Ok(())
}

/// Whether a colour image goes in here: four axes, and three channels as the second or last.
fn is_image(port: &Port) -> bool {
    let three = |axis: Option<usize>| axis.is_none_or(|length| length == 3);
    matches!(port.shape.as_slice(), &[_, second, _, last] if three(second) || three(last))
}
