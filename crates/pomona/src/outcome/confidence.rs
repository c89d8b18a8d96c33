/// What each number of [`Evidence::confidence_features`](crate::Evidence::confidence_features) is. Lengths are in radii
/// of the apple; all are clipped to the range in which the scenes of the fit have many.
pub const CONFIDENCE_FEATURES: [&str; 9] = [
    "constant 1",
    "score of the best candidate",
    "visible length",
    "visible length on its shorter side",
    "margin over the next direction",
    "agreement of the spheroid",
    "visible share of the apple",
    "atypical share of the length",
    "empty share of the length",
];
