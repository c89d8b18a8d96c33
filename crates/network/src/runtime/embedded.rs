use super::explicit_attributes::with_explicit_attributes;
use super::idle::Idle;
use super::inputs::{in_port_order, to_u8};
use super::isolated::run_isolated;
use crate::{
    error::NetworkError,
    network::{Network, RuntimeReport},
    onnx_file::{OnnxFile, unconvertible},
    tensor::{Port, Tensor},
};
use rten::{NodeId, RunOptions, ThreadPool, Value, ValueOrView, ValueType};
use rten_tensor::{AsView, Layout, TensorView};
use std::borrow::Cow;
use std::sync::Arc;

/// The release of rten that is built in.
const VERSION: &str = "rten 0.27";

const NAME: &str = "the embedded runtime";

/// A network that rten runs, the embedded backend.
///
/// One network serves all threads; each run has a pool of threads to itself, so that runs neither wait for
/// each other nor share the caller's threads.
pub(super) struct Embedded {
    network: rten::Model,
    /// Without its bytes: the network has them.
    file: OnnxFile,
    inputs: Vec<NodeId>,
    outputs: Vec<NodeId>,
    threads: usize,
    pools: Idle<Arc<ThreadPool>>,
    fallback_reason: Option<String>,
}

impl Embedded {
    pub(super) fn open(
        mut file: OnnxFile,
        threads: usize,
        fallback_reason: Option<String>,
    ) -> Result<Self, NetworkError> {
        let external = std::mem::take(&mut file.external);
        let bytes = std::mem::replace(&mut file.bytes, Cow::Borrowed(&[]));
        let refuse = |said: String| file.refused(NAME, "network", &said);
        let bytes = with_explicit_attributes(&bytes).map_err(refuse)?;
        let load = || {
            let mut options = rten::ModelOptions::with_all_ops();
            for (location, bytes) in &external {
                options.external_data(location, bytes.to_vec());
            }
            options.load(bytes)
        };
        let network = run_isolated(load)
            .map_err(refuse)?
            .map_err(|error| refuse(error.to_string()))?;
        let nodes = |ports: &[Port]| {
            let node = |port: &Port| network.node_id(&port.name);
            let nodes: Result<Vec<_>, _> = ports.iter().map(node).collect();
            nodes.map_err(|error| refuse(error.to_string()))
        };
        Ok(Self {
            inputs: nodes(&file.inputs)?,
            outputs: nodes(&file.outputs)?,
            network,
            file,
            threads,
            pools: Idle::new(pool(threads)),
            fallback_reason,
        })
    }

    fn outputs_of(
        &self,
        pool: &Arc<ThreadPool>,
        inputs: &[&Tensor],
    ) -> Result<Vec<Tensor>, NetworkError> {
        let refuse = |said: String| self.file.refused(NAME, "run", &said);
        let values = self
            .inputs
            .iter()
            .zip(inputs)
            .map(|(&node, tensor)| Ok((node, self.value(node, tensor)?)))
            .collect::<Result<Vec<_>, NetworkError>>()?;
        let options = RunOptions::default().with_thread_pool(Some(Arc::clone(pool)));
        let values = run_isolated(|| self.network.run(values, &self.outputs, Some(options)))
            .map_err(refuse)?
            .map_err(|error| refuse(error.to_string()))?;
        let ports = self.file.outputs.iter();
        ports
            .zip(values)
            .map(|(port, value)| read(&self.file.name, port, value))
            .collect()
    }

    /// An input's numbers as the network stores them: it knows fewer kinds than the model's file.
    fn value<'a>(&self, node: NodeId, tensor: &'a Tensor) -> Result<ValueOrView<'a>, NetworkError> {
        let shape = tensor.shape.as_slice();
        let refuse = |said: String| {
            let place = format!("input `{}`", tensor.name);
            self.file.refused(NAME, &place, &said)
        };
        let stored = self.network.node_info(node).and_then(|info| info.dtype());
        let stored = match stored {
            Some(ValueType::Tensor(stored)) => stored,
            _ => rten::DataType::Float,
        };
        let whole = tensor.data.iter().map(|&value| value.round() as i32);
        match stored {
            rten::DataType::Float => TensorView::try_from_data(shape, tensor.data.as_slice())
                .map(ValueOrView::from)
                .map_err(|error| refuse(error.to_string())),
            rten::DataType::Int32 => Value::from_shape(shape, whole.collect())
                .map(ValueOrView::from)
                .map_err(|error| refuse(error.to_string())),
            rten::DataType::UInt8 => {
                let bytes = tensor.data.iter().map(|&value| to_u8(value)).collect();
                Value::from_shape(shape, bytes)
                    .map(ValueOrView::from)
                    .map_err(|error| refuse(error.to_string()))
            }
            other => Err(refuse(format!("stores {other}, which no image is"))),
        }
    }
}

impl Network for Embedded {
    fn inputs(&self) -> &[Port] {
        &self.file.inputs
    }

    fn outputs(&self) -> &[Port] {
        &self.file.outputs
    }

    fn run(&self, inputs: &[Tensor]) -> Result<Vec<Tensor>, NetworkError> {
        let inputs = in_port_order(&self.file.name, &self.file.inputs, inputs)?;
        self.pools.with(
            || Ok(pool(self.threads)),
            |pool| self.outputs_of(pool, &inputs),
        )
    }

    fn report(&self) -> RuntimeReport {
        RuntimeReport {
            fallback_reason: self.fallback_reason.clone(),
            ..RuntimeReport::new("embedded", VERSION)
        }
    }

    fn metadata(&self) -> &[(String, String)] {
        &self.file.metadata
    }
}

fn pool(threads: usize) -> Arc<ThreadPool> {
    Arc::new(ThreadPool::with_num_threads(threads))
}

fn read(model: &str, port: &Port, value: Value) -> Result<Tensor, NetworkError> {
    let (shape, data) = match value {
        Value::FloatTensor(numbers) => (numbers.shape().to_vec(), numbers.into_data()),
        Value::Int32Tensor(numbers) => {
            let shape = numbers.shape().to_vec();
            (shape, numbers.iter().map(|&number| number as f32).collect())
        }
        Value::Int8Tensor(numbers) => {
            let shape = numbers.shape().to_vec();
            (
                shape,
                numbers.iter().map(|&number| f32::from(number)).collect(),
            )
        }
        Value::UInt8Tensor(numbers) => {
            let shape = numbers.shape().to_vec();
            (
                shape,
                numbers.iter().map(|&number| f32::from(number)).collect(),
            )
        }
        _ => {
            return Err(NetworkError::model(
                model,
                unconvertible("output", port, "a sequence"),
            ));
        }
    };
    Ok(Tensor {
        name: port.name.clone(),
        shape,
        data,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_report_names_the_release_that_is_built_in() {
        let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.toml");
        let manifest = std::fs::read_to_string(manifest).unwrap();
        let line = manifest.lines().find(|line| line.starts_with("rten = "));
        let release = VERSION.strip_prefix("rten ").unwrap();
        assert!(line.unwrap().contains(&format!("version = \"{release}\"")));
    }
}
