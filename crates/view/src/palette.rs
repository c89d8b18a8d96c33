//! The colours of the paper's figures (Gao et al. 2022, doi 10.3390/agriculture12081170),
//! as 8-bit RGB; the paper names them, the exact shades are ours.

/// Box of an apple: blue.
pub const BOX: [u8; 3] = [40, 120, 255];
/// Points of an apple's surface: pink.
pub const SURFACE: [u8; 3] = [255, 90, 190];
/// Points of a branch: green.
pub const BRANCH: [u8; 3] = [30, 235, 60];
/// Picking direction: red.
pub const DIRECTION: [u8; 3] = [235, 15, 25];
/// Path of the gripper: yellow.
pub const PATH: [u8; 3] = [255, 222, 0];
/// The gripper at the apple: pale blue, which the paper does not draw.
pub const GRIPPER: [u8; 3] = [150, 235, 255];
/// All other points of a cloud: grey.
pub const REST: [u8; 3] = [150, 150, 150];
/// Box of a refused apple: orange, which the paper does not draw.
pub const REFUSED: [u8; 3] = [255, 150, 20];
/// Outline of a fitted sphere: white, which the paper does not draw.
pub const SPHERE: [u8; 3] = [255, 255, 255];

/// Background of a label.
pub(crate) const BACKGROUND: [u8; 3] = [20, 22, 28];
/// Text of a label, and the rim that sets an arrow off from a red apple.
pub(crate) const TEXT: [u8; 3] = [255, 255, 255];
