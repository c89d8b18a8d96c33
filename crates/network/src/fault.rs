use crate::error::NetworkError;

/// What is wrong at a place of a model, or of the description beside it, before the file's name is known.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ModelFault {
    /// Where in it: an input, an output, a key.
    pub place: String,
    /// What is wrong there.
    pub problem: String,
    /// What to do about it.
    pub remedy: String,
}

impl ModelFault {
    /// Of these three.
    pub fn new(
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
    pub fn at(self, model: impl Into<String>) -> NetworkError {
        NetworkError::Model {
            model: model.into(),
            place: self.place,
            problem: self.problem,
            remedy: self.remedy,
        }
    }
}
