//! Files of samples.

mod checks;
mod columns;
mod csv_form;
mod json_form;
mod yaml_form;

use crate::{SampleOptions, SampleSet};
use pomona_files::{FileError, Malformed};
use std::path::Path;

impl SampleSet {
    /// Reads a file: as JSON where it begins with a brace and has a schema, as YAML where it is of a program of ROS, and
    /// as CSV otherwise.
    ///
    /// # Errors
    ///
    /// [`FileError::Read`]; [`FileError::Malformed`] for what is not of the form above, with the line, or the sample
    /// and the field.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, FileError> {
        Self::read_with(path, &SampleOptions::default())
    }

    /// As [`SampleSet::read`], with what is known about units and rotations beside the file. It holds for CSV: the other
    /// forms say it themselves.
    ///
    /// # Errors
    ///
    /// As [`SampleSet::read`]; [`FileError::Malformed`] also where the options contradict the file.
    pub fn read_with(path: impl AsRef<Path>, options: &SampleOptions) -> Result<Self, FileError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        let first = bytes.iter().find(|b| !b.is_ascii_whitespace());
        let yaml = std::str::from_utf8(&bytes)
            .ok()
            .map(|text| text.trim_start_matches('\u{feff}'))
            .filter(|text| !text.contains("\"schema\"") && yaml_form::is_yaml(text));
        let says_more = *options != SampleOptions::default();
        let parsed = if says_more && (yaml.is_some() || first == Some(&b'{')) {
            Err(Malformed::new(
                "options",
                "units and rotations are named, and this form has its own",
                "leave the options out: they are for CSV",
            ))
        } else if let Some(text) = yaml {
            yaml_form::parse(text)
        } else if first == Some(&b'{') {
            json_form::parse(&bytes)
        } else {
            csv_form::parse(&bytes, options)
        };
        let mut set = parsed.map_err(|fault| fault.at(path))?;
        let warnings = std::mem::take(&mut set.warnings).into_iter();
        set.warnings = warnings.map(|warning| warning.in_file(path)).collect();
        Ok(set)
    }
}
