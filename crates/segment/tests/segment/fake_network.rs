//! Networks without a model: their inputs and outputs are declared, and a closure answers.

use pomona_network::{Element, Network, NetworkError, Port, RuntimeReport, Tensor};

type Answer = dyn Fn(&Tensor) -> Vec<Tensor> + Send + Sync;

pub(crate) struct FakeNetwork {
    inputs: Vec<Port>,
    outputs: Vec<Port>,
    answer: Box<Answer>,
}

impl Network for FakeNetwork {
    fn inputs(&self) -> &[Port] {
        &self.inputs
    }

    fn outputs(&self) -> &[Port] {
        &self.outputs
    }

    fn run(&self, inputs: &[Tensor]) -> Result<Vec<Tensor>, NetworkError> {
        Ok((self.answer)(&inputs[0]))
    }

    fn report(&self) -> RuntimeReport {
        RuntimeReport::new("fake", "1")
    }
}

/// A port; 0 is an axis that is left open.
pub(crate) fn port(name: &str, shape: &[usize]) -> Port {
    let open = |side: &usize| (*side > 0).then_some(*side);
    Port {
        name: name.to_owned(),
        shape: shape.iter().map(open).collect(),
        element: Element::F32,
    }
}

pub(crate) fn tensor(shape: &[usize], data: Vec<f32>) -> Tensor {
    Tensor {
        name: "classes".to_owned(),
        shape: shape.to_vec(),
        data,
    }
}

/// A network for images of this width and height that declares an output of this shape.
pub(crate) fn network(
    input: [usize; 2],
    output: &[usize],
    answer: impl Fn(&Tensor) -> Vec<Tensor> + Send + Sync + 'static,
) -> FakeNetwork {
    FakeNetwork {
        inputs: vec![port("image", &[1, 3, input[1], input[0]])],
        outputs: vec![port("classes", output)],
        answer: Box::new(answer),
    }
}

/// Takes the red channel, 0 to 1, for the probability of wood; `shrink` pixels make one of its output.
pub(crate) fn redness(input: [usize; 2], shrink: usize) -> FakeNetwork {
    let [w, h] = input.map(|side| side / shrink);
    network(input, &[1, 2, h, w], move |image| {
        let mut wood = vec![0.0; w * h];
        for v in 0..input[1] {
            for u in 0..input[0] {
                let share = 1.0 / (shrink * shrink) as f32;
                wood[v / shrink * w + u / shrink] += share * image.data[v * input[0] + u];
            }
        }
        let rest = wood.iter().map(|p| 1.0 - p);
        let data = rest.chain(wood.iter().copied()).collect();
        vec![tensor(&[1, 2, h, w], data)]
    })
}
