use super::fields;
use super::protobuf::{Damage, Field, Fields};
use crate::tensor::{Element, Port, element_count};
use pomona_files::Malformed;
use std::collections::{BTreeSet, HashSet};

/// What an ONNX file says about itself: its ports, and where else its weights are.
///
/// Weights and nodes are left to the inference backends.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Summary {
    pub(super) inputs: Vec<Port>,
    pub(super) outputs: Vec<Port>,
    /// Version of the operators of ONNX's own domain.
    pub(super) opset: Option<i64>,
    /// What the exporter wrote down, such as the classes' names.
    pub(super) metadata: Vec<(String, String)>,
    /// Files with weights, by their paths relative to the model's folder.
    pub(super) external: BTreeSet<String>,
}

/// Versions of ONNX's intermediate representation that are taken for one: there have been 12 so far.
const IR_VERSIONS: std::ops::Range<i64> = 1..1000;

const AGAIN: &str = "export or download it again";

impl Summary {
    /// Reads a file's content.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, Malformed> {
        let mut reading = Reading::default();
        let read = Fields::new(bytes).try_for_each(|field| reading.model_field(&field?));
        match read {
            Err(damage) => Err(reading.fault_of(damage, bytes.len())),
            Ok(()) => reading.finish(),
        }
    }
}

/// A [`Summary`] in the making.
#[derive(Default)]
struct Reading {
    summary: Summary,
    /// Names of the weights: old files list them as inputs too.
    weights: HashSet<String>,
    fault: Option<Malformed>,
    has_version: bool,
    has_graph: bool,
}

impl Reading {
    fn model_field(&mut self, field: &Field) -> Result<(), Damage> {
        match field.number {
            fields::MODEL_IR_VERSION => {
                self.has_version = IR_VERSIONS.contains(&field.number_value()?);
            }
            fields::MODEL_GRAPH => {
                self.has_graph = true;
                for field in field.message()? {
                    self.graph_field(&field?)?;
                }
            }
            fields::MODEL_OPSET_IMPORT => self.opset(field)?,
            fields::MODEL_METADATA_PROPS => self.summary.metadata.push(entry(field)?),
            _ => (),
        }
        Ok(())
    }

    fn opset(&mut self, field: &Field) -> Result<(), Damage> {
        let (mut domain, mut version) = (String::new(), None);
        for field in field.message()? {
            let field = field?;
            match field.number {
                fields::OPSET_DOMAIN => domain = field.text()?,
                fields::OPSET_VERSION => version = Some(field.number_value()?),
                _ => (),
            }
        }
        if domain.is_empty() || domain == "ai.onnx" {
            self.summary.opset = version;
        }
        Ok(())
    }

    fn graph_field(&mut self, field: &Field) -> Result<(), Damage> {
        match field.number {
            fields::GRAPH_INITIALIZER => self.weights(field)?,
            fields::GRAPH_INPUT => self.summary.inputs.push(port(field)?),
            fields::GRAPH_OUTPUT => self.summary.outputs.push(port(field)?),
            _ => (),
        }
        Ok(())
    }

    fn weights(&mut self, field: &Field) -> Result<(), Damage> {
        let (mut name, mut shape, mut bytes, mut element, mut elsewhere) =
            (String::new(), Vec::new(), None, 0, Vec::new());
        for field in field.message()? {
            let field = field?;
            match field.number {
                fields::TENSOR_DIMS => shape.extend(field.numbers()?),
                fields::TENSOR_DATA_TYPE => element = field.number_value()?,
                fields::TENSOR_NAME => name = field.text()?,
                fields::TENSOR_RAW_DATA => bytes = Some(field.bytes()?.len()),
                fields::TENSOR_EXTERNAL_DATA => elsewhere.push(entry(&field)?),
                _ => (),
            }
        }
        let locations = elsewhere.into_iter().filter(|(key, _)| key == "location");
        let before = self.summary.external.len();
        self.summary
            .external
            .extend(locations.map(|(_, path)| path));
        let is_here = self.summary.external.len() == before;
        if let (Some(bytes), Some(size), true) = (bytes, size_of(element), is_here) {
            let axes: Option<Vec<usize>> = shape
                .iter()
                .map(|&axis| usize::try_from(axis).ok())
                .collect();
            let count = axes.and_then(|axes| element_count(&axes));
            let wanted = count.and_then(|count| count.checked_mul(size));
            if wanted != Some(bytes) && self.fault.is_none() {
                self.fault = Some(Malformed::new(
                    format!("weights `{name}`"),
                    format!("are {shape:?} of {size} bytes each, but {bytes} bytes are there"),
                    AGAIN,
                ));
            }
        }
        self.weights.insert(name);
        Ok(())
    }

    fn fault_of(&self, damage: Damage, length: usize) -> Malformed {
        let place = |at: usize| format!("byte {at} of {length}");
        match damage {
            Damage::Short(at) if self.has_version => Malformed::new(
                place(at),
                "the file ends in the middle: it is truncated",
                AGAIN,
            ),
            Damage::Foreign(at) if self.has_graph => Malformed::new(
                place(at),
                "what stands there is no part of a model: the file is damaged",
                AGAIN,
            ),
            Damage::Short(at) | Damage::Foreign(at) => foreign(place(at)),
        }
    }

    fn finish(mut self) -> Result<Summary, Malformed> {
        if !self.has_graph {
            return Err(if self.has_version {
                let problem = "no network in it: it is truncated or was never finished";
                Malformed::new("end of the file", problem, AGAIN)
            } else {
                foreign("whole file".to_owned())
            });
        }
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        let weights = self.weights;
        self.summary
            .inputs
            .retain(|port| !weights.contains(&port.name));
        Ok(self.summary)
    }
}

fn foreign(place: String) -> Malformed {
    Malformed::new(
        place,
        "is not an ONNX model",
        "give a model exported as ONNX",
    )
}

/// A key and its value.
fn entry(field: &Field) -> Result<(String, String), Damage> {
    let (mut key, mut value) = (String::new(), String::new());
    for field in field.message()? {
        let field = field?;
        match field.number {
            fields::ENTRY_KEY => key = field.text()?,
            fields::ENTRY_VALUE => value = field.text()?,
            _ => (),
        }
    }
    Ok((key, value))
}

fn port(field: &Field) -> Result<Port, Damage> {
    let mut port = Port {
        name: String::new(),
        shape: Vec::new(),
        element: Element::Other,
    };
    for field in field.message()? {
        let field = field?;
        match field.number {
            fields::VALUE_NAME => port.name = field.text()?,
            fields::VALUE_TYPE => port_type(&field, &mut port)?,
            _ => (),
        }
    }
    Ok(port)
}

fn port_type(field: &Field, port: &mut Port) -> Result<(), Damage> {
    for field in field.message()? {
        let field = field?;
        // Sequences and maps have other numbers: they stay `Other`.
        if field.number == fields::TYPE_TENSOR {
            for field in field.message()? {
                let field = field?;
                match field.number {
                    fields::TENSOR_TYPE_ELEMENT => port.element = element(field.number_value()?),
                    fields::TENSOR_TYPE_SHAPE => port.shape = shape(&field)?,
                    _ => (),
                }
            }
        }
    }
    Ok(())
}

fn shape(field: &Field) -> Result<Vec<Option<usize>>, Damage> {
    let axes = field
        .message()?
        .filter(|field| !matches!(field, Ok(field) if field.number != fields::SHAPE_DIMENSION));
    let axis = |field: Result<Field, Damage>| {
        let mut length = None;
        for field in field?.message()? {
            let field = field?;
            if field.number == fields::DIMENSION_LENGTH {
                // Some exporters write 0 or -1 for an axis that they leave open.
                length = usize::try_from(field.number_value()?)
                    .ok()
                    .filter(|&length| length > 0);
            }
        }
        Ok(length)
    };
    axes.map(axis).collect()
}

/// By the number of a `TensorProto.DataType`.
fn element(number: i64) -> Element {
    match number {
        1 => Element::F32,
        2 => Element::U8,
        6 => Element::I32,
        7 => Element::I64,
        10 => Element::F16,
        _ => Element::Other,
    }
}

/// Bytes of one number of a `TensorProto.DataType`; `None` for text and for what is packed.
fn size_of(element: i64) -> Option<usize> {
    match element {
        2 | 3 | 9 => Some(1),
        4 | 5 | 10 | 16 => Some(2),
        1 | 6 | 12 => Some(4),
        7 | 11 | 13 => Some(8),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn any_bytes_give_a_summary_or_a_fault(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
            let _ = Summary::parse(&bytes);
            // Behind a version and a graph of one output, so that the reading goes deeper.
            let mut model = vec![0x08, 0x08, 0x3a, 0x80, 0x04];
            model.extend(&bytes);
            model.resize(5 + 512, 0x62);
            let _ = Summary::parse(&model);
        }
    }
}
