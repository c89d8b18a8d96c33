use super::mounting::Mounting;
use nalgebra::{Matrix2, Matrix3, Matrix3x2, Point3, Vector2, Vector3};
use pomona::AppleAnswer;
use pomona_geometry::{Line, angle_between};
use pomona_scenes::AppleTruth;
use pomona_transforms::{Position, RobotFrame, UncertainDirection, UncertainPosition, twist};
use serde::{Deserialize, Serialize};

/// One answered apple in the base's frame: how far the tool is from where it should be, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BaseRow {
    /// Place of the tool less the apple's true centre, in the base's axes, metres.
    pub offset: [f64; 3],
    /// How far off its place is, metres.
    pub position: PositionTerms,
    /// How far off its direction is, radians; absent where no branch is near in truth.
    pub direction: Option<DirectionTerms>,
    /// Squared error of the place in units of the covariance stated for it; χ² of 3 degrees of freedom if calibrated.
    pub position_nees: Option<f64>,
    /// The same of the direction; χ² of 2 degrees of freedom.
    pub direction_nees: Option<f64>,
    /// What the robot's plan makes of it.
    pub planned: Option<PlannedRow>,
}

/// One part of an error: how large it is, and how large it was expected to be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Term {
    /// Length of the vector, metres, or angle, radians.
    pub error: f64,
    /// Root of the trace of the covariance that method and calibration state for it.
    pub stated: Option<f64>,
}

/// What puts the tool in another place, metres; each part taken alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PositionTerms {
    /// The centre, in the camera's frame.
    pub sphere_center: Term,
    /// The calibration's rotation, by the lever arm from camera to apple.
    pub calibration_rotation: Term,
    /// The calibration's translation: the place of the camera.
    pub calibration_translation: Term,
    /// Both together; they are not independent, and partly cancel.
    pub calibration: Term,
    /// The tool's place against the apple's.
    pub total: Term,
}

/// What turns the tool another way, radians; each part taken alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct DirectionTerms {
    /// The centre, were the branch known.
    pub sphere_center: Term,
    /// The line of the branch, were the centre known.
    pub branch: Term,
    /// Both: the direction in the camera's frame.
    pub camera: Term,
    /// The calibration's rotation.
    pub calibration: Term,
    /// The tool's approach axis against the true direction.
    pub total: Term,
}

/// The tool at the apple as the robot's plan has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PlannedRow {
    /// `free`, `blocked`, or the reason of the refusal.
    pub status: String,
    /// Angle between the planned approach and the direction that it comes from, radians.
    pub tilt: Option<f64>,
    /// Distance of the tool from the apple's true centre, metres.
    pub position_error: Option<f64>,
    /// Angle between the tool's approach axis and the true direction, radians; a tilt, or another candidate,
    /// is in it.
    pub direction_error: Option<f64>,
}

fn exactly(error: f64) -> Term {
    Term {
        error,
        stated: None,
    }
}

fn stated(error: f64, covariance: Option<&Matrix3<f64>>) -> Term {
    Term {
        error,
        stated: covariance.map(|c| c.trace().max(0.0).sqrt()),
    }
}

impl BaseRow {
    /// Compares an answer in the base's frame with the truth; `None` where there is no answer.
    pub(crate) fn of(
        mounting: &Mounting,
        truth: &AppleTruth,
        answer: &AppleAnswer,
    ) -> Option<Self> {
        let robot = answer.robot.as_ref().filter(|_| answer.is_picked())?;
        let offset = robot.center.point() - mounting.true_place(truth).point();
        let (position, place_covariance) = mounting.position_terms(truth, answer, offset)?;
        let toward = robot.tool.quaternion * Vector3::x();
        let (direction, direction_nees) = match truth.direction {
            Some(direction) => mounting
                .direction_terms(truth, direction, answer, &toward)
                .unzip(),
            None => (None, None),
        };
        Some(Self {
            offset: offset.into(),
            position,
            direction,
            position_nees: place_covariance.and_then(|c| {
                let inverse = c.cholesky()?;
                Some(offset.dot(&inverse.solve(&offset)))
            }),
            direction_nees: direction_nees.flatten(),
            planned: mounting.planned(truth, answer),
        })
    }
}

/// From a centre to the nearest point of a line.
fn towards(center: Point3<f64>, point: Point3<f64>, along: Vector3<f64>) -> Option<Vector3<f64>> {
    let line = Line::new(point, along)?;
    Some(line.foot(&center) - center)
}

impl Mounting {
    fn true_place(&self, truth: &AppleTruth) -> Position<RobotFrame> {
        self.truth
            .position(&Position::new(Point3::from(truth.center)))
    }

    /// With the covariance of the place, where the method states one.
    fn position_terms(
        &self,
        truth: &AppleTruth,
        answer: &AppleAnswer,
        offset: Vector3<f64>,
    ) -> Option<(PositionTerms, Option<Matrix3<f64>>)> {
        let apple = answer.apple?;
        let (seen, center) = (apple.center.point(), Point3::from(truth.center));
        let (here, there) = (&self.estimate.transform, &self.truth);
        let lever = here.rotation() * seen.coords;
        let rotation = lever - there.rotation() * seen.coords;
        let translation = here.translation_m() - there.translation_m();
        let arm = twist::skew(&lever);
        let by_rotation = arm * self.estimate.rotation_covariance_rad2() * arm.transpose();
        let by_translation = self.estimate.translation_covariance_m2();
        let exact = UncertainPosition::from(apple.center);
        let both = self.estimate.position(&exact).covariance_m2;
        let own = apple.center_covariance.map(|c| c.matrix_m2());
        let total = own.map(|covariance_m2| {
            let uncertain = UncertainPosition {
                covariance_m2,
                ..exact
            };
            self.estimate.position(&uncertain).covariance_m2
        });
        let terms = PositionTerms {
            sphere_center: stated((seen - center).norm(), own.as_ref()),
            calibration_rotation: stated(rotation.norm(), Some(&by_rotation)),
            calibration_translation: stated(translation.norm(), Some(&by_translation)),
            calibration: stated((rotation + translation).norm(), Some(&both)),
            total: stated(offset.norm(), total.as_ref()),
        };
        Some((terms, total))
    }

    /// With the normalised squared error of the direction, where the method states its uncertainty.
    fn direction_terms(
        &self,
        truth: &AppleTruth,
        true_direction: [f64; 3],
        answer: &AppleAnswer,
        toward: &Vector3<f64>,
    ) -> Option<(DirectionTerms, Option<f64>)> {
        let wood = truth.branch.as_ref()?;
        let (branch, pick) = (answer.branch?, answer.pick?);
        let center = Point3::from(truth.center);
        let seen = answer.apple?.center.point();
        let right = Vector3::from(true_direction);
        let given = pick.direction.vector();
        let of_center = towards(
            seen,
            Point3::from(wood.point),
            Vector3::from(wood.direction),
        )?;
        let of_branch = towards(center, branch.point.point(), branch.direction.vector())?;

        let exact = UncertainDirection::from(pick.direction);
        let turn = self.estimate.direction(&exact).covariance_rad2;
        let own = pick
            .sd_rad
            .map(|sd| (Matrix3::identity() - given * given.transpose()) * (sd * sd));
        let total = own.map(|covariance_rad2| {
            let uncertain = UncertainDirection {
                covariance_rad2,
                ..exact
            };
            self.estimate.direction(&uncertain)
        });
        let in_base = self.truth.rotation() * right;
        let turned = angle_between(
            &(self.estimate.transform.rotation() * given),
            &(self.truth.rotation() * given),
        )?;
        let covariance = total.map(|t| t.covariance_rad2);
        let terms = DirectionTerms {
            sphere_center: exactly(angle_between(&of_center, &right)?),
            branch: exactly(angle_between(&of_branch, &right)?),
            camera: stated(angle_between(&given, &right)?, own.as_ref()),
            calibration: stated(turned, Some(&turn)),
            total: stated(angle_between(toward, &in_base)?, covariance.as_ref()),
        };
        let nees = total.and_then(|t| direction_nees(&t, toward, &in_base));
        Some((terms, nees))
    }

    fn planned(&self, truth: &AppleTruth, answer: &AppleAnswer) -> Option<PlannedRow> {
        let plan = answer.plan.as_ref()?;
        let approach = plan.approach.as_ref().ok().map(|planned| &planned.approach);
        let right = truth
            .direction
            .map(|d| self.truth.rotation() * Vector3::from(d));
        let off = |place: Vector3<f64>| place - self.true_place(truth).point().coords;
        Some(PlannedRow {
            status: plan.status().to_owned(),
            tilt: approach.map(|a| a.tilt_rad),
            position_error: approach.map(|a| off(a.grasp.translation.vector).norm()),
            direction_error: approach
                .zip(right)
                .and_then(|(a, right)| angle_between(&(a.grasp.rotation * Vector3::x()), &right)),
        })
    }
}

/// The turn from the stated direction to the true one, in units of its covariance across it.
fn direction_nees(
    stated: &UncertainDirection<RobotFrame>,
    toward: &Vector3<f64>,
    right: &Vector3<f64>,
) -> Option<f64> {
    let angle = angle_between(toward, right)?;
    let u = toward.cross(&least_axis(toward)).try_normalize(1e-9)?;
    let across = Matrix3x2::from_columns(&[u, toward.cross(&u)]);
    let flat = across.transpose() * right;
    let error = flat
        .try_normalize(1e-300)
        .map_or(Vector2::zeros(), |f| f * angle);
    let covariance: Matrix2<f64> = across.transpose() * stated.covariance_rad2 * across;
    Some(error.dot(&covariance.cholesky()?.solve(&error)))
}

/// The axis of the frame to which the vector is most nearly perpendicular.
fn least_axis(v: &Vector3<f64>) -> Vector3<f64> {
    let mut axis = Vector3::zeros();
    axis[v.iamin()] = 1.0;
    axis
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona::{FittedApple, FittedBranch, PickDirection, RobotFromCamera, RobotTarget, Status};
    use pomona_transforms::{
        CameraFrame, Direction, PositionCovariance, Transform, UncertainTransform,
    };
    use serde_json::json;

    fn truth() -> AppleTruth {
        serde_json::from_value(json!({
            "box": {"name": "0", "x_min": 0, "y_min": 0, "x_max": 9, "y_max": 9, "score": 1.0},
            "center": [0.1, -0.05, 0.8], "radius": 0.04,
            "branch": {"point": [0.1, -0.1, 0.8], "direction": [1.0, 0.0, 0.0], "radius": 0.005},
            "direction": [0.0, -1.0, 0.0]
        }))
        .unwrap()
    }

    /// An answer that is `off` the truth, in the frame that `estimate` leads to.
    fn answer(estimate: &Transform<RobotFrame, CameraFrame>, off: f64) -> AppleAnswer {
        let center = Position::new(Point3::new(0.1, -0.05, 0.8 + off));
        let given = Direction::new(Vector3::new(0.0, -1.0, 0.02)).unwrap();
        let on_branch = Position::new(Point3::new(0.1, -0.1, 0.801));
        let mut apple = FittedApple::new(center, 0.041, 9, 0.0);
        let covariance = Matrix3::from_diagonal(&Vector3::new(1e-6, 1e-6, 4e-6));
        apple.center_covariance = Some(PositionCovariance::new(covariance));
        let mut pick = PickDirection::new(&center, on_branch).unwrap();
        (pick.direction, pick.sd_rad) = (given, Some(0.01));
        let along_x = Direction::new(Vector3::x()).unwrap();
        let to_base = RobotFromCamera::new(*estimate, "base", "camera");

        let mut answer = AppleAnswer::new(0, truth().bounds, Status::Picked);
        answer.robot = Some(RobotTarget::new(&to_base, &center, &given));
        answer.apple = Some(apple);
        answer.branch = Some(FittedBranch::new(on_branch, along_x, 9, 0.0));
        answer.pick = Some(pick);
        answer
    }

    fn place() -> Transform<RobotFrame, CameraFrame> {
        Transform::from_quaternion([-0.3, 0.1, 0.6], [-0.5, 0.5, -0.5, 0.5]).unwrap()
    }

    fn row(estimate: Transform<RobotFrame, CameraFrame>, off: f64) -> BaseRow {
        let mounting = Mounting {
            truth: place(),
            estimate: UncertainTransform::exact(estimate),
        };
        BaseRow::of(&mounting, &truth(), &answer(&estimate, off)).unwrap()
    }

    #[test]
    fn with_the_true_place_of_the_camera_its_own_errors_are_left() {
        let row = row(place(), 0.002);
        let direction = row.direction.unwrap();
        assert!((row.position.total.error - 0.002).abs() < 1e-9);
        assert!((direction.total.error - direction.camera.error).abs() < 1e-9);
        assert!((direction.camera.error - 0.02_f64.atan()).abs() < 1e-9);
        assert_eq!(row.position.calibration.error, 0.0);
        assert_eq!(direction.calibration.error, 0.0);
        // 2 mm in units of 2 mm, and 0.02 rad in units of 0.01.
        assert!((row.position_nees.unwrap() - 1.0).abs() < 1e-9);
        assert!((row.direction_nees.unwrap() - (0.02_f64.atan() / 0.01).powi(2)).abs() < 1e-6);
        // The foot is 1 mm off in 50, the centre 2 mm: 0.02 and 0.04 rad, the other way.
        assert!((direction.branch.error - 0.02_f64.atan()).abs() < 1e-9);
        assert!((direction.sphere_center.error - 0.04_f64.atan()).abs() < 1e-9);
    }

    #[test]
    fn a_camera_five_millimetres_from_where_it_is_said_to_be_is_five_millimetres() {
        let shift = Vector3::new(0.003, 0.0, -0.004);
        let [x, y, z]: [f64; 3] = (place().translation_m() + shift).into();
        let moved = Transform::from_quaternion([x, y, z], place().quaternion_xyzw()).unwrap();
        let row = row(moved, 0.0);
        assert!((Vector3::from(row.offset) - shift).norm() < 1e-12);
        for term in [
            row.position.total,
            row.position.calibration,
            row.position.calibration_translation,
        ] {
            assert!((term.error - 0.005).abs() < 1e-12, "{term:?}");
        }
        assert!(row.position.calibration_rotation.error < 1e-12);
        assert!((row.position_nees.unwrap() - (9.0 / 4.0 + 16.0)).abs() < 1e-6);
    }

    #[test]
    fn a_turned_camera_swings_the_apple_by_its_lever_arm() {
        let turn = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, 0.01));
        let there = place().isometry();
        let turned = nalgebra::Isometry3::from_parts(there.translation, turn * there.rotation);
        let row = row(Transform::from_isometry(&turned).unwrap(), 0.0);
        // About the base's z, which is the camera's −y: x and z are the arm.
        let arm = 0.1_f64.hypot(0.8);
        let expected = 2.0 * (0.005_f64).sin() * arm;
        assert!((row.position.calibration_rotation.error - expected).abs() < 1e-12);
        assert!((row.position.total.error - expected).abs() < 1e-12);
        assert!(row.position.calibration_translation.error < 1e-12);
        // Almost parallel to the axis, the direction hardly turns.
        assert!(row.direction.unwrap().calibration.error < 1e-3);
    }

    #[test]
    fn a_refusal_sends_no_gripper() {
        let estimate = UncertainTransform::exact(place());
        let mut refused = answer(&place(), 0.0);
        refused.status = Status::NoBranch;
        let mounting = Mounting {
            truth: place(),
            estimate,
        };
        assert_eq!(BaseRow::of(&mounting, &truth(), &refused), None);
    }
}
