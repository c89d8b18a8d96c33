use super::protobuf::{Damage, Field, Fields};
use crate::tensor::{Element, Port, element_count};
use pomona_files::Malformed;
use std::collections::{BTreeSet, HashSet};

/// What an ONNX file says about itself: its ports, and where else its weights are.
///
/// Numbers of the fields: `onnx.proto3`, ONNX 1.17. Weights and nodes are left to the runtimes.
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
            1 => self.has_version = (1..1000).contains(&field.number_value()?),
            7 => {
                self.has_graph = true;
                for field in field.message()? {
                    self.graph_field(&field?)?;
                }
            }
            8 => self.opset(field)?,
            14 => self.summary.metadata.push(entry(field)?),
            _ => (),
        }
        Ok(())
    }

    fn opset(&mut self, field: &Field) -> Result<(), Damage> {
        let (mut domain, mut version) = (String::new(), None);
        for field in field.message()? {
            let field = field?;
            match field.number {
                1 => domain = field.text()?,
                2 => version = Some(field.number_value()?),
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
            5 => self.weights(field)?,
            11 => self.summary.inputs.push(port(field)?),
            12 => self.summary.outputs.push(port(field)?),
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
                1 => shape.extend(field.numbers()?),
                2 => element = field.number_value()?,
                8 => name = field.text()?,
                9 => bytes = Some(field.bytes()?.len()),
                13 => elsewhere.push(entry(&field)?),
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
            1 => key = field.text()?,
            2 => value = field.text()?,
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
            1 => port.name = field.text()?,
            2 => port_type(&field, &mut port)?,
            _ => (),
        }
    }
    Ok(port)
}

fn port_type(field: &Field, port: &mut Port) -> Result<(), Damage> {
    for field in field.message()? {
        let field = field?;
        // Sequences and maps have other numbers: they stay `Other`.
        if field.number == 1 {
            for field in field.message()? {
                let field = field?;
                match field.number {
                    1 => port.element = element(field.number_value()?),
                    2 => port.shape = shape(&field)?,
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
        .filter(|field| !matches!(field, Ok(field) if field.number != 1));
    let axis = |field: Result<Field, Damage>| {
        let mut length = None;
        for field in field?.message()? {
            let field = field?;
            if field.number == 1 {
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

/// Bytes of one number; `None` for text and for what is packed.
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
