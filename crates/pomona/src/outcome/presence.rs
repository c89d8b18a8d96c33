/// What each number of [`Evidence::presence_features`](crate::Evidence::presence_features) is; all are clipped to the
/// range in which the boxes of the fit have many.
pub const PRESENCE_FEATURES: [&str; 18] = [
    "constant 1",
    "agreement of the spheroid",
    "log of the visible share",
    "lesser curvature, as far as it is known",
    "how far it is known",
    "share of the readings within the outline that are surface",
    "share of the core that is seen through",
    "share of the outline that ends where the spheroid does",
    "what of the box lies beyond the spheroid",
    "radius in standard deviations from the mean",
    "its square",
    "redness of the surface",
    "smear",
    "smear by agreement",
    "smear by the log of the visible share",
    "smear by lesser curvature",
    "smear by share of surface",
    "smear by share of the outline",
];
