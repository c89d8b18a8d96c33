//! What the tests share.

use pomona::{CheckedFrame, Config, FrameAnswer, Method, PickError, Picker};
use pomona_cloud::Frame;

/// A picker with the default settings.
pub(crate) fn picker(method: Method) -> Picker {
    Picker::new(Config::default().with(|c| c.method = method)).unwrap()
}

/// The answers for the boxes of a frame.
pub(crate) fn answer(picker: &Picker, frame: &Frame, seed: u64) -> FrameAnswer {
    try_answer(picker, frame, seed).unwrap()
}

/// The same, or why there are none.
pub(crate) fn try_answer(
    picker: &Picker,
    frame: &Frame,
    seed: u64,
) -> Result<FrameAnswer, PickError> {
    picker.pick(&CheckedFrame::new(frame)?, seed, None)
}
