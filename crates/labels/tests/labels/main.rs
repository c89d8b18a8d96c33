//! Data sets, detections measured on them, and average precision beside that of another program.

#![expect(
    clippy::unwrap_used,
    reason = "the functions that tests share are tests too"
)]

mod datasets;
mod detection;
mod pycocotools;
mod segmentation;
