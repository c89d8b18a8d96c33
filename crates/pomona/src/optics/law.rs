//! The standard deviation of a depth reading as a function of its depth.

/// a, b and c of a + b z + c z², metres: that of no camera in particular.
pub(super) const GENERIC: [f64; 3] = [0.0005, 0.0, 0.0014];

/// Standard deviation at depth `z` by a law, metres; at least a tenth of a millimetre.
#[inline]
pub(super) fn sigma([a, b, c]: [f64; 3], z: f64) -> f64 {
    (a + z * (b + z * c)).max(1e-4)
}
