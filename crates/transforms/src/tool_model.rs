use crate::{
    Direction, EulerZyx, FlangeFrame, Position, RobotFrame, SINGULAR_ANGLE_RAD, ToolFrame,
    ToolOrientation, Transform, TransformError, UncertainDirection, quaternion,
};
use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Standard deviation of an unknown angle: that of the uniform distribution over a turn, rad.
pub const UNKNOWN_ANGLE_SIGMA_RAD: f64 = PI / 1.732_050_807_568_877_2;

/// Beyond this standard deviation, in radians, an azimuth is taken as undetermined: 30°.
const UNDETERMINED_RAD: f64 = PI / 6.0;

/// A tool on a flange: which of its axes leads in the approach, and where it is mounted.
///
/// ```
/// use nalgebra::{Point3, Vector3};
/// use pomona_transforms::{Direction, Position, ToolModel, ToolOrientation, Transform};
///
/// // A gripper whose fingers reach 0.18 m along the flange's z, which approaches along that z.
/// let tcp_from_flange = Transform::from_quaternion([0.0, 0.0, -0.18], [0.0, 0.0, 0.0, 1.0])?;
/// let tool = ToolModel::new(tcp_from_flange, Direction::new(Vector3::z()).unwrap());
///
/// let apple = Position::new(Point3::new(0.7, 0.1, 0.9));
/// let towards = Direction::new(Vector3::new(0.0, 1.0, 1.0)).unwrap();
/// let robot_from_flange = tool.flange_pose(&apple, &ToolOrientation::along(&towards))?;
/// let fingers = robot_from_flange.position(&Position::new(Point3::new(0.0, 0.0, 0.18)));
/// assert!(fingers.distance(&apple) < 1e-12);
/// # Ok::<(), pomona_transforms::TransformError>(())
/// ```
///
/// Where the flange is in the tool's frame is not where the tool is in the flange's:
///
/// ```compile_fail,E0308
/// use pomona_transforms::{Direction, FlangeFrame, ToolFrame, ToolModel, Transform};
///
/// fn mount(flange_from_tcp: Transform<FlangeFrame, ToolFrame>, axis: Direction<ToolFrame>) {
///     ToolModel::new(flange_from_tcp, axis);
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolModel {
    tcp_from_flange: Transform<ToolFrame, FlangeFrame>,
    tool_axis: Direction<ToolFrame>,
}

impl Default for ToolModel {
    /// The paper's: the tool is the flange, and approaches along its +x (Gao et al. 2022, section 2.3).
    fn default() -> Self {
        Self {
            tcp_from_flange: Transform::at(Isometry3::identity()),
            tool_axis: Direction::from_unit(Vector3::x_axis()),
        }
    }
}

impl ToolModel {
    /// A tool whose frame, with its origin at the tool centre point, is `tcp_from_flange`, and which approaches along
    /// `tool_axis`.
    pub fn new(
        tcp_from_flange: Transform<ToolFrame, FlangeFrame>,
        tool_axis: Direction<ToolFrame>,
    ) -> Self {
        Self {
            tcp_from_flange,
            tool_axis,
        }
    }

    /// The flange's frame in that of the tool.
    pub fn tcp_from_flange(&self) -> Transform<ToolFrame, FlangeFrame> {
        self.tcp_from_flange
    }

    /// The axis of the tool that leads in the approach; the paper's is +x.
    pub fn tool_axis(&self) -> Direction<ToolFrame> {
        self.tool_axis
    }

    /// The tool's pose with its centre point at `tcp` and its axis along the direction of `orientation`.
    ///
    /// An axis other than +x is first turned onto +x the shortest way; −x by half a turn about z.
    ///
    /// # Errors
    ///
    /// [`TransformError::NotFinite`] where `tcp` is not.
    pub fn tool_pose(
        &self,
        tcp: &Position<RobotFrame>,
        orientation: &ToolOrientation,
    ) -> Result<Transform<RobotFrame, ToolFrame>, TransformError> {
        Transform::from_isometry(&Isometry3::from_parts(
            Translation3::from(tcp.point().coords),
            orientation.quaternion * self.onto_x(),
        ))
    }

    /// The turn that brings the tool's axis onto +x.
    fn onto_x(&self) -> UnitQuaternion<f64> {
        shortest(&self.tool_axis.vector(), &Vector3::x(), &Vector3::z_axis())
    }

    /// The flange's pose where the tool's centre point is at the origin of `approach` and its axis along +x of it; both
    /// in the robot's frame. The turn about the axis is that of `approach`: for a tool axis in the plane of x and z its
    /// y stays y.
    pub fn flange_at(&self, approach: &Isometry3<f64>) -> Isometry3<f64> {
        approach * self.onto_x() * self.tcp_from_flange.isometry()
    }

    /// The flange's pose for the same: what the robot is told.
    ///
    /// # Errors
    ///
    /// [`TransformError::NotFinite`] where `tcp` is not.
    pub fn flange_pose(
        &self,
        tcp: &Position<RobotFrame>,
        orientation: &ToolOrientation,
    ) -> Result<Transform<RobotFrame, FlangeFrame>, TransformError> {
        Ok(self.tool_pose(tcp, orientation)? * self.tcp_from_flange)
    }
}

/// The shortest rotation of one unit vector onto another; half a turn about `across` where they are opposite.
fn shortest(
    from: &Vector3<f64>,
    to: &Vector3<f64>,
    across: &Unit<Vector3<f64>>,
) -> UnitQuaternion<f64> {
    let axis = from.cross(to);
    match Unit::try_new(axis, 1e-12) {
        Some(unit) => UnitQuaternion::from_axis_angle(&unit, axis.norm().atan2(from.dot(to))),
        None if from.dot(to) > 0.0 => UnitQuaternion::identity(),
        None => UnitQuaternion::from_axis_angle(across, PI),
    }
}

/// The orientation of a tool along a direction that is not known exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct UncertainToolOrientation {
    /// The orientation. [`singular`](ToolOrientation::singular) says that the reference azimuth was used.
    pub orientation: ToolOrientation,
    /// Standard deviation of rz, rad, due to the direction's: it grows as 1/sin of the angle to ±z, and is at most
    /// [`UNKNOWN_ANGLE_SIGMA_RAD`], of an unknown angle.
    pub rz_sigma_rad: f64,
    /// Standard deviation of ry, rad.
    pub ry_sigma_rad: f64,
}

impl ToolOrientation {
    /// The orientation along an uncertain direction: Eq. 11's where its azimuth is known.
    ///
    /// Along ±z within 1e-6 rad, and where the direction's own error leaves the azimuth rz open by more than 30°
    /// (standard deviation), the wrist takes `reference_azimuth_rad`, for example the rz of the pose before,
    /// and the tool is tilted from there onto the direction the shortest way: the tool still points along the
    /// direction, and its turn about it does not follow the noise. The angles are then those of this
    /// rotation, rx among them.
    ///
    /// `None` where `reference_azimuth_rad` is not finite.
    pub fn along_uncertain(
        direction: &UncertainDirection<RobotFrame>,
        reference_azimuth_rad: f64,
    ) -> Option<UncertainToolOrientation> {
        let d = direction.direction.vector();
        let (horizontal, covariance) = (d.x.hypot(d.y), &direction.covariance_rad2);
        let sigma = |g: Vector3<f64>| (g.dot(&(covariance * g))).max(0.0).sqrt();
        // d rz = (−y dx + x dy)/h², and d ry = −dz/h for a unit vector, whose h dh = −z dz.
        let (rz, ry) = if horizontal > SINGULAR_ANGLE_RAD {
            let across = Vector3::new(-d.y, d.x, 0.0) / horizontal;
            let along = Vector3::new(d.x * d.z, d.y * d.z, -horizontal * horizontal) / horizontal;
            (sigma(across) / horizontal, sigma(along))
        } else {
            (
                UNKNOWN_ANGLE_SIGMA_RAD,
                sigma(Vector3::x()).max(sigma(Vector3::y())),
            )
        };
        let pole = Self::along_with_azimuth(&direction.direction, reference_azimuth_rad)?;
        let orientation = if pole.singular || rz <= UNDETERMINED_RAD {
            pole
        } else {
            Self::tilted_from_pole(&d, reference_azimuth_rad)
        };
        Some(UncertainToolOrientation {
            orientation,
            rz_sigma_rad: rz.min(UNKNOWN_ANGLE_SIGMA_RAD),
            ry_sigma_rad: ry,
        })
    }

    /// At ±z with this azimuth, and from there onto `d` the shortest way.
    fn tilted_from_pole(d: &Vector3<f64>, azimuth_rad: f64) -> Self {
        let up = d.z > 0.0;
        let pole = EulerZyx {
            rx: 0.0,
            ry: if up { -FRAC_PI_2 } else { FRAC_PI_2 },
            rz: azimuth_rad,
        };
        let z = if up { Vector3::z() } else { -Vector3::z() };
        let turned = shortest(&z, d, &Vector3::x_axis()) * pole.rotation();
        Self {
            quaternion: quaternion::canonical(&turned),
            euler: EulerZyx::from_rotation(&turned),
            singular: true,
        }
    }
}
