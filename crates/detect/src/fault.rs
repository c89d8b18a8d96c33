use crate::DetectError;

/// What is wrong at a place of a model or of its description, before the file's name is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    pub(crate) place: String,
    pub(crate) problem: String,
    pub(crate) remedy: String,
}

impl Fault {
    pub(crate) fn new(
        place: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            place: place.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// The error, in the model or description of this name.
    pub(crate) fn at(self, model: impl Into<String>) -> DetectError {
        DetectError::Model {
            model: model.into(),
            place: self.place,
            problem: self.problem,
            remedy: self.remedy,
        }
    }
}
