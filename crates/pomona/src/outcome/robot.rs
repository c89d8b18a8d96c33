use pomona_transforms::{
    CameraFrame, Direction, NamedTransform, Position, RobotFrame, ToolOrientation,
};

/// The transform that brings camera coordinates into the robot's frame.
pub type RobotFromCamera = NamedTransform<RobotFrame, CameraFrame>;

/// Where a tool goes in the robot's frame, and how it is turned when it approaches along its +x axis.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RobotTarget {
    /// Name of the robot's frame.
    pub frame_id: String,
    /// The apple's centre.
    pub center: Position<RobotFrame>,
    /// Direction of approach.
    pub direction: Direction<RobotFrame>,
    /// Orientation of the tool.
    pub tool: ToolOrientation,
}

impl RobotTarget {
    /// An apple's centre and a direction of approach, brought into the robot's frame.
    pub fn new(
        robot_from_camera: &RobotFromCamera,
        center: &Position<CameraFrame>,
        direction: &Direction<CameraFrame>,
    ) -> Self {
        let direction = robot_from_camera.transform.direction(direction);
        Self {
            frame_id: robot_from_camera.to.clone(),
            center: robot_from_camera.transform.position(center),
            direction,
            tool: ToolOrientation::along(&direction),
        }
    }
}
