//! Several frames of one tree: places that are better than each frame's, sway told from moved fruit, and what is refused.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on should fail where it stands"
)]

mod drawn_tree;
mod orchard_views;
mod trials;
