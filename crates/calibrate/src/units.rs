/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metres.
    Metres,
    /// Millimetres.
    Millimetres,
}

impl LengthUnit {
    pub(crate) fn metres(self, length: f64) -> f64 {
        match self {
            Self::Metres => length,
            Self::Millimetres => length * 1e-3,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Metres => "metres",
            Self::Millimetres => "millimetres",
        }
    }
}

/// A unit of angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleUnit {
    /// Radians.
    Radians,
    /// Degrees.
    Degrees,
}

impl AngleUnit {
    pub(crate) fn radians(self, angle: f64) -> f64 {
        match self {
            Self::Radians => angle,
            Self::Degrees => angle.to_radians(),
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Radians => "radians",
            Self::Degrees => "degrees",
        }
    }
}
