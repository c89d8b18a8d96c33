use crate::apple::Apple;
use crate::curve::Curve;
use crate::light::Light;
use crate::world::{Bark, Branch, World};
use nalgebra::{Isometry3, Point3, Rotation3, Translation3, Vector3};
use pomona_geometry::Plane;

/// An axis of the camera about which the lab's body is turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraAxis {
    /// To the right.
    X,
    /// Down.
    Y,
    /// Forward.
    Z,
}

/// One of the paper's fifteen orientations: degrees about an axis of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// The axis.
    pub axis: CameraAxis,
    /// Angle in degrees, with the sign of the paper's tables.
    pub degrees: i32,
}

impl Orientation {
    /// The rows of Tables 1, 2 and 3 (Gao et al. 2022), in their order.
    pub const PAPER: [Self; 15] = {
        const fn row(axis: CameraAxis, degrees: i32) -> Orientation {
            Orientation { axis, degrees }
        }
        use CameraAxis::{X, Y, Z};
        [
            row(X, -90),
            row(X, -45),
            row(X, 0),
            row(X, 45),
            row(X, 90),
            row(Y, -60),
            row(Y, -30),
            row(Y, 0),
            row(Y, 30),
            row(Y, 60),
            row(Z, -90),
            row(Z, -45),
            row(Z, 0),
            row(Z, 45),
            row(Z, 90),
        ]
    };

    /// Name such as `x-90`, `y0`, `z45`.
    pub fn name(&self) -> String {
        let axis = match self.axis {
            CameraAxis::X => 'x',
            CameraAxis::Y => 'y',
            CameraAxis::Z => 'z',
        };
        format!("{axis}{}", self.degrees)
    }

    /// The turn from the orientation of 0 degrees.
    ///
    /// The paper's z angles run against the right-hand rule (−90° turns
    /// (0, −1, 0) to (1, 0, 0)); its x angles follow it; its y angles show no sign.
    pub fn rotation(&self) -> Rotation3<f64> {
        let angle = f64::from(self.degrees).to_radians();
        match self.axis {
            CameraAxis::X => Rotation3::from_axis_angle(&Vector3::x_axis(), angle),
            CameraAxis::Y => Rotation3::from_axis_angle(&Vector3::y_axis(), angle),
            CameraAxis::Z => Rotation3::from_axis_angle(&Vector3::z_axis(), -angle),
        }
    }
}

/// The paper's lab set-up (section 2.2.6): one apple joined rigidly to one straight branch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Lab {
    /// Radius of the apple, metres.
    pub apple_radius: f64,
    /// Radius of the branch, metres; its 5 mm are taken for the diameter.
    pub branch_radius: f64,
    /// Length of the joint between the two surfaces, metres.
    pub joint: f64,
    /// Length of the branch, metres.
    pub branch_length: f64,
    /// Distance of the apple's centre from the camera, metres.
    pub distance: f64,
    /// Distance of the wall behind from the camera, metres.
    pub backdrop_distance: f64,
}

impl Default for Lab {
    /// r = 25.78 mm, a branch 5 mm thick whose axis passes 33.28 mm from the
    /// centre (1.29 r: inside the method's band of 0.5 r to 1.5 r, its
    /// surface inside the shell from 1.2 r), 0.8 m from the camera, the wall 0.45 m behind.
    fn default() -> Self {
        Self {
            apple_radius: 0.025_78,
            branch_radius: 0.0025,
            joint: 0.005,
            branch_length: 0.3,
            distance: 0.8,
            backdrop_distance: 1.25,
        }
    }
}

impl Lab {
    /// The body in one of the paper's orientations, before the wall.
    ///
    /// At 0° the branch lies along the camera's x axis above the apple; the
    /// body turns about the apple's centre, the wall stays.
    pub fn world(&self, orientation: Orientation) -> World {
        let mut body = World::new(Light::default());
        let apple = Apple::sphere(Point3::origin(), self.apple_radius);
        body.add_apple(apple);
        let height = self.apple_radius + self.joint + self.branch_radius;
        let end = |side: f64| Point3::new(side * 0.5 * self.branch_length, -height, 0.0);
        body.add_branch(Branch {
            curve: Curve::straight(end(-1.0), end(1.0)),
            start_radius: self.branch_radius,
            end_radius: self.branch_radius,
        });
        let joint = Curve::straight(apple.stem_foot(), Point3::new(0.0, -height, 0.0));
        let stem = Branch {
            curve: joint,
            start_radius: 0.0015,
            end_radius: 0.0015,
        };
        body.add_twig(&stem, Bark::Wood);
        // The light stays with the room: it is set after the turn.
        let pose = Isometry3::from_parts(
            Translation3::new(0.0, 0.0, self.distance),
            orientation.rotation().into(),
        );
        let mut world = body.transformed(&pose);
        world.light = Light::default();
        let wall = Point3::new(0.0, 0.0, self.backdrop_distance);
        if let Some(plane) = Plane::new(wall, -Vector3::z()) {
            world.add_backdrop(plane);
        }
        world
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::nearest_branch;

    #[test]
    fn true_directions_are_the_papers() {
        let s = std::f64::consts::FRAC_1_SQRT_2;
        let up = [0.0, -1.0, 0.0];
        // Columns 'actual attitude direction vector' of Tables 1 to 3.
        let table = [
            [0.0, 0.0, 1.0],
            [0.0, -s, s],
            up,
            [0.0, -s, -s],
            [0.0, 0.0, -1.0],
            up,
            up,
            up,
            up,
            up,
            [1.0, 0.0, 0.0],
            [s, -s, 0.0],
            up,
            [-s, -s, 0.0],
            [-1.0, 0.0, 0.0],
        ];
        for (orientation, expected) in Orientation::PAPER.iter().zip(table) {
            let world = Lab::default().world(*orientation);
            let center = world.apples()[0].center;
            let near = nearest_branch(&world, &center).unwrap();
            let foot = world.branches()[near.index].curve.point(near.parameter);
            let direction = (foot - center).normalize();
            let gap = (direction - Vector3::from(expected)).norm();
            assert!(gap < 1e-9, "{}: {direction:?}", orientation.name());
            assert!((near.distance - 0.033_28).abs() < 1e-12);
        }
    }

    #[test]
    fn names_are_the_axis_and_the_degrees() {
        let names: Vec<_> = Orientation::PAPER.iter().map(Orientation::name).collect();
        assert_eq!(names[0], "x-90");
        assert_eq!(names[7], "y0");
        assert_eq!(names[14], "z90");
    }
}
