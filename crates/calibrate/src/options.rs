use crate::CalibrateError;

/// Settings of a calibration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Distance from the camera to the fruit, m: where the error matters, straight ahead. 0.8 by default.
    pub fruit_distance_m: f64,
    /// How far a sample may be off in place and still support a hypothesis, m: several times the noise.
    /// 0.01 by default.
    pub translation_tolerance_m: f64,
    /// The same for a target's rotation, rad; point pairs have none. 2° by default.
    pub rotation_tolerance_rad: f64,
    /// Hypotheses of the search, each from a sample of three. 500 by default, which for fifteen samples
    /// is about as many as there are.
    pub hypotheses: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            fruit_distance_m: 0.8,
            translation_tolerance_m: 0.01,
            rotation_tolerance_rad: 2.0_f64.to_radians(),
            hypotheses: 500,
        }
    }
}

impl Options {
    pub(crate) fn check(&self) -> Result<(), CalibrateError> {
        for (setting, value) in [
            ("fruit_distance_m", self.fruit_distance_m),
            ("translation_tolerance_m", self.translation_tolerance_m),
            ("rotation_tolerance_rad", self.rotation_tolerance_rad),
            ("hypotheses", f64::from(self.hypotheses)),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(CalibrateError::Setting { setting, value });
            }
        }
        Ok(())
    }
}
