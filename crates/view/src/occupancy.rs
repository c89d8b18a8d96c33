use crate::canvas::Point;

/// Pixels to a cell's side.
const CELL: f32 = 4.0;

/// How much of what is drawn a label would hide, for any rectangle at once: a
/// summed-area table over square cells (Crow 1984, doi 10.1145/800031.808600).
pub(crate) struct Occupancy {
    columns: usize,
    rows: usize,
    /// Before [`Occupancy::integrated`] a cell's weight, afterwards the sum above and left of it; one row and one
    /// column more than cells.
    sums: Vec<f64>,
}

impl Occupancy {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        let cells = |pixels: usize| pixels.div_ceil(CELL as usize);
        let (columns, rows) = (cells(width), cells(height));
        Self {
            columns,
            rows,
            sums: vec![0.0; (columns + 1) * (rows + 1)],
        }
    }

    /// Marks a rectangle as occupied with this weight (left, top, right, bottom).
    pub(crate) fn add_rectangle(&mut self, rectangle: [f32; 4], weight: f64) {
        let [left, top, right, bottom] = self.cells(rectangle);
        for row in top..bottom {
            for column in left..right {
                let at = self.index(column + 1, row + 1);
                self.sums[at] = self.sums[at].max(weight);
            }
        }
    }

    /// Marks a straight line as occupied with this weight.
    pub(crate) fn add_line(&mut self, from: Point, to: Point, weight: f64) {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let steps = (dx.hypot(dy) / CELL).ceil().clamp(1.0, 1e4) as u16;
        for step in 0..=steps {
            let t = f32::from(step) / f32::from(steps);
            let (x, y) = (from.x + t * dx, from.y + t * dy);
            self.add_rectangle([x - 1.0, y - 1.0, x + 1.0, y + 1.0], weight);
        }
    }

    /// Turns the cells into sums; nothing is added afterwards.
    pub(crate) fn integrated(mut self) -> Self {
        for row in 1..=self.rows {
            for column in 1..=self.columns {
                let at = self.index(column, row);
                let above = self.sums[self.index(column, row - 1)];
                let left = self.sums[self.index(column - 1, row)];
                let both = self.sums[self.index(column - 1, row - 1)];
                self.sums[at] += above + left - both;
            }
        }
        self
    }

    /// Mean weight in a rectangle, after [`Occupancy::integrated`].
    pub(crate) fn mean(&self, rectangle: [f32; 4]) -> f64 {
        let [left, top, right, bottom] = self.cells(rectangle);
        let area = right.saturating_sub(left) * bottom.saturating_sub(top);
        if area == 0 {
            return 0.0;
        }
        let at = |column, row| self.sums[self.index(column, row)];
        (at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top)) / area as f64
    }

    fn index(&self, column: usize, row: usize) -> usize {
        row * (self.columns + 1) + column
    }

    /// The half-open range of cells that a rectangle touches. A float turned
    /// into a count saturates, so nothing leaves the table.
    fn cells(&self, [left, top, right, bottom]: [f32; 4]) -> [usize; 4] {
        let first = |edge: f32, count: usize| ((edge / CELL).floor() as usize).min(count);
        let last = |edge: f32, count: usize| ((edge / CELL).ceil() as usize).min(count);
        [
            first(left, self.columns),
            first(top, self.rows),
            last(right, self.columns),
            last(bottom, self.rows),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_counts_what_was_added() {
        let mut occupancy = Occupancy::new(40, 20);
        occupancy.add_rectangle([0.0, 0.0, 20.0, 20.0], 1.0);
        occupancy.add_rectangle([8.0, 8.0, 12.0, 12.0], 0.5);
        occupancy.add_line(
            Point::from_xy(f32::NAN, 0.0),
            Point::from_xy(1e30, -4.0),
            0.0,
        );
        let occupancy = occupancy.integrated();
        assert_eq!(occupancy.mean([0.0, 0.0, 40.0, 20.0]), 0.5);
        assert_eq!(occupancy.mean([16.0, 4.0, 24.0, 8.0]), 0.5);
        assert_eq!(occupancy.mean([-100.0, -100.0, 1e9, 1e9]), 0.5);
        assert_eq!(occupancy.mean([60.0, 4.0, 80.0, 8.0]), 0.0);
    }
}
