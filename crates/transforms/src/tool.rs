use crate::{Direction, EulerZyx, RobotFrame, quaternion};
use nalgebra::UnitQuaternion;
use std::f64::consts::FRAC_PI_2;

/// Within this angle of ±z, in radians, a direction is singular: it is taken for ±z itself, so
/// that the tool is off it by this angle at most.
pub const SINGULAR_ANGLE_RAD: f64 = 1e-6;

/// The orientation of a tool that approaches along a direction of the robot's frame.
///
/// The tool's approach axis is its +x, and at zero angles the tool's axes are those of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolOrientation {
    /// The rotation that turns +x onto the direction. Of its two quaternions it is the one with
    /// w ≥ 0; for a half turn, with w = 0, the first component that is not 0 is positive.
    pub quaternion: UnitQuaternion<f64>,
    /// The same as angles, with rx = 0.
    pub euler: EulerZyx,
    /// Whether the direction lies along ±z within [`SINGULAR_ANGLE_RAD`]. There every turn
    /// about z points the tool alike: rz is a choice, and jumps as the direction passes.
    pub singular: bool,
}

impl ToolOrientation {
    /// The orientation whose approach axis is `direction`, with rz = 0 where it is singular.
    ///
    /// With the direction (x, y, z), RX = 0, RY = atan2(−z, √(x²+y²)), RZ = atan2(y, x)
    /// (Gao et al. 2022, Eq. 11, doi 10.3390/agriculture12081170, the minus restored: see
    /// [`paper_as_printed_euler`]).
    pub fn along(direction: &Direction<RobotFrame>) -> Self {
        Self::with_free_azimuth(direction, 0.0)
    }

    /// The same, with rz = `azimuth_rad` where the direction is singular: for example the rz of
    /// the pose before, so that the wrist does not spin. Elsewhere it has no effect.
    ///
    /// `None` where `azimuth_rad` is not finite. It is brought into −π to π.
    pub fn along_with_azimuth(direction: &Direction<RobotFrame>, azimuth_rad: f64) -> Option<Self> {
        let (sin, cos) = azimuth_rad.sin_cos();
        azimuth_rad
            .is_finite()
            .then(|| Self::with_free_azimuth(direction, sin.atan2(cos)))
    }

    fn with_free_azimuth(direction: &Direction<RobotFrame>, azimuth_rad: f64) -> Self {
        let [x, y, z] = without_negative_zeros(direction);
        let horizontal = x.hypot(y);
        // For a unit vector the sine of the angle to ±z, which is the angle where it is this small.
        let singular = horizontal <= SINGULAR_ANGLE_RAD;
        let euler = if singular {
            EulerZyx {
                rx: 0.0,
                ry: if z > 0.0 { -FRAC_PI_2 } else { FRAC_PI_2 },
                rz: azimuth_rad,
            }
        } else {
            EulerZyx {
                rx: 0.0,
                ry: (0.0 - z).atan2(horizontal),
                rz: y.atan2(x),
            }
        };
        Self {
            quaternion: quaternion::canonical(&euler.rotation()),
            euler,
            singular,
        }
    }

    /// The quaternion as x y z w, with the sign that [`ToolOrientation::quaternion`] has.
    pub fn quaternion_xyzw(&self) -> [f64; 4] {
        quaternion::to_xyzw(&self.quaternion)
    }
}

/// The angles as Eq. 11 of Gao et al. 2022 stands in print: RY = atan2(z, √(x²+y²)), without the
/// minus.
///
/// With right-handed turns these point the tool along (x, y, −z). They are here for programs
/// that were built by the print, or whose RY turns the other way; for a pose to be reached use
/// [`ToolOrientation`]. A singular direction has rz = 0.
pub fn paper_as_printed_euler(direction: &Direction<RobotFrame>) -> EulerZyx {
    let [x, y, z] = without_negative_zeros(direction);
    let EulerZyx { rx, rz, .. } = ToolOrientation::along(direction).euler;
    EulerZyx {
        rx,
        ry: z.atan2(x.hypot(y)),
        rz,
    }
}

/// A −0 would turn by −π where 0 turns by π.
fn without_negative_zeros(direction: &Direction<RobotFrame>) -> [f64; 3] {
    direction.vector().map(|c| c + 0.0).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI};

    fn along(x: f64, y: f64, z: f64) -> ToolOrientation {
        ToolOrientation::along(&Direction::new(Vector3::new(x, y, z)).unwrap())
    }

    fn angles(x: f64, y: f64, z: f64) -> [f64; 3] {
        let EulerZyx { rx, ry, rz } = along(x, y, z).euler;
        [rx, ry, rz]
    }

    #[test]
    fn angles_by_hand() {
        assert_eq!(angles(1.0, 0.0, 0.0), [0.0, 0.0, 0.0]);
        assert_eq!(angles(0.0, 1.0, 0.0), [0.0, 0.0, FRAC_PI_2]);
        assert_eq!(angles(0.0, -1.0, 0.0), [0.0, 0.0, -FRAC_PI_2]);
        assert_eq!(angles(1.0, 0.0, 1.0), [0.0, -FRAC_PI_4, 0.0]);
        assert_eq!(angles(1.0, 0.0, -1.0), [0.0, FRAC_PI_4, 0.0]);
        assert_eq!(along(1.0, 0.0, 0.0).quaternion_xyzw(), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn straight_back_is_one_half_turn() {
        for (y, z) in [(0.0, 0.0), (-0.0, 0.0), (0.0, -0.0), (-0.0, -0.0)] {
            let tool = along(-1.0, y, z);
            assert_eq!(
                tool.euler,
                EulerZyx {
                    rx: 0.0,
                    ry: 0.0,
                    rz: PI
                }
            );
            assert_eq!(tool.quaternion_xyzw(), [0.0, 0.0, 1.0, 0.0]);
            assert!(!tool.singular);
        }
        assert_eq!(
            along(-1.0, -1e-300, 0.0).quaternion_xyzw(),
            [0.0, 0.0, 1.0, 0.0]
        );
    }

    #[test]
    fn up_and_down_are_singular() {
        let h = FRAC_1_SQRT_2;
        for (z, ry, q) in [(2.0, -FRAC_PI_2, -h), (-2.0, FRAC_PI_2, h)] {
            for (x, y) in [(0.0, 0.0), (-0.0, -0.0), (-1e-6, 1e-6), (1e-300, 0.0)] {
                let tool = along(x, y, z);
                assert!(tool.singular);
                assert_eq!(
                    tool.euler,
                    EulerZyx {
                        rx: 0.0,
                        ry,
                        rz: 0.0
                    }
                );
                let [qx, qy, qz, qw] = tool.quaternion_xyzw();
                assert!(qx == 0.0 && qz == 0.0 && (qy - q).abs() < 1e-15 && (qw - h).abs() < 1e-15);
            }
        }
        assert!(!along(0.0, 2e-6, 1.0).singular);
    }

    #[test]
    fn a_reference_azimuth_fills_the_gap_only() {
        let up = Direction::new(Vector3::z()).unwrap();
        let tool = ToolOrientation::along_with_azimuth(&up, 2.5 * PI).unwrap();
        assert!(tool.singular && (tool.euler.rz - FRAC_PI_2).abs() < 1e-14);
        assert!((tool.quaternion * Vector3::x() - Vector3::z()).norm() < 1e-15);
        assert!((tool.quaternion * Vector3::y() + Vector3::x()).norm() < 1e-14);
        assert!(ToolOrientation::along_with_azimuth(&up, f64::NAN).is_none());
        assert!(ToolOrientation::along_with_azimuth(&up, f64::INFINITY).is_none());
        let side = Direction::new(Vector3::new(1.0, 1.0, 0.2)).unwrap();
        let tool = ToolOrientation::along_with_azimuth(&side, 1.0).unwrap();
        assert_eq!(tool, ToolOrientation::along(&side));
    }

    #[test]
    fn the_print_points_to_the_other_side() {
        let d = Vector3::new(1.0, 2.0, 3.0).normalize();
        let printed = paper_as_printed_euler(&Direction::new(d).unwrap()).rotation() * Vector3::x();
        assert!((printed - Vector3::new(d.x, d.y, -d.z)).norm() < 1e-15);
        let up = paper_as_printed_euler(&Direction::new(Vector3::z()).unwrap());
        assert_eq!(
            up,
            EulerZyx {
                rx: 0.0,
                ry: FRAC_PI_2,
                rz: 0.0
            }
        );
    }
}
