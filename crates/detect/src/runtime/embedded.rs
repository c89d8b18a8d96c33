use super::apart::apart;
use super::idle::Idle;
use super::model::Model;
use super::{matched, to_u8, unreadable};
use crate::{DetectError, Element, Network, Port, RuntimeReport, Tensor};
use rten::{NodeId, RunOptions, ThreadPool, Value, ValueOrView, ValueType};
use rten_tensor::{AsView, Layout, TensorView};
use std::borrow::Cow;
use std::sync::Arc;

/// The release of rten that is built in.
const VERSION: &str = "rten 0.27";

const NAME: &str = "the embedded runtime";

/// A network that the built-in runtime runs.
///
/// One network serves all threads; each run has a pool of threads to itself, so that runs neither wait for
/// each other nor share the caller's threads.
pub(super) struct Embedded {
    network: rten::Model,
    /// Without its bytes: the network has them.
    model: Model,
    inputs: Vec<NodeId>,
    outputs: Vec<NodeId>,
    threads: usize,
    pools: Idle<Arc<ThreadPool>>,
    fallback_reason: Option<String>,
}

impl Embedded {
    pub(super) fn open(
        mut model: Model,
        threads: usize,
        fallback_reason: Option<String>,
    ) -> Result<Self, DetectError> {
        let external = std::mem::take(&mut model.external);
        let bytes = std::mem::replace(&mut model.bytes, Cow::Borrowed(&[])).into_owned();
        let load = || {
            let mut options = rten::ModelOptions::with_all_ops();
            options.prepack_weights(true);
            for (location, bytes) in &external {
                options.external_data(location, bytes.to_vec());
            }
            options.load(bytes)
        };
        let refuse = |said: String| model.refused(NAME, "network", &said);
        let network = apart(load)
            .map_err(refuse)?
            .map_err(|error| refuse(error.to_string()))?;
        let nodes = |ports: &[Port]| {
            let node = |port: &Port| network.node_id(&port.name);
            let nodes: Result<Vec<_>, _> = ports.iter().map(node).collect();
            nodes.map_err(|error| refuse(error.to_string()))
        };
        Ok(Self {
            inputs: nodes(&model.inputs)?,
            outputs: nodes(&model.outputs)?,
            network,
            model,
            threads,
            pools: Idle::new(pool(threads)),
            fallback_reason,
        })
    }

    fn outputs_of(
        &self,
        pool: &Arc<ThreadPool>,
        inputs: &[&Tensor],
    ) -> Result<Vec<Tensor>, DetectError> {
        let refuse = |said: String| self.model.refused(NAME, "run", &said);
        let values = self
            .inputs
            .iter()
            .zip(inputs)
            .map(|(&node, tensor)| Ok((node, self.value(node, tensor)?)))
            .collect::<Result<Vec<_>, DetectError>>()?;
        let options = RunOptions::default().with_thread_pool(Some(Arc::clone(pool)));
        let values = apart(|| self.network.run(values, &self.outputs, Some(options)))
            .map_err(refuse)?
            .map_err(|error| refuse(error.to_string()))?;
        let ports = self.model.outputs.iter();
        ports
            .zip(values)
            .map(|(port, value)| read(&self.model.name, port, value))
            .collect()
    }

    /// An input's numbers as the network stores them: it knows fewer kinds than the model's file.
    fn value<'a>(&self, node: NodeId, tensor: &'a Tensor) -> Result<ValueOrView<'a>, DetectError> {
        let shape = tensor.shape.as_slice();
        let refuse = |said: String| {
            let place = format!("input `{}`", tensor.name);
            self.model.refused(NAME, &place, &said)
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
        &self.model.inputs
    }

    fn outputs(&self) -> &[Port] {
        &self.model.outputs
    }

    fn run(&self, inputs: &[Tensor]) -> Result<Vec<Tensor>, DetectError> {
        let inputs = matched(&self.model.name, &self.model.inputs, inputs)?;
        self.pools.with(
            || Ok(pool(self.threads)),
            |pool| self.outputs_of(pool, &inputs),
        )
    }

    fn report(&self) -> RuntimeReport {
        RuntimeReport {
            name: "embedded".to_owned(),
            version: VERSION.to_owned(),
            library: None,
            fallback_reason: self.fallback_reason.clone(),
        }
    }

    fn metadata(&self) -> &[(String, String)] {
        &self.model.metadata
    }
}

fn pool(threads: usize) -> Arc<ThreadPool> {
    Arc::new(ThreadPool::with_num_threads(threads))
}

fn read(model: &str, port: &Port, value: Value) -> Result<Tensor, DetectError> {
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
            let port = Port {
                element: Element::Other,
                ..port.clone()
            };
            return Err(unreadable(model, "output", &port, "a sequence"));
        }
    };
    Ok(Tensor {
        name: port.name.clone(),
        shape,
        data,
    })
}
