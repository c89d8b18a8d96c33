//! Answers drawn from a known tree with exactly the errors that they state.

use crate::orchard_views::pose_towards;
use nalgebra::{Isometry3, Matrix3, Matrix6, Point3, Translation3, UnitQuaternion, Vector3};
use pomona::{
    AppleAnswer, FittedApple, FrameAnswer, Method, PickDirection, RobotFromCamera, Status,
};
use pomona_cloud::PixelBox;
use pomona_transforms::{Direction, Position, PositionCovariance, Transform};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const CAMERA: &str = "camera_color_optical_frame";

/// An apple of the tree, in the robot's frame.
#[derive(Clone, Copy)]
pub(crate) struct Apple {
    pub(crate) center: Vector3<f64>,
    pub(crate) radius: f64,
    pub(crate) direction: Vector3<f64>,
}

/// What one frame does to the truth.
#[derive(Clone, Copy)]
pub(crate) struct View {
    pub(crate) angle: f64,
    pub(crate) sway: Vector3<f64>,
    pub(crate) pose_sd: (f64, f64),
}

pub(crate) struct Trial {
    pub(crate) rng: ChaCha8Rng,
}

impl Trial {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            rng: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.rng.random::<f64>()).sum::<f64>() - 6.0
    }

    pub(crate) fn normals(&mut self) -> Vector3<f64> {
        Vector3::new(self.normal(), self.normal(), self.normal())
    }

    pub(crate) fn tree(&mut self, apples: usize) -> Vec<Apple> {
        let mut tree: Vec<Apple> = Vec::new();
        while tree.len() < apples {
            let mut between = |a: f64, b: f64| self.rng.random_range(a..b);
            let center = Vector3::new(between(0.7, 1.0), between(-0.4, 0.4), between(0.2, 0.8));
            let radius = between(0.030, 0.044);
            let direction = Vector3::new(between(-0.5, 0.5), between(-0.5, 0.5), 1.0).normalize();
            let apple = Apple {
                center,
                radius,
                direction,
            };
            let free = |other: &Apple| (other.center - center).norm() > other.radius + radius;
            if tree.iter().all(free) {
                tree.push(apple);
            }
        }
        tree
    }

    /// Answers with the stated errors: 1 mm across, 3 mm along the line of sight, 2 degrees.
    pub(crate) fn answer(
        &mut self,
        id: &str,
        tree: &[Apple],
        view: &View,
    ) -> (FrameAnswer, RobotFromCamera) {
        let pose = pose_towards(Vector3::new(0.85, 0.0, 0.5), 0.85, view.angle, 0.1);
        let (turn, shift) = view.pose_sd;
        let error = Isometry3::from_parts(
            Translation3::from(self.normals() * shift),
            UnitQuaternion::from_scaled_axis(self.normals() * turn),
        );
        let mut apples = Vec::new();
        for (i, apple) in tree.iter().enumerate() {
            let truth = (pose.inverse() * Point3::from(apple.center + view.sway)).coords;
            let sight = truth.normalize();
            let covariance = Matrix3::identity() * 1e-6 + sight * sight.transpose() * 8e-6;
            let factor = covariance.cholesky().unwrap().l();
            let center = truth + factor * self.normals();
            let radius = apple.radius + 5e-4 * self.normal();
            let tilt = UnitQuaternion::from_scaled_axis(self.normals() * 0.035);
            let direction = tilt * (pose.inverse().rotation * apple.direction);
            let (center, direction) = (
                Position::new(center.into()),
                Direction::new(direction).unwrap(),
            );
            let bounds = PixelBox {
                name: i.to_string(),
                x_min: 0.0,
                y_min: 0.0,
                x_max: 9.0,
                y_max: 9.0,
                score: 1.0,
            };
            let foot = center.moved(&direction, 1.1 * radius);
            let mut answer = AppleAnswer::new(i, bounds, Status::Picked);
            let mut fitted = FittedApple::new(center, radius, 100, 0.001);
            fitted.center_covariance = Some(PositionCovariance::new(covariance));
            fitted.radius_sd_m = Some(5e-4);
            answer.apple = Some(fitted);
            let mut pick = PickDirection::new(&center, foot).unwrap();
            pick.sd_rad = Some(0.035);
            answer.pick = Some(pick);
            answer.confidence = Some(0.8);
            apples.push(answer);
        }
        let answer = FrameAnswer::new(Method::Robust, 0, id, CAMERA, apples);
        // What is stated is off by the error: the true pose is Exp(error) of it, in the robot's axes.
        let stated = Transform::from_isometry(&(error.inverse() * pose)).unwrap();
        let mut named = RobotFromCamera::new(stated, "base_link", CAMERA);
        let mut covariance = Matrix6::zeros();
        for i in 0..3 {
            covariance[(i, i)] = turn * turn;
            covariance[(i + 3, i + 3)] = shift * shift;
        }
        named.covariance = Some(covariance);
        (answer, named)
    }
}

pub(crate) fn still(angle: f64) -> View {
    View {
        angle,
        sway: Vector3::zeros(),
        pose_sd: (0.0, 0.0),
    }
}
