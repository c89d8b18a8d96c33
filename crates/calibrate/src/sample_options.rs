use crate::rotation_form::RotationForm;
use crate::units::{AngleUnit, LengthUnit};

/// What is known about a file of samples beside it; what is not said is told by the file, or assumed with a warning.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SampleOptions {
    /// How rotations are written.
    pub rotations: Option<RotationForm>,
    /// What lengths count.
    pub lengths: Option<LengthUnit>,
    /// What angles count.
    pub angles: Option<AngleUnit>,
}
