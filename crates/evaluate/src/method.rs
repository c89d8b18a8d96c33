use pomona::{PickError, Picker, Record};
use pomona_cloud::Frame;

/// What can be evaluated: something that answers a frame.
///
/// A [`Picker`] is one; tests wrap it to see whether a broken method is caught.
pub trait PickMethod: Sync {
    /// Its name in tables and files.
    fn name(&self) -> &str;

    /// The answers for the boxes of a frame, in the camera's frame.
    ///
    /// # Errors
    ///
    /// Where the frame cannot be worked on at all.
    fn answer(&self, frame: &Frame, seed: u64) -> Result<Record, PickError>;
}

impl PickMethod for Picker {
    fn name(&self) -> &str {
        self.config().method.name()
    }

    fn answer(&self, frame: &Frame, seed: u64) -> Result<Record, PickError> {
        Ok(self.pick(frame, seed, None)?.record)
    }
}
