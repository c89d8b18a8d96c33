//! What `fuse` makes of trees whose truth is known.

#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot go on should fail where it stands"
)]

mod drawn_tree;
mod every_setting;
mod orchard_views;
mod trials;
