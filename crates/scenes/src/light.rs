use nalgebra::{Isometry3, Unit, Vector3};

/// The sun, the sky and the ground as lights; colours are linear, 1 is full.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Direction to the sun.
    pub toward_sun: Unit<Vector3<f64>>,
    /// Direction away from the ground.
    pub up: Unit<Vector3<f64>>,
    /// Colour of the sun's light.
    pub sun: [f64; 3],
    /// Colour of the light from above.
    pub sky: [f64; 3],
    /// Colour of the light from below.
    pub ground: [f64; 3],
    /// Whether objects cast shadows; takes half as long again as the colours.
    pub shadows: bool,
}

impl Default for Light {
    /// A bright day, the sun behind the camera's left shoulder, no shadows cast.
    fn default() -> Self {
        Self {
            toward_sun: Unit::new_normalize(Vector3::new(-0.45, -0.75, -0.6)),
            up: -Vector3::y_axis(),
            sun: [0.85, 0.80, 0.70],
            sky: [0.34, 0.38, 0.45],
            ground: [0.20, 0.19, 0.15],
            shadows: false,
        }
    }
}

impl Light {
    pub(crate) fn transformed(mut self, by: &Isometry3<f64>) -> Self {
        self.toward_sun = by * self.toward_sun;
        self.up = by * self.up;
        self
    }
}
