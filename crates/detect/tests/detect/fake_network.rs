//! Networks without a model: their inputs and outputs are declared, and a closure answers.

use pomona_network::{Element, Network, NetworkError, Port, RuntimeReport, Tensor};

type Answer = dyn Fn(&[Tensor]) -> Vec<Tensor> + Send + Sync;

pub(crate) struct FakeNetwork {
    pub(crate) inputs: Vec<Port>,
    pub(crate) outputs: Vec<Port>,
    pub(crate) metadata: Vec<(String, String)>,
    pub(crate) answer: Box<Answer>,
}

impl Network for FakeNetwork {
    fn inputs(&self) -> &[Port] {
        &self.inputs
    }

    fn outputs(&self) -> &[Port] {
        &self.outputs
    }

    fn run(&self, inputs: &[Tensor]) -> Result<Vec<Tensor>, NetworkError> {
        Ok((self.answer)(inputs))
    }

    fn metadata(&self) -> &[(String, String)] {
        &self.metadata
    }

    fn report(&self) -> RuntimeReport {
        RuntimeReport::new("fake", "1")
    }
}

/// A port; 0 is an axis that is left open.
pub(crate) fn port(name: &str, shape: &[usize]) -> Port {
    Port {
        name: name.to_owned(),
        shape: shape
            .iter()
            .map(|&side| (side > 0).then_some(side))
            .collect(),
        element: Element::F32,
    }
}

/// A network for images of this width and height that always answers the same.
pub(crate) fn fixed(input: [usize; 2], tensors: Vec<Tensor>) -> FakeNetwork {
    FakeNetwork {
        inputs: vec![port("images", &[1, 3, input[1], input[0]])],
        outputs: tensors.iter().map(|t| port(&t.name, &t.shape)).collect(),
        metadata: Vec::new(),
        answer: Box::new(move |_| tensors.clone()),
    }
}
