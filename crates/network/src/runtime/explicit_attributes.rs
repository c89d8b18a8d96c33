use crate::onnx_file::{
    fields,
    protobuf::{Damage, Field, Fields},
};
use std::collections::HashMap;

/// A model with the attributes written out for which the embedded backend knows no defaults: the same bytes,
/// and behind each node that leaves such an attribute out, the value that ONNX gives it then.
///
/// For convolutions that is the size of the kernel, from the weights' shape; for pooling the stride, 1.
///
/// Source: ONNX operators `Conv`, `ConvTranspose`, `MaxPool` and `AveragePool`, opset 11 and later.
///
/// # Errors
///
/// What is wrong, for a node that the backend would read, but not as ONNX means it.
pub(super) fn with_explicit_attributes(bytes: &[u8]) -> Result<Vec<u8>, String> {
    model(bytes).map_err(|refusal| match refusal {
        Refusal::Damage(Damage::Short(at) | Damage::Foreign(at)) => format!("damaged at byte {at}"),
        Refusal::Misread(node) => format!(
            "node `{node}` pads with auto_pad SAME_LOWER, which it would take for SAME_UPPER; write the pads out"
        ),
    })
}

enum Refusal {
    Damage(Damage),
    /// The name of a node that would be read as something else.
    Misread(String),
}

impl From<Damage> for Refusal {
    fn from(damage: Damage) -> Self {
        Self::Damage(damage)
    }
}

/// Numbers of the fields of nodes and their attributes, which only this reads (`onnx.proto3`, ONNX 1.17).
mod field {
    pub(super) const GRAPH_NODE: u64 = 1;
    pub(super) const NODE_INPUT: u64 = 1;
    pub(super) const NODE_NAME: u64 = 3;
    pub(super) const NODE_OP_TYPE: u64 = 4;
    pub(super) const NODE_ATTRIBUTE: u64 = 5;
    pub(super) const ATTRIBUTE_NAME: u64 = 1;
    pub(super) const ATTRIBUTE_S: u64 = 4;
    pub(super) const ATTRIBUTE_INTS: u64 = 8;
    pub(super) const ATTRIBUTE_TYPE: u64 = 20;
    /// The `ATTRIBUTE_TYPE` of `ATTRIBUTE_INTS`.
    pub(super) const TYPE_INTS: u8 = 7;
}

/// Room for the attributes that are added to a message, bytes.
const ROOM: usize = 4096;

fn model(bytes: &[u8]) -> Result<Vec<u8>, Refusal> {
    let mut whole = Vec::with_capacity(bytes.len() + ROOM);
    for field in Fields::new(bytes) {
        let field = field?;
        if field.number == fields::MODEL_GRAPH {
            append(&mut whole, fields::MODEL_GRAPH, &graph(&field)?);
        } else {
            whole.extend(field.raw);
        }
    }
    Ok(whole)
}

fn graph(graph: &Field) -> Result<Vec<u8>, Refusal> {
    let mut kernels = HashMap::new();
    for field in graph.message()? {
        let field = field?;
        if field.number == fields::GRAPH_INITIALIZER {
            kernels.extend(kernel(&field)?);
        }
    }
    let mut whole = Vec::with_capacity(graph.raw.len() + ROOM);
    for field in graph.message()? {
        let field = field?;
        whole.extend(match field.number {
            field::GRAPH_NODE => node(&field, &kernels)?,
            _ => field.raw.to_vec(),
        });
    }
    Ok(whole)
}

/// The name of weights that are a convolution's, and the size of its kernel.
fn kernel(weights: &Field) -> Result<Option<(String, Vec<i64>)>, Damage> {
    let (mut name, mut shape) = (String::new(), Vec::new());
    for field in weights.message()? {
        let field = field?;
        match field.number {
            fields::TENSOR_DIMS => shape.extend(field.numbers()?),
            fields::TENSOR_NAME => name = field.text()?,
            _ => (),
        }
    }
    Ok((shape.len() > 2).then(|| (name, shape.split_off(2))))
}

/// A node with its attributes, as a field of the graph.
fn node(field: &Field, kernels: &HashMap<String, Vec<i64>>) -> Result<Vec<u8>, Refusal> {
    let (mut inputs, mut name, mut operator) = (Vec::new(), String::new(), String::new());
    let mut attributes: HashMap<String, Vec<i64>> = HashMap::new();
    let mut pads_low = false;
    for field in field.message()? {
        let field = field?;
        match field.number {
            field::NODE_INPUT => inputs.push(field.text()?),
            field::NODE_NAME => name = field.text()?,
            field::NODE_OP_TYPE => operator = field.text()?,
            field::NODE_ATTRIBUTE => {
                let (name, numbers, text) = attribute(&field)?;
                pads_low |= name == "auto_pad" && text == b"SAME_LOWER";
                attributes.insert(name, numbers);
            }
            _ => (),
        }
    }
    let missing = match operator.as_str() {
        "Conv" | "ConvInteger" | "ConvTranspose" => {
            let kernel = inputs.get(1).and_then(|weights| kernels.get(weights));
            kernel.map(|kernel| ("kernel_shape", kernel.clone()))
        }
        "MaxPool" | "AveragePool" => {
            let kernel = attributes.get("kernel_shape");
            kernel.map(|kernel| ("strides", vec![1; kernel.len()]))
        }
        _ => return Ok(field.raw.to_vec()),
    };
    let kernel = attributes
        .get("kernel_shape")
        .or(missing.as_ref().map(|(_, kernel)| kernel));
    if pads_low && !pads_evenly(kernel, attributes.get("strides")) {
        return Err(Refusal::Misread(name));
    }
    match missing.filter(|(name, _)| !attributes.contains_key(*name)) {
        None => Ok(field.raw.to_vec()),
        Some((name, numbers)) => {
            let mut whole = field.bytes()?.to_vec();
            append(&mut whole, field::NODE_ATTRIBUTE, &encoded(name, &numbers));
            let mut outer = Vec::new();
            append(&mut outer, field::GRAPH_NODE, &whole);
            Ok(outer)
        }
    }
}

/// Whether as much is padded before as behind, so that lower and upper are the same.
fn pads_evenly(kernel: Option<&Vec<i64>>, strides: Option<&Vec<i64>>) -> bool {
    kernel.is_some_and(|kernel| kernel.iter().all(|side| side % 2 == 1))
        && strides.is_none_or(|strides| strides.iter().all(|&step| step == 1))
}

/// An attribute's name, whole numbers and text.
fn attribute<'a>(field: &Field<'a>) -> Result<(String, Vec<i64>, &'a [u8]), Damage> {
    let (mut name, mut numbers, mut text) = (String::new(), Vec::new(), [].as_slice());
    for field in field.message()? {
        let field = field?;
        match field.number {
            field::ATTRIBUTE_NAME => name = field.text()?,
            field::ATTRIBUTE_S => text = field.bytes()?,
            field::ATTRIBUTE_INTS => numbers.extend(field.numbers()?),
            _ => (),
        }
    }
    Ok((name, numbers, text))
}

/// An attribute of whole numbers.
fn encoded(name: &str, numbers: &[i64]) -> Vec<u8> {
    let mut attribute = Vec::new();
    append(&mut attribute, field::ATTRIBUTE_NAME, name.as_bytes());
    for number in numbers {
        append_number(&mut attribute, field::ATTRIBUTE_INTS << 3);
        append_number(&mut attribute, number.cast_unsigned());
    }
    append_number(&mut attribute, field::ATTRIBUTE_TYPE << 3);
    attribute.push(field::TYPE_INTS);
    attribute
}

/// Appends a field of bytes.
fn append(whole: &mut Vec<u8>, number: u64, bytes: &[u8]) {
    append_number(whole, number << 3 | 2);
    append_number(whole, bytes.len() as u64);
    whole.extend(bytes);
}

fn append_number(whole: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        whole.push(number as u8 | 0x80);
        number >>= 7;
    }
    whole.push(number as u8);
}
