use super::law::{self, GENERIC};
use super::quality::DepthQuality;
use crate::config::{RobustConfig, SensorPreset};

/// Standard deviation of a depth reading by its depth, and how far neighbours share it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DepthNoise {
    /// a, b and c of a + b z + c z², metres.
    pub(crate) law: [f64; 3],
    /// Pixels over which neighbours share their error; 1 for independent ones.
    pub(crate) correlation_px: f64,
}

impl DepthNoise {
    /// That of the readings, as the settings state it.
    pub(crate) fn stated(config: &RobustConfig) -> Self {
        let preset = config.sensor.noise();
        Self {
            law: config.noise_m.unwrap_or(preset.law),
            ..preset
        }
    }

    /// The same; of a camera that the settings do not name, as the image tells it.
    pub(crate) fn of(config: &RobustConfig, quality: &DepthQuality) -> Self {
        match (config.sensor, config.noise_m) {
            (SensorPreset::Generic, None) => Self::generic(quality),
            _ => Self::stated(config),
        }
    }

    /// The generic law, and where depth is smeared the level that the image shows.
    fn generic(quality: &DepthQuality) -> Self {
        let preset = SensorPreset::Generic.noise();
        let smear = quality.smear();
        let factor = quality
            .noise
            .unwrap_or(1.0)
            .clamp(LEAST_FACTOR, MOST_FACTOR);
        let factor = 1.0 + smear * (factor - 1.0);
        Self {
            law: preset.law.map(|term| factor * term),
            ..preset
        }
    }

    /// Standard deviation of a reading at depth `z`, metres; at least a tenth of a millimetre.
    #[inline]
    pub(crate) fn sigma(&self, z: f64) -> f64 {
        law::sigma(self.law, z)
    }
}

/// Between these factors of that law an image's noise is believed.
const LEAST_FACTOR: f64 = 0.3;
const MOST_FACTOR: f64 = 3.0;

/// Least difference of depth between neighbours that belong to different things, metres.
const LEAST_JUMP_M: f64 = 0.008;

/// Difference of depth, metres, above which two neighbouring readings belong to different things: `factor` times the
/// standard deviation `sigma` of one reading, at least 8 mm.
pub(crate) fn depth_jump_m(sigma: f64, factor: f64) -> f64 {
    (factor * sigma).max(LEAST_JUMP_M)
}

impl SensorPreset {
    fn noise(self) -> DepthNoise {
        let (law, correlation_px) = match self {
            Self::Generic => (GENERIC, 1.0),
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
