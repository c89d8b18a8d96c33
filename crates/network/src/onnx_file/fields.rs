//! Numbers of the fields of ONNX's messages, by message and field (`onnx.proto3`, ONNX 1.17).

pub(crate) const MODEL_IR_VERSION: u64 = 1;
pub(crate) const MODEL_GRAPH: u64 = 7;
pub(crate) const MODEL_OPSET_IMPORT: u64 = 8;
pub(crate) const MODEL_METADATA_PROPS: u64 = 14;

pub(crate) const OPSET_DOMAIN: u64 = 1;
pub(crate) const OPSET_VERSION: u64 = 2;

pub(crate) const GRAPH_INITIALIZER: u64 = 5;
pub(crate) const GRAPH_INPUT: u64 = 11;
pub(crate) const GRAPH_OUTPUT: u64 = 12;

pub(crate) const TENSOR_DIMS: u64 = 1;
pub(crate) const TENSOR_DATA_TYPE: u64 = 2;
pub(crate) const TENSOR_NAME: u64 = 8;
pub(crate) const TENSOR_RAW_DATA: u64 = 9;
pub(crate) const TENSOR_EXTERNAL_DATA: u64 = 13;

pub(crate) const ENTRY_KEY: u64 = 1;
pub(crate) const ENTRY_VALUE: u64 = 2;

pub(crate) const VALUE_NAME: u64 = 1;
pub(crate) const VALUE_TYPE: u64 = 2;
pub(crate) const TYPE_TENSOR: u64 = 1;
pub(crate) const TENSOR_TYPE_ELEMENT: u64 = 1;
pub(crate) const TENSOR_TYPE_SHAPE: u64 = 2;
pub(crate) const SHAPE_DIMENSION: u64 = 1;
pub(crate) const DIMENSION_LENGTH: u64 = 1;
