use crate::kind::joined;
use crate::{ConfigError, Kind, Rule, Value};

/// One setting with everything that its declaration says.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Setting {
    /// The names of its sections and its own, with dots between them.
    pub path: String,
    /// What it holds.
    pub kind: Kind,
    /// What its number counts or measures.
    pub unit: &'static str,
    /// What it is where nothing is said; `None` where it may be left out.
    pub default: Option<toml::Value>,
    /// A value for a setting that may be left out.
    pub example: Option<toml::Value>,
    /// What is asked of its value.
    pub rule: Rule,
    /// What is asked of it beside other settings, in words that follow 'it must be'.
    pub relations: Vec<String>,
    /// What it is, and what more or less of it costs.
    pub meaning: String,
}

impl Setting {
    /// The setting at `path` whose default is `default`; `docs` are the lines of its documentation.
    pub fn new<T: Value>(
        path: String,
        default: &T,
        docs: &[&str],
        unit: &'static str,
        rule: Rule,
    ) -> Self {
        Self {
            path,
            kind: T::KIND,
            unit,
            default: default.to_toml(),
            example: None,
            rule,
            relations: Vec::new(),
            meaning: joined(docs),
        }
    }

    /// The same with an example.
    #[must_use]
    pub fn with_example<T: Value>(mut self, example: &T) -> Self {
        self.example = example.to_toml();
        self
    }

    /// Its section, empty for none, and its own name.
    pub fn section_and_name(&self) -> (&str, &str) {
        self.path.rsplit_once('.').unwrap_or(("", &self.path))
    }

    /// All that is asked of its value, in words that follow 'it must be'; `None` where that is nothing but its kind.
    pub fn rules(&self) -> Option<String> {
        let own = Some(self.rule).filter(|rule| *rule != Rule::Any);
        let own = own.map(|rule| rule.to_string());
        let all: Vec<String> = own.into_iter().chain(self.relations.clone()).collect();
        (!all.is_empty()).then(|| all.join(", and "))
    }

    /// An error for a value of another kind.
    pub(crate) fn accept(&self, value: &toml::Value) -> Result<(), ConfigError> {
        if self.kind.accepts(value) {
            return Ok(());
        }
        Err(ConfigError::Type {
            name: self.path.clone(),
            value: value.to_string(),
            kind: self.kind.to_string(),
        })
    }
}
