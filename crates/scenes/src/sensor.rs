use std::borrow::Cow;

/// A model of a depth sensor.
///
/// The fields take effect in the order of their declaration.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sensor {
    /// Name, as suites and truth files call it.
    pub name: Cow<'static, str>,
    /// Standard deviation, pixels, of the place on the image from which a reading is taken.
    pub lateral_px: f64,
    /// Effects beside a jump in depth.
    pub edges: Edges,
    /// Readings lost on thin wood.
    pub thin: Thin,
    /// Readings lost at random.
    pub dropout: Dropout,
    /// Readings lost to sunlight.
    pub sunlight: Sunlight,
    /// Systematic error.
    pub bias: Bias,
    /// Random error along the ray.
    pub axial: Axial,
    /// Pixels over which neighbours share their random error; 1 for independent ones.
    pub correlation_px: usize,
    /// Nearest and farthest depth that gives a reading, metres.
    pub range_m: (f64, f64),
    /// Step to which a reading is rounded, metres.
    pub step_m: f64,
    /// Metres per unit of the depth image.
    pub depth_scale: f64,
    /// Relative error of the focal length that the frame's camera states.
    pub focal_error: f64,
    /// Pixels by which the colour image is shifted right and down against the depth.
    pub color_shift_px: (i32, i32),
    /// How the camera mixes what it sees, where it is one of time of flight. Of the fields above, only `bias.constant_m`,
    /// `axial`, `range_m`, `step_m`, `depth_scale`, `focal_error` and `color_shift_px` count then.
    pub time_of_flight: Option<TimeOfFlight>,
}

/// A time-of-flight camera outdoors, registered to a finer colour image.
///
/// One of its pixels sees all surfaces within a blur, each as strongly as it sends light back, and reads their mean
/// depth: edges are smeared over several pixels towards what lies behind, and thin wood is mixed with it. Where the
/// depths are too different, or too little light comes back, there is no reading.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TimeOfFlight {
    /// Pixels of the colour image from one of the camera's own pixels to the next.
    pub pixel_px: f64,
    /// Standard deviation of the blur, pixels of the colour image.
    pub blur_px: f64,
    /// Standard deviation of the depths within a pixel above which it has no reading, metres.
    pub mixed_sd_m: f64,
    /// Amplitude below which a pixel has no reading; 1 is that of a white surface that faces the camera from 1 m.
    pub least_amplitude: f64,
    /// Size of the holes that light from elsewhere leaves, pixels.
    pub hole_px: f64,
    /// Level of smooth noise in 0..1 below which there is a hole.
    pub hole_level: f64,
    /// Share by which the depth of an apple's surface behind its front is too small: light that takes detours within
    /// and between surfaces makes it flatter.
    pub flattening: f64,
    /// Largest error that varies smoothly over surfaces, metres.
    pub warp_m: f64,
    /// Pixels over which it varies.
    pub warp_px: f64,
}

/// Standard deviation of a reading at depth z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axial {
    /// No random error.
    None,
    /// sigma · (z / 0.8 m)².
    Quadratic {
        /// Standard deviation at 0.8 m, metres.
        sigma_at_800_mm: f64,
    },
    /// floor + growth · (z − from)².
    Offset {
        /// Smallest standard deviation, metres.
        floor_m: f64,
        /// Growth, per metre.
        growth_per_m: f64,
        /// Depth of the smallest standard deviation, metres.
        from_m: f64,
    },
    /// floor + growth · z.
    Linear {
        /// Standard deviation at the lens, metres.
        floor_m: f64,
        /// Growth, metres per metre.
        growth: f64,
    },
    /// sigma · z² / (f · b): an error of `sigma_px` in the disparity of a stereo pair.
    Disparity {
        /// Standard deviation of the disparity, pixels of the stereo pair.
        sigma_px: f64,
        /// Focal length f of the pair, pixels.
        focal_px: f64,
        /// Distance b of its lenses, metres.
        baseline_m: f64,
    },
}

impl Axial {
    /// Standard deviation at depth `z`, metres.
    pub fn sigma(&self, z: f64) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::Quadratic { sigma_at_800_mm } => sigma_at_800_mm * (z / 0.8).powi(2),
            Self::Offset {
                floor_m,
                growth_per_m,
                from_m,
            } => floor_m + growth_per_m * (z - from_m).powi(2),
            Self::Linear { floor_m, growth } => floor_m + growth * z,
            Self::Disparity {
                sigma_px,
                focal_px,
                baseline_m,
            } => sigma_px * z * z / (focal_px * baseline_m),
        }
    }
}

/// Depth edges: pixels that have a neighbour (of four) whose depth differs by more than a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edges {
    /// The least difference that is an edge, metres.
    pub jump_m: f64,
    /// Share of the edge's pixels that read a depth mixed evenly at random between the two sides.
    pub mixed_share: f64,
    /// Share of the readings lost within `rim_px` of an edge or of the end of all readings.
    pub invalid_share: f64,
    /// Width of that rim to either side, pixels.
    pub rim_px: usize,
}

/// Wood too thin for the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thin {
    /// Thickness under which readings are lost, metres.
    pub thickness_m: f64,
    /// Share of the readings that remain on such wood.
    pub fill: f64,
}

/// Random loss, in square patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dropout {
    /// Share of the readings lost.
    pub share: f64,
    /// Side of a patch, pixels.
    pub patch_px: usize,
}

/// Round holes where a surface faces the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sunlight {
    /// Share of the cells of a 24-pixel lattice that hold a hole of 3 to 10 pixels' radius.
    pub cell_share: f64,
    /// Least cosine between surface normal and sun at which the hole bites.
    pub least_cosine: f64,
}

/// Systematic error: constant + tilt · (x, y), metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bias {
    /// Everywhere, metres.
    pub constant_m: f64,
    /// Per metre to the right, and per metre down.
    pub tilt: (f64, f64),
}

impl Sensor {
    /// This sensor after a change.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    /// A camera without errors apart from its unit of 0.1 mm: for tests of geometry.
    pub fn perfect() -> Self {
        Self {
            name: "perfect".into(),
            lateral_px: 0.0,
            edges: Edges {
                jump_m: 0.015,
                mixed_share: 0.0,
                invalid_share: 0.0,
                rim_px: 1,
            },
            thin: Thin {
                thickness_m: 0.0,
                fill: 1.0,
            },
            dropout: Dropout {
                share: 0.0,
                patch_px: 1,
            },
            sunlight: Sunlight {
                cell_share: 0.0,
                least_cosine: 0.3,
            },
            bias: Bias {
                constant_m: 0.0,
                tilt: (0.0, 0.0),
            },
            axial: Axial::None,
            correlation_px: 1,
            range_m: (0.1, 6.5),
            step_m: 0.0001,
            depth_scale: 0.0001,
            focal_error: 0.0,
            color_shift_px: (0, 0),
            time_of_flight: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sigma_follows_the_stated_law() {
        let paper = Sensor::paper().axial;
        assert!((paper.sigma(0.8) - 0.001).abs() < 1e-12);
        assert!((paper.sigma(1.6) - 0.004).abs() < 1e-12);
        assert_eq!(Axial::None.sigma(2.0), 0.0);
        let stereo = Axial::Disparity {
            sigma_px: 0.1,
            focal_px: 1000.0,
            baseline_m: 0.05,
        };
        assert!((stereo.sigma(1.0) - 0.002).abs() < 1e-12);
    }
}
