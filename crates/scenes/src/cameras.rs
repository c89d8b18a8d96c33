//! Sensors by name, each with its source.

use crate::random::{Purpose, stream};
use crate::sensor::{Axial, Bias, Dropout, Edges, Sensor, Sunlight, Thin, TimeOfFlight};
use rand::RngExt;

/// A make of depth camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Make {
    /// `paper`: the paper's own.
    Paper,
    /// `kinect`: the first Kinect, structured light.
    Kinect,
    /// `azure-kinect`: time of flight.
    AzureKinect,
    /// `d400`: a stereo pair with a projector.
    D400,
}

impl Make {
    /// All makes.
    pub const ALL: [Self; 4] = [Self::Paper, Self::Kinect, Self::AzureKinect, Self::D400];

    /// The name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Kinect => "kinect",
            Self::AzureKinect => "azure-kinect",
            Self::D400 => "d400",
        }
    }

    /// The make called `name`.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|make| make.name() == name)
    }

    /// The sensor, indoors.
    pub fn sensor(self) -> Sensor {
        match self {
            Self::Paper => Sensor::paper(),
            Self::Kinect => Sensor::kinect(),
            Self::AzureKinect => Sensor::azure_kinect(),
            Self::D400 => Sensor::d400(),
        }
    }
}

impl Sensor {
    /// The paper's camera (Tuyang FM811-IX-A, structured light; Gao et al. 2022, section 2.1).
    ///
    /// It reads from 0.7 to 3.5 m with an accuracy of 1 to 5 mm and resolves
    /// 0.2 mm at 0.8 m, which is the unit here. The law between (1 mm at 0.8 m,
    /// growing with z²), the quarter of mixed pixels at the edges and a near
    /// limit below the stated one are ours: the paper states none.
    pub fn paper() -> Self {
        let edges = Edges {
            mixed_share: 0.25,
            ..Self::perfect().edges
        };
        Self {
            name: Make::Paper.name().into(),
            edges,
            axial: Axial::Quadratic {
                sigma_at_800_mm: 0.001,
            },
            range_m: (0.35, 3.5),
            step_m: 0.0002,
            depth_scale: 0.0002,
            ..Self::perfect()
        }
    }

    /// The first Kinect: σ(z) = 1.2 mm + 1.9 mm/m² · (z − 0.4 m)², and 0.8 pixels sideways.
    ///
    /// Nguyen, Izadi and Lovell 2012, "Modeling Kinect Sensor Noise for
    /// Improved 3D Reconstruction and Tracking", doi 10.1109/3DIMPVT.2012.84: the axial law for
    /// surfaces within 60° of the ray, and the lateral one, σ = 0.8 + 0.035 θ/(π/2 − θ)
    /// pixels, at θ = 0. The pixel here is that of the frame, which may be
    /// finer than the Kinect's 640×480. Shares at the edges are ours.
    pub fn kinect() -> Self {
        let axial = Axial::Offset {
            floor_m: 0.0012,
            growth_per_m: 0.0019,
            from_m: 0.4,
        };
        Self {
            name: Make::Kinect.name().into(),
            lateral_px: 0.8,
            edges: Edges {
                mixed_share: 0.1,
                invalid_share: 0.3,
                ..Self::perfect().edges
            },
            axial,
            range_m: (0.4, 4.0),
            step_m: 0.001,
            depth_scale: 0.001,
            ..Self::perfect()
        }
    }

    /// The Azure Kinect, a time-of-flight camera: 0.7 mm + 0.8 mm/m · z, whole
    /// millimetres, many mixed pixels.
    ///
    /// Its maker states a standard deviation of at most 17 mm and a systematic
    /// error under 11 mm + 0.1 % up to 3.86 m; Tölgyessy et al. 2021 (doi 10.3390/s21020413)
    /// confirm both, and the flying pixels and the failure in sunlight. The law
    /// here, which stays well under those bounds, and the shares are ours.
    pub fn azure_kinect() -> Self {
        Self {
            name: Make::AzureKinect.name().into(),
            edges: Edges {
                mixed_share: 0.45,
                invalid_share: 0.15,
                ..Self::perfect().edges
            },
            axial: Axial::Linear {
                floor_m: 0.0007,
                growth: 0.0008,
            },
            range_m: (0.5, 3.86),
            step_m: 0.001,
            depth_scale: 0.001,
            ..Self::perfect()
        }
    }

    /// A time-of-flight camera in an orchard by day, its depth registered to a finer colour image.
    ///
    /// An Azure Kinect has a pixel of its own for 1.82 of its colour camera at 1920 × 1080 (focal lengths of 504 and 917
    /// pixels). The other numbers were chosen so that two real frames and the suite `dense` agree in the statistics of
    /// docs/scenes.md, by `cargo run --release -p pomona-cli --example likeness`.
    pub fn time_of_flight_outdoors() -> Self {
        let flight = TimeOfFlight {
            pixel_px: 1.82,
            blur_px: 2.8,
            mixed_sd_m: 0.08,
            least_amplitude: 0.025,
            hole_px: 16.0,
            hole_level: 0.2,
            flattening: 0.5,
            warp_m: 0.003,
            warp_px: 16.0,
        };
        Self {
            name: "time-of-flight-outdoors".into(),
            axial: Self::azure_kinect().axial,
            range_m: (0.5, 1.9),
            step_m: 0.001,
            depth_scale: 0.001,
            time_of_flight: Some(flight),
            ..Self::perfect()
        }
    }

    /// A RealSense of the D400 series, a stereo pair: 0.08 pixels of disparity,
    /// shared by neighbours within 4 pixels.
    ///
    /// σ(z) = z² · 0.08 px / (f b), with f = 1005 px (1280 pixels over 65°) and b = 55 mm of
    /// the D415: Grunnet-Jepsen, Sweetser and Woodfill, "Best-Known-Methods for
    /// Tuning Intel RealSense D400 Depth Cameras for Best Performance". The
    /// lattice stands for the matching window; its width and the shares at the edges are ours.
    pub fn d400() -> Self {
        let axial = Axial::Disparity {
            sigma_px: 0.08,
            focal_px: 1005.0,
            baseline_m: 0.055,
        };
        Self {
            name: Make::D400.name().into(),
            edges: Edges {
                mixed_share: 0.35,
                invalid_share: 0.2,
                ..Self::perfect().edges
            },
            axial,
            correlation_px: 4,
            range_m: (0.45, 6.0),
            step_m: 0.001,
            depth_scale: 0.001,
            ..Self::perfect()
        }
    }

    /// The same camera in an orchard, with all the errors that occur there.
    ///
    /// Rims two pixels wide lose half their readings, wood under 6 mm half of
    /// its own; 2 % fall out in patches, sunlight burns holes into 6 % of the
    /// cells; readings are whole millimetres, 2 mm off everywhere and by 4 mm per metre across;
    /// the focal length is stated 2 % wrong and the colours lie 2 pixels
    /// aside. `seed` draws the signs of the systematic errors.
    #[must_use]
    pub fn outdoors(self, seed: u64) -> Self {
        let mut rng = stream(seed, Purpose::Systematic, 0);
        let mut sign = || if rng.random::<bool>() { 1.0 } else { -1.0 };
        Self {
            edges: Edges {
                invalid_share: 0.5,
                rim_px: 2,
                ..self.edges
            },
            thin: Thin {
                thickness_m: 0.006,
                fill: 0.5,
            },
            dropout: Dropout {
                share: 0.02,
                patch_px: 3,
            },
            sunlight: Sunlight {
                cell_share: 0.06,
                least_cosine: 0.5,
            },
            bias: Bias {
                constant_m: 0.002 * sign(),
                tilt: (0.004 * sign(), 0.004 * sign()),
            },
            step_m: self.step_m.max(0.001),
            focal_error: 0.02 * sign(),
            color_shift_px: ((2.0 * sign()) as i32, 0),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn makes_are_found_by_name_and_name_their_sensor() {
        for make in Make::ALL {
            assert_eq!(Make::named(make.name()), Some(make));
            assert_eq!(make.sensor().name, make.name());
        }
        assert_eq!(Make::named("lidar"), None);
    }

    /// Values computed by hand from the cited formulas.
    #[test]
    fn axial_laws_are_the_cited_ones() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(near(Sensor::paper().axial.sigma(0.8), 0.001));
        assert!(near(Sensor::kinect().axial.sigma(1.4), 0.0031));
        assert!(near(Sensor::d400().axial.sigma(1.0), 0.001_447));
        let azure = Sensor::azure_kinect().axial;
        assert!(azure.sigma(3.86) < 0.017);
    }

    #[test]
    fn outdoors_draws_signs_only() {
        for seed in 0..20 {
            let sensor = Sensor::paper().outdoors(seed);
            assert_eq!(sensor.focal_error.abs(), 0.02);
            assert_eq!(sensor.color_shift_px.0.abs(), 2);
            assert_eq!(sensor.step_m, 0.001);
        }
        let both = (0..20).map(|seed| Sensor::paper().outdoors(seed).focal_error > 0.0);
        assert!(both.clone().any(|p| p) && !both.into_iter().all(|p| p));
    }
}
