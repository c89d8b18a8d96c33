use super::idle::Idle;
use super::inputs::{in_port_order, to_u8};
use super::library::Library;
use crate::{
    error::NetworkError,
    network::{Network, RuntimeReport},
    onnx_file::{OnnxFile, unconvertible},
    tensor::{Element, Port, Tensor},
};
use half::f16;
use ort::session::builder::GraphOptimizationLevel;
use ort::session::{Session, SessionInputValue};
use ort::value::{DynValue, Shape, TensorElementType, TensorRef, ValueType};

/// A network that ONNX Runtime runs.
///
/// Its sessions do not serve two threads at once, so there are as many as ever ran at once, all made from
/// the same bytes.
pub(super) struct OnnxRuntime {
    file: OnnxFile,
    library: Library,
    threads: usize,
    sessions: Idle<Session>,
}

impl OnnxRuntime {
    pub(super) fn open(
        file: OnnxFile,
        library: Library,
        threads: usize,
    ) -> Result<Self, NetworkError> {
        let first = session(&file, &library, threads)?;
        Ok(Self {
            file,
            library,
            threads,
            sessions: Idle::new(first),
        })
    }

    fn outputs_of(
        &self,
        session: &mut Session,
        inputs: &[&Tensor],
    ) -> Result<Vec<Tensor>, NetworkError> {
        let refuse =
            |error: ort::Error| self.file.refused("ONNX Runtime", "run", &error.to_string());
        let converted: Vec<Converted> = self
            .file
            .inputs
            .iter()
            .zip(inputs)
            .map(|(port, tensor)| Converted::of(&self.file.name, port, tensor))
            .collect::<Result<_, _>>()?;
        let values = converted
            .iter()
            .zip(inputs)
            .map(|(numbers, tensor)| Ok((tensor.name.as_str(), numbers.value(&tensor.shape)?)))
            .collect::<Result<Vec<_>, ort::Error>>()
            .map_err(refuse)?;
        let values = session.run(values).map_err(refuse)?;
        let read = |port: &Port| {
            let place = || format!("output `{}`", port.name);
            let value = values
                .get(&port.name)
                .ok_or_else(|| self.file.refused("ONNX Runtime", &place(), "was not given"))?;
            read(&self.file.name, port, value)
        };
        self.file.outputs.iter().map(read).collect()
    }
}

impl Network for OnnxRuntime {
    fn inputs(&self) -> &[Port] {
        &self.file.inputs
    }

    fn outputs(&self) -> &[Port] {
        &self.file.outputs
    }

    fn run(&self, inputs: &[Tensor]) -> Result<Vec<Tensor>, NetworkError> {
        let inputs = in_port_order(&self.file.name, &self.file.inputs, inputs)?;
        self.sessions.with(
            || session(&self.file, &self.library, self.threads),
            |session| self.outputs_of(session, &inputs),
        )
    }

    fn report(&self) -> RuntimeReport {
        RuntimeReport {
            library: Some(self.library.path.display().to_string()),
            ..RuntimeReport::new("onnxruntime", &*self.library.version)
        }
    }

    fn metadata(&self) -> &[(String, String)] {
        &self.file.metadata
    }
}

fn session(file: &OnnxFile, library: &Library, threads: usize) -> Result<Session, NetworkError> {
    let build = || {
        let mut builder = Session::builder(&library.environment)?
            .with_intra_threads(threads)?
            .with_inter_threads(1)?
            .with_optimization_level(GraphOptimizationLevel::All)?;
        for (location, bytes) in &file.external {
            builder = builder.with_external_initializer_file_in_memory(location, bytes.clone())?;
        }
        builder.commit_from_memory(&file.bytes)
    };
    build().map_err(|error: ort::Error| file.refused("ONNX Runtime", "network", &error.to_string()))
}

/// An input's numbers as the model stores them.
enum Converted<'a> {
    F32(&'a [f32]),
    F16(Vec<f16>),
    U8(Vec<u8>),
    I32(Vec<i32>),
    I64(Vec<i64>),
}

impl<'a> Converted<'a> {
    fn of(model: &str, port: &Port, tensor: &'a Tensor) -> Result<Self, NetworkError> {
        let data = &tensor.data;
        Ok(match port.element {
            Element::F32 => Self::F32(data),
            Element::F16 => Self::F16(data.iter().map(|&value| f16::from_f32(value)).collect()),
            Element::U8 => Self::U8(data.iter().map(|&value| to_u8(value)).collect()),
            Element::I32 => Self::I32(data.iter().map(|&value| value.round() as i32).collect()),
            Element::I64 => Self::I64(data.iter().map(|&value| value.round() as i64).collect()),
            Element::Other => {
                return Err(NetworkError::model(
                    model,
                    unconvertible("input", port, "another kind of number"),
                ));
            }
        })
    }

    fn value<'b>(&'b self, shape: &'b [usize]) -> Result<SessionInputValue<'b>, ort::Error> {
        Ok(match self {
            Self::F32(data) => TensorRef::from_array_view((shape, *data))?.into(),
            Self::F16(data) => TensorRef::from_array_view((shape, data.as_slice()))?.into(),
            Self::U8(data) => TensorRef::from_array_view((shape, data.as_slice()))?.into(),
            Self::I32(data) => TensorRef::from_array_view((shape, data.as_slice()))?.into(),
            Self::I64(data) => TensorRef::from_array_view((shape, data.as_slice()))?.into(),
        })
    }
}

fn read(model: &str, port: &Port, value: &DynValue) -> Result<Tensor, NetworkError> {
    let element = match value.dtype() {
        ValueType::Tensor { ty, .. } => *ty,
        other => {
            return Err(NetworkError::model(
                model,
                unconvertible("output", port, &other.to_string()),
            ));
        }
    };
    let extracted = match element {
        TensorElementType::Float32 => numbers(value, |&number: &f32| number),
        TensorElementType::Float16 => numbers(value, |&number: &f16| f32::from(number)),
        TensorElementType::Float64 => numbers(value, |&number: &f64| number as f32),
        TensorElementType::Int64 => numbers(value, |&number: &i64| number as f32),
        TensorElementType::Int32 => numbers(value, |&number: &i32| number as f32),
        TensorElementType::Int8 => numbers(value, |&number: &i8| f32::from(number)),
        TensorElementType::Uint8 => numbers(value, |&number: &u8| f32::from(number)),
        TensorElementType::Bool => numbers(value, |&number: &bool| f32::from(u8::from(number))),
        other => {
            return Err(NetworkError::model(
                model,
                unconvertible("output", port, &other.to_string()),
            ));
        }
    };
    let (shape, data) = extracted.map_err(|error| {
        NetworkError::model(model, unconvertible("output", port, &error.to_string()))
    })?;
    Ok(Tensor {
        name: port.name.clone(),
        shape,
        data,
    })
}

fn numbers<T: ort::value::PrimitiveTensorElementType>(
    value: &DynValue,
    convert: impl Fn(&T) -> f32,
) -> Result<(Vec<usize>, Vec<f32>), ort::Error> {
    let (shape, data): (&Shape, &[T]) = value.try_extract_tensor()?;
    let shape = shape
        .iter()
        .map(|&axis| usize::try_from(axis).unwrap_or(0))
        .collect();
    Ok((shape, data.iter().map(convert).collect()))
}
