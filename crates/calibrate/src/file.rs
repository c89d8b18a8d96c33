//! Files of samples.

mod checks;
mod csv_form;
mod json_form;

use crate::SampleSet;
use pomona_files::FileError;
use std::path::Path;

impl SampleSet {
    /// Reads a file, as JSON where it begins with a brace and as CSV otherwise.
    ///
    /// # Errors
    ///
    /// [`FileError::Read`]; [`FileError::Malformed`] for what is not of the form above, with the line, or the sample
    /// and the field.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, FileError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        let first = bytes.iter().find(|b| !b.is_ascii_whitespace());
        let parsed = if first == Some(&b'{') {
            json_form::parse(&bytes)
        } else {
            csv_form::parse(&bytes)
        };
        parsed.map_err(|fault| fault.at(path))
    }
}
