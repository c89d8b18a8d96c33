use serde::{Deserialize, Serialize};

/// A depth camera whose noise is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SensorPreset {
    /// No camera in particular: 0.5 mm + 1.4 mm/m² z², which lies near all of the others from 0.7 to 1.5 m.
    #[default]
    Generic,
    /// The paper's structured-light camera: 1 mm at 0.8 m, growing with z².
    Paper,
    /// The first Kinect: 1.2 mm + 1.9 mm/m² (z − 0.4 m)² (Nguyen, Izadi and Lovell 2012,
    /// doi 10.1109/3DIMPVT.2012.84).
    Kinect,
    /// Azure Kinect: 0.7 mm + 0.8 mm/m z.
    AzureKinect,
    /// RealSense D400: 0.08 pixels of disparity, shared by neighbours within 4 pixels.
    D400,
}

/// Standard deviation of a depth reading by its depth, and how far neighbours share it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DepthNoise {
    /// a, b and c of a + b z + c z², metres.
    pub(crate) law: [f64; 3],
    /// Pixels over which neighbours share their error; 1 for independent ones.
    pub(crate) correlation_px: f64,
}

impl DepthNoise {
    /// Standard deviation of a reading at depth `z`, metres; at least a tenth of a millimetre.
    #[inline]
    pub(crate) fn sigma(&self, z: f64) -> f64 {
        let [a, b, c] = self.law;
        (a + z * (b + z * c)).max(1e-4)
    }
}

/// Least difference of depth between neighbours that belong to different things, metres.
const LEAST_JUMP_M: f64 = 0.008;

/// Difference of depth, metres, above which two neighbouring readings belong to different things: `factor` times the
/// standard deviation `sigma` of one reading, at least 8 mm.
pub(crate) fn depth_jump_m(sigma: f64, factor: f64) -> f64 {
    (factor * sigma).max(LEAST_JUMP_M)
}

impl SensorPreset {
    pub(crate) fn noise(self) -> DepthNoise {
        let (law, correlation_px) = match self {
            Self::Generic => ([0.0005, 0.0, 0.0014], 1.0),
            Self::Paper => ([0.0, 0.0, 0.001_562_5], 1.0),
            Self::Kinect => ([0.001_504, -0.001_52, 0.0019], 1.0),
            Self::AzureKinect => ([0.0007, 0.0008, 0.0], 1.0),
            Self::D400 => ([0.0, 0.0, 0.001_447], 2.0),
        };
        DepthNoise {
            law,
            correlation_px,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_are_the_cited_ones() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(near(SensorPreset::Paper.noise().sigma(0.8), 0.001));
        assert!(near(SensorPreset::Kinect.noise().sigma(1.4), 0.0031));
        assert!(near(SensorPreset::AzureKinect.noise().sigma(1.0), 0.0015));
        assert!(near(SensorPreset::D400.noise().sigma(1.0), 0.001_447));
        assert!(SensorPreset::Paper.noise().sigma(0.0) > 0.0);
    }
}
