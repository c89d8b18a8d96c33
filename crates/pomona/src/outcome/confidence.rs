/// What each number of [`Evidence::confidence_features`](crate::Evidence::confidence_features) is. Lengths are in radii
/// of the apple; all are clipped to the range in which the scenes of the fit have many.
pub const CONFIDENCE_FEATURES: [&str; 7] = [
    "constant 1",
    "log odds of the best candidate being the nearest wood",
    "log odds of its being wood",
    "visible length",
    "log of the standard deviation of the direction",
    "agreement of the spheroid",
    "visible share of the apple",
];
