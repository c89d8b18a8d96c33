use thiserror::Error;

/// A setting that makes no sense, or a file that is not one of settings.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// The file could not be read.
    #[error("settings '{path}': {source}; give the path of a TOML file")]
    Read {
        /// The file.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// It is not TOML, or has a name or type that settings do not have.
    #[error("settings '{path}': {source}")]
    Parse {
        /// The file.
        path: String,
        /// Where and why.
        source: Box<toml::de::Error>,
    },
    /// A value outside of what makes sense.
    #[error("setting {name} = {value}: it must be {rule}")]
    Value {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: String,
        /// What is asked of it.
        rule: &'static str,
    },
}

pub(crate) fn require(
    ok: bool,
    name: &'static str,
    value: impl std::fmt::Display + Copy,
    rule: &'static str,
) -> Result<(), ConfigError> {
    if ok {
        Ok(())
    } else {
        Err(ConfigError::Value {
            name,
            value: value.to_string(),
            rule,
        })
    }
}
