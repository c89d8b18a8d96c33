use pomona_report::plot::{BLUE, GRAY, RED, Rgb};

/// Our results.
pub(super) const OURS: Rgb = RED;
/// The paper's.
pub(super) const PAPER: Rgb = BLUE;
/// Single apples behind their means, and lines of reference.
pub(super) const FAINT: Rgb = GRAY;
