use super::protobuf::{Damage, Field, Fields};
use std::collections::HashMap;

/// A model for the embedded runtime, which knows no defaults for some attributes: the same bytes, and behind
/// each node that leaves such an attribute out, what ONNX says that it is then.
///
/// For convolutions that is the size of the kernel, from the weights' shape; for pooling the step, 1.
/// `Err` names a node that the runtime would read, but not as ONNX means it.
///
/// Source: ONNX operators `Conv`, `ConvTranspose`, `MaxPool` and `AveragePool`, opset 11 and later.
pub(super) fn completed(bytes: &[u8]) -> Result<Vec<u8>, String> {
    model(bytes).map_err(|fault| match fault {
        Fault::Damage(Damage::Short(at) | Damage::Foreign(at)) => format!("damaged at byte {at}"),
        Fault::Misread(node) => format!(
            "node `{node}` pads with auto_pad SAME_LOWER, which it would take for SAME_UPPER; write the pads out"
        ),
    })
}

enum Fault {
    Damage(Damage),
    /// A node that would be read as something else.
    Misread(String),
}

impl From<Damage> for Fault {
    fn from(damage: Damage) -> Self {
        Self::Damage(damage)
    }
}

fn model(bytes: &[u8]) -> Result<Vec<u8>, Fault> {
    let mut whole = Vec::with_capacity(bytes.len() + 4096);
    for field in Fields::new(bytes) {
        let field = field?;
        if field.number == 7 {
            append(&mut whole, 7, &graph(&field)?);
        } else {
            whole.extend(field.raw);
        }
    }
    Ok(whole)
}

fn graph(graph: &Field) -> Result<Vec<u8>, Fault> {
    let mut kernels = HashMap::new();
    for field in graph.message()? {
        let field = field?;
        if field.number == 5 {
            kernels.extend(kernel(&field)?);
        }
    }
    let mut whole = Vec::with_capacity(graph.raw.len() + 4096);
    for field in graph.message()? {
        let field = field?;
        whole.extend(match field.number {
            1 => node(&field, &kernels)?,
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
            1 => shape.extend(field.numbers()?),
            8 => name = field.text()?,
            _ => (),
        }
    }
    Ok((shape.len() > 2).then(|| (name, shape.split_off(2))))
}

/// A node as it is to stand in the graph, its key before it.
fn node(field: &Field, kernels: &HashMap<String, Vec<i64>>) -> Result<Vec<u8>, Fault> {
    let (mut inputs, mut name, mut operator) = (Vec::new(), String::new(), String::new());
    let mut attributes: HashMap<String, Vec<i64>> = HashMap::new();
    let mut pads_low = false;
    for field in field.message()? {
        let field = field?;
        match field.number {
            1 => inputs.push(field.text()?),
            3 => name = field.text()?,
            4 => operator = field.text()?,
            5 => {
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
        return Err(Fault::Misread(name));
    }
    match missing.filter(|(name, _)| !attributes.contains_key(*name)) {
        None => Ok(field.raw.to_vec()),
        Some((name, numbers)) => {
            let mut whole = field.bytes()?.to_vec();
            append(&mut whole, 5, &encoded(name, &numbers));
            let mut outer = Vec::new();
            append(&mut outer, 1, &whole);
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
            1 => name = field.text()?,
            4 => text = field.bytes()?,
            8 => numbers.extend(field.numbers()?),
            _ => (),
        }
    }
    Ok((name, numbers, text))
}

/// An attribute of whole numbers.
fn encoded(name: &str, numbers: &[i64]) -> Vec<u8> {
    let mut attribute = Vec::new();
    append(&mut attribute, 1, name.as_bytes());
    for number in numbers {
        attribute.push(8 << 3);
        append_number(&mut attribute, number.cast_unsigned());
    }
    // Field 20, a number: the kind, of which whole numbers are the seventh.
    append_number(&mut attribute, 20 << 3);
    attribute.push(7);
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
