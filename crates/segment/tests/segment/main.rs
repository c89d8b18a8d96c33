//! Segmenters over images: tiles, classes, hostile networks, the built-in model.

#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot go on should fail where it stands"
)]

mod built_in;
mod fake_network;
mod hostile;
mod places;
mod tiles;
