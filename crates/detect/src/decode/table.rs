use pomona_network::{Malformed, Port, Tensor};

/// An output seen as rows of numbers, whichever axis comes first in memory.
#[derive(Clone, Copy)]
pub(super) struct Table<'a> {
    data: &'a [f32],
    pub(super) rows: usize,
    pub(super) columns: usize,
    row_step: usize,
    column_step: usize,
}

impl<'a> Table<'a> {
    /// Of an output `[1, rows, columns]`, or one without its first axis.
    pub(super) fn new(tensor: &'a Tensor) -> Result<Self, Malformed> {
        check_length(tensor)?;
        match tensor.shape[..] {
            [1, rows, columns] | [rows, columns] => Ok(Self {
                data: &tensor.data,
                rows,
                columns,
                row_step: columns,
                column_step: 1,
            }),
            _ => Err(Malformed::new(
                place(tensor),
                format!(
                    "its shape is {:?}, not one image's rows of numbers",
                    tensor.shape
                ),
                "export the model for a batch of one, or state its `family`",
            )),
        }
    }

    /// Its columns taken for rows.
    pub(super) fn transposed(self) -> Self {
        Self {
            data: self.data,
            rows: self.columns,
            columns: self.rows,
            row_step: self.column_step,
            column_step: self.row_step,
        }
    }

    /// The number in a row and a column that exist.
    pub(super) fn get(&self, row: usize, column: usize) -> f32 {
        self.data[row * self.row_step + column * self.column_step]
    }

    /// The first four numbers of a row.
    pub(super) fn first_four(&self, row: usize) -> [f32; 4] {
        [0, 1, 2, 3].map(|column| self.get(row, column))
    }
}

/// The output that holds rows of boxes: the first with three axes.
pub(super) fn rows_output(outputs: &[Port]) -> Option<usize> {
    outputs.iter().position(|port| port.shape.len() == 3)
}

/// Where in the model an output is.
pub(super) fn place(tensor: &Tensor) -> String {
    format!("output `{}`", tensor.name)
}

/// Refuses a tensor that does not hold as many numbers as its shape says.
pub(super) fn check_length(tensor: &Tensor) -> Result<(), Malformed> {
    let length = tensor
        .shape
        .iter()
        .try_fold(1_usize, |product, &side| product.checked_mul(side));
    if length == Some(tensor.data.len()) {
        return Ok(());
    }
    Err(Malformed::new(
        place(tensor),
        format!("{} numbers for shape {:?}", tensor.data.len(), tensor.shape),
        "choose the other runtime",
    ))
}
