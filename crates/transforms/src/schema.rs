use nalgebra::Vector3;

/// Name and version of the form of a transform's file.
pub const SCHEMA: &str = "pomona.transform/1";

/// The longest translation that a file may give, in metres: more than an arm on its platform
/// spans, and less than the same in millimetres, taken for metres.
pub const MAX_TRANSLATION_M: f64 = 100.0;

/// The length of a translation that is too long to be in metres, or not finite.
pub(crate) fn excessive_length_m(translation_m: &Vector3<f64>) -> Option<f64> {
    // Finite wherever the length itself is, also where squares are not.
    let length_m = translation_m
        .x
        .hypot(translation_m.y)
        .hypot(translation_m.z);
    let is_plausible = length_m <= MAX_TRANSLATION_M;
    (!is_plausible).then_some(length_m)
}
