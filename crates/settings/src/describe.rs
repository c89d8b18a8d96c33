use crate::kind::joined;
use crate::{ConfigError, Setting};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A struct that [`settings!`](crate::settings) declares.
pub trait Settings: Default + Serialize + DeserializeOwned {
    /// Adds its settings, whose paths start with `prefix`, to the description.
    fn describe(prefix: &str, description: &mut Description);

    /// Checks every setting; `prefix` goes before their names.
    ///
    /// # Errors
    ///
    /// [`ConfigError::Value`] for the first one that breaks a rule.
    fn check(&self, prefix: &str) -> Result<(), ConfigError>;
}

/// A section of settings.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Section {
    /// The names of the sections that it stands in and its own, with dots between them.
    pub path: String,
    /// What its settings are for.
    pub meaning: String,
}

/// All sections and settings of a declaration, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Description {
    /// The sections.
    pub sections: Vec<Section>,
    /// The settings, those without a section first.
    pub settings: Vec<Setting>,
}

impl Description {
    /// That of a struct of settings.
    pub fn of<T: Settings>() -> Self {
        let mut description = Self::default();
        T::describe("", &mut description);
        description
    }

    /// The setting at `path`.
    pub fn setting(&self, path: &str) -> Option<&Setting> {
        self.settings.iter().find(|s| s.path == path)
    }

    /// Adds a section.
    #[doc(hidden)]
    pub fn add_section(&mut self, path: String, docs: &[&str]) {
        let meaning = joined(docs);
        self.sections.push(Section { path, meaning });
    }

    /// Adds what is asked of the setting at `path` beside others.
    #[doc(hidden)]
    pub fn relate(&mut self, path: &str, relation: String) {
        let setting = self.settings.iter_mut().find(|s| s.path == path);
        if let Some(setting) = setting {
            setting.relations.push(relation);
        }
    }
}
