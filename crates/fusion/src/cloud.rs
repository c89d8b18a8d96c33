//! The points of all frames in one cloud.

use nalgebra::{Isometry3, Point3};
use pomona::RobotFromCamera;
use pomona_cloud::{CloudError, Frame, PixelWindow, PointCloud};

/// One point before it is added to its cell.
struct ColoredPoint {
    cell: [i64; 3],
    position: Point3<f64>,
    color: [u8; 3],
}

/// Points of several frames in the robot's frame, one for each cell of a grid.
#[derive(Debug)]
pub struct FusedCloud {
    voxel_m: f64,
    cells: Vec<Cell>,
}

/// Sums over the points of one cell.
#[derive(Clone, Debug)]
struct Cell {
    key: [i64; 3],
    count: u32,
    sum: [f64; 3],
    color: [u64; 3],
}

impl FusedCloud {
    /// An empty cloud of cells of edge `voxel_m`, metres, which must be positive; else it stays empty.
    pub fn new(voxel_m: f64) -> Self {
        Self {
            voxel_m,
            cells: Vec::new(),
        }
    }

    /// Adds the points of a frame, brought into the robot's frame by its pose and then `correction`
    /// (see [`FusedFrame::correction`](crate::FusedFrame::correction)).
    ///
    /// # Errors
    ///
    /// As [`Frame::window`].
    pub fn add(
        &mut self,
        frame: &Frame,
        robot_from_camera: &RobotFromCamera,
        correction: &Isometry3<f64>,
    ) -> Result<(), CloudError> {
        if !(self.voxel_m > 0.0) {
            return Ok(());
        }
        let pose = correction * robot_from_camera.transform.isometry();
        let window = PixelWindow::full(frame.depth.width, frame.depth.height);
        let points = frame.window(window)?;
        let mut colored: Vec<ColoredPoint> = (0..points.len())
            .map(|i| {
                let position = pose * points.point(i);
                let pixel = points.pixel[i] as usize;
                ColoredPoint {
                    cell: [0, 1, 2].map(|axis| (position[axis] / self.voxel_m).floor() as i64),
                    position,
                    color: frame.color.pixels.get(pixel).copied().unwrap_or_default(),
                }
            })
            .collect();
        // Stable: the sums of a cell are taken in the order of the pixels.
        colored.sort_by_key(|p| p.cell);
        let mut added: Vec<Cell> = Vec::new();
        for point in &colored {
            match added.last_mut() {
                Some(last) if last.key == point.cell => last.add(point),
                _ => added.push(Cell::of(point)),
            }
        }
        self.cells = merged(std::mem::take(&mut self.cells), added);
        Ok(())
    }

    /// The cloud: the mean point and colour of each cell, in the order of the cells.
    pub fn cloud(&self) -> PointCloud {
        let mut cloud = PointCloud::new();
        for cell in &self.cells {
            let n = f64::from(cell.count.max(1));
            let [x, y, z] = cell.sum.map(|s| s / n);
            let color = cell.color.map(|c| (c as f64 / n).round() as u8);
            cloud.push(Point3::new(x, y, z), Some(color));
        }
        cloud
    }
}

impl Cell {
    fn of(point: &ColoredPoint) -> Self {
        let mut cell = Self {
            key: point.cell,
            count: 0,
            sum: [0.0; 3],
            color: [0; 3],
        };
        cell.add(point);
        cell
    }

    fn add(&mut self, point: &ColoredPoint) {
        self.count = self.count.saturating_add(1);
        for axis in 0..3 {
            self.sum[axis] += point.position[axis];
            self.color[axis] += u64::from(point.color[axis]);
        }
    }

    fn join(&mut self, other: &Self) {
        self.count = self.count.saturating_add(other.count);
        for axis in 0..3 {
            self.sum[axis] += other.sum[axis];
            self.color[axis] += other.color[axis];
        }
    }
}

/// Both lists ascend by their cells.
fn merged(old: Vec<Cell>, added: Vec<Cell>) -> Vec<Cell> {
    let mut all = Vec::with_capacity(old.len() + added.len());
    let mut added = added.into_iter().peekable();
    for mut cell in old {
        while let Some(next) = added.next_if(|c| c.key < cell.key) {
            all.push(next);
        }
        if let Some(same) = added.next_if(|c| c.key == cell.key) {
            cell.join(&same);
        }
        all.push(cell);
    }
    all.extend(added);
    all
}
