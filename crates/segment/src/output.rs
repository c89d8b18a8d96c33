//! A network's output read as probabilities of the input's pixels.

use crate::description::Activation;
use pomona_network::{Malformed, Port, Tensor};

/// How far the sum of a pixel's numbers may be off 1 for them to be taken for probabilities: half precision keeps
/// three digits.
const PROBABILITY_TOLERANCE: f32 = 5e-3;

/// The channels of the output, as far as it declares them.
///
/// # Errors
///
/// The fault of a network that has no output of one map for each class.
pub(crate) fn channels(outputs: &[Port]) -> Result<Option<usize>, Malformed> {
    match outputs {
        [port] if matches!(port.shape[..], [None | Some(1), _, _, _]) => Ok(port.shape[1]),
        [port] => Err(Malformed::new(
            format!("output `{}`", port.name),
            format!("{} is not one map for each class", port.shape_text()),
            "export the model with one output [1, classes, height, width], before any arg-max",
        )),
        _ => {
            let names: Vec<&str> = outputs.iter().map(|port| port.name.as_str()).collect();
            Err(Malformed::new(
                "outputs",
                format!("there are {}, {names:?}", outputs.len()),
                "export the model with one output [1, classes, height, width]",
            ))
        }
    }
}

/// One map of numbers for each class, over the whole input.
#[derive(Clone, Debug)]
pub(crate) struct Maps<'a> {
    data: &'a [f32],
    pub(crate) channels: usize,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

impl<'a> Maps<'a> {
    /// The maps in a network's answer.
    ///
    /// # Errors
    ///
    /// The fault of an answer of another shape, or with a number that is not finite.
    pub(crate) fn of(outputs: &'a [Tensor]) -> Result<Self, Malformed> {
        let fault = |place: String, problem: String| {
            Err(Malformed::new(
                place,
                problem,
                "use a model whose output is [1, classes, height, width], finite numbers",
            ))
        };
        let [tensor] = outputs else {
            return fault("outputs".to_owned(), format!("there are {}", outputs.len()));
        };
        let place = || format!("output `{}`", tensor.name);
        let [1, channels, height, width] = tensor.shape[..] else {
            return fault(place(), format!("its shape is {:?}", tensor.shape));
        };
        let count = channels
            .checked_mul(height)
            .and_then(|n| n.checked_mul(width));
        if count != Some(tensor.data.len()) || count == Some(0) {
            let problem = format!(
                "{} numbers for the shape {:?}",
                tensor.data.len(),
                tensor.shape
            );
            return fault(place(), problem);
        }
        if let Some(k) = tensor.data.iter().position(|x| !x.is_finite()) {
            let (plane, pixel) = (k / (height * width), k % (height * width));
            let problem = format!(
                "{} in channel {plane} at ({}, {})",
                tensor.data[k],
                pixel % width,
                pixel / width
            );
            return fault(place(), problem);
        }
        Ok(Self {
            data: &tensor.data,
            channels,
            width,
            height,
        })
    }

    /// Whether the numbers are probabilities: from 0 to 1, and each pixel's add up to 1 where there are several.
    pub(crate) fn are_probabilities(&self) -> bool {
        let plane = self.width * self.height;
        let share = |x: &f32| (0.0..=1.0).contains(x);
        let whole = |k: usize| {
            let sum: f32 = (0..self.channels).map(|c| self.data[c * plane + k]).sum();
            (sum - 1.0).abs() <= PROBABILITY_TOLERANCE
        };
        self.data.iter().all(share) && (self.channels == 1 || (0..plane).all(whole))
    }

    /// The numbers of `channel` along a row of places: at each place of `columns`, bilinearly between the centres of
    /// the map's cells.
    pub(crate) fn row(&self, channel: usize, row: Place, columns: &[Place], numbers: &mut [f32]) {
        let line = |v: usize| &self.data[(channel * self.height + v) * self.width..][..self.width];
        let (upper, lower) = (line(row.cell), line(row.next));
        for (number, at) in numbers.iter_mut().zip(columns) {
            let above = upper[at.cell] + at.share * (upper[at.next] - upper[at.cell]);
            let below = lower[at.cell] + at.share * (lower[at.next] - lower[at.cell]);
            *number = above + row.share * (below - above);
        }
    }
}

/// A place along one side of a map: between the centres of two cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    cell: usize,
    next: usize,
    /// How far it is from the first towards the second.
    share: f32,
}

impl Place {
    /// The place at a share of the side of so many cells; beyond the outer centres it is there.
    pub(crate) fn new(share_of_side: f64, cells: usize) -> Self {
        let place = (share_of_side * cells as f64 - 0.5).clamp(0.0, (cells - 1) as f64);
        let cell = place.floor();
        Self {
            cell: cell as usize,
            next: (cell as usize + 1).min(cells - 1),
            share: (place - cell) as f32,
        }
    }
}

/// Turns the network's numbers into probabilities, in place: one row of numbers for each class, column by column. Of
/// one class against the rest, whose row of numbers is the second one, the first becomes the rest.
pub(crate) fn activate(activation: Activation, rows: &mut [Vec<f32>], is_one: bool) {
    let sigmoid = |x: f32| 1.0 / (1.0 + (-x).exp());
    if let ([rest, one], true) = (&mut *rows, is_one) {
        for (rest, x) in rest.iter_mut().zip(one) {
            *x = match activation {
                Activation::None => x.clamp(0.0, 1.0),
                _ => sigmoid(*x),
            };
            *rest = 1.0 - *x;
        }
        return;
    }
    // Row by row: the columns are independent, and neighbours in memory.
    let columns = rows.first().map_or(0, Vec::len);
    let mut most = vec![f32::NEG_INFINITY; columns];
    if activation == Activation::Softmax {
        for row in &*rows {
            for (most, x) in most.iter_mut().zip(row) {
                *most = most.max(*x);
            }
        }
    }
    let mut sums = vec![0.0; columns];
    for row in &mut *rows {
        for ((x, sum), most) in row.iter_mut().zip(&mut sums).zip(&most) {
            *x = match activation {
                Activation::Softmax => (*x - most).exp(),
                Activation::Sigmoid => sigmoid(*x),
                Activation::None => x.max(0.0),
            };
            *sum += *x;
        }
    }
    // Where nothing is likely, nothing is likelier than anything else.
    let even = 1.0 / rows.len() as f32;
    for row in rows {
        for (x, sum) in row.iter_mut().zip(&sums) {
            *x = if *sum > 0.0 { *x / sum } else { even };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn tensor(shape: &[usize], data: Vec<f32>) -> Vec<Tensor> {
        vec![Tensor {
            name: "classes".to_owned(),
            shape: shape.to_vec(),
            data,
        }]
    }

    proptest! {
        #[test]
        fn probabilities_add_up_to_one(
            numbers in proptest::collection::vec(-1e4_f32..1e4, 1..7),
            activation in prop_oneof![Just(Activation::Softmax), Just(Activation::Sigmoid), Just(Activation::None)],
        ) {
            let is_one = numbers.len() == 1;
            let mut rows: Vec<Vec<f32>> = numbers.iter().map(|x| vec![*x]).collect();
            if is_one {
                rows.insert(0, vec![0.0]);
            }
            activate(activation, &mut rows, is_one);
            let probabilities: Vec<f32> = rows.concat();
            let sum: f32 = probabilities.iter().sum();
            prop_assert!((sum - 1.0).abs() < 1e-5, "{probabilities:?}");
            prop_assert!(probabilities.iter().all(|p| (0.0..=1.0).contains(p)));
        }
    }

    #[test]
    fn between_the_cells_of_a_coarse_map_lie_straight_lines() {
        let outputs = tensor(&[1, 1, 1, 2], vec![0.0, 4.0]);
        let maps = Maps::of(&outputs).unwrap();
        let columns = [0.0, 0.25, 0.5, 0.75, 1.0].map(|x| Place::new(x, 2));
        let mut numbers = [0.0; 5];
        maps.row(0, Place::new(0.5, 1), &columns, &mut numbers);
        assert_eq!(numbers, [0.0, 0.0, 2.0, 4.0, 4.0]);
    }

    #[test]
    fn what_is_no_map_of_classes_is_named() {
        let message = |outputs: &[Tensor]| {
            let fault = Maps::of(outputs).unwrap_err();
            format!("{}: {}", fault.place, fault.problem)
        };
        assert!(message(&[]).contains("there are 0"));
        assert!(message(&tensor(&[1, 2, 2], vec![0.0; 4])).contains("[1, 2, 2]"));
        assert!(message(&tensor(&[1, 2, 1, 2], vec![0.0; 3])).contains("3 numbers"));
        assert!(message(&tensor(&[1, 0, 1, 2], vec![])).contains("0 numbers"));
        let nan = message(&tensor(&[1, 2, 1, 2], vec![0.0, 0.0, 0.0, f32::NAN]));
        assert!(nan.contains("NaN in channel 1 at (1, 0)"), "{nan}");
    }

    #[test]
    fn probabilities_are_told_from_logits() {
        let are = |channels, data: &[f32]| {
            let outputs = tensor(&[1, channels, 1, 2], data.to_vec());
            Maps::of(&outputs).unwrap().are_probabilities()
        };
        assert!(are(2, &[0.25, 1.0, 0.75, 0.0]));
        assert!(!are(2, &[0.25, 1.0, 0.25, 0.0]));
        assert!(!are(2, &[2.0, 1.0, -1.0, 0.0]));
        assert!(are(1, &[0.25, 1.0]));
        assert!(!are(1, &[-0.25, 1.0]));
    }
}
