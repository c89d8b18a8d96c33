use crate::{Direction, FrameTag};
use nalgebra::Point3;
use std::fmt;
use std::marker::PhantomData;

/// A place in the frame `F`, in metres.
///
/// Positions of two frames do not mix:
///
/// ```
/// use nalgebra::Point3;
/// use pomona_transforms::{CameraFrame, Position};
///
/// let apple = Position::<CameraFrame>::new(Point3::new(0.0, 0.0, 1.0));
/// let branch = Position::<CameraFrame>::new(Point3::new(0.0, -0.1, 1.0));
/// assert_eq!(apple.distance(&branch), 0.1);
/// ```
///
/// ```compile_fail,E0308
/// use nalgebra::Point3;
/// use pomona_transforms::{CameraFrame, Position, RobotFrame};
///
/// let apple = Position::<CameraFrame>::new(Point3::new(0.0, 0.0, 1.0));
/// let branch = Position::<RobotFrame>::new(Point3::new(0.0, -0.1, 1.0));
/// apple.distance(&branch);
/// ```
pub struct Position<F: FrameTag> {
    point: Point3<f64>,
    frame: PhantomData<fn() -> F>,
}

impl<F: FrameTag> Position<F> {
    /// The place with these coordinates in `F`. They are taken as they are: what is not finite
    /// stays so.
    pub fn new(point: Point3<f64>) -> Self {
        Self {
            point,
            frame: PhantomData,
        }
    }

    /// Its coordinates, in metres.
    pub fn point(&self) -> Point3<f64> {
        self.point
    }

    /// Distance to another place, in metres.
    pub fn distance(&self, other: &Self) -> f64 {
        nalgebra::distance(&self.point, &other.point)
    }

    /// The direction in which `other` lies, or `None` where both coincide or are not finite.
    pub fn direction_to(&self, other: &Self) -> Option<Direction<F>> {
        Direction::new(other.point - self.point)
    }

    /// The place `distance_m` metres further along `direction`; a negative distance goes back.
    #[must_use]
    pub fn moved(&self, direction: &Direction<F>, distance_m: f64) -> Self {
        Self::new(self.point + direction.vector() * distance_m)
    }
}

// By hand: derived, these would ask the tag for what it has no use for.
impl<F: FrameTag> Clone for Position<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: FrameTag> Copy for Position<F> {}

impl<F: FrameTag> PartialEq for Position<F> {
    fn eq(&self, other: &Self) -> bool {
        self.point == other.point
    }
}

impl<F: FrameTag> fmt::Debug for Position<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z]: [f64; 3] = self.point.into();
        write!(f, "Position<{}>({x:?}, {y:?}, {z:?})", F::NAME)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RobotFrame;

    #[test]
    fn moving_along_the_direction_arrives() {
        let start = Position::<RobotFrame>::new(Point3::new(1.0, 2.0, 3.0));
        let end = Position::new(Point3::new(1.0, 5.0, 7.0));
        let direction = start.direction_to(&end).unwrap();
        assert!(start.moved(&direction, 5.0).distance(&end) < 1e-15);
        assert!(end.moved(&direction, -5.0).distance(&start) < 1e-15);
        assert!(start.direction_to(&start).is_none());
    }

    #[test]
    fn is_shown_with_its_frame() {
        let position = Position::<RobotFrame>::new(Point3::new(1.0, -0.5, 0.0));
        assert_eq!(format!("{position:?}"), "Position<robot>(1.0, -0.5, 0.0)");
    }
}
