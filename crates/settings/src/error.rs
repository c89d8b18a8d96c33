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
    /// It is not TOML.
    #[error("settings '{path}': {source}")]
    Parse {
        /// The file.
        path: String,
        /// Where and why.
        source: Box<toml::de::Error>,
    },
    /// A name or value in a file that is none of the settings.
    #[error("settings {place}: {source}")]
    InFile {
        /// The file, and the line where it has one for the setting.
        place: String,
        /// What is wrong there.
        source: Box<ConfigError>,
    },
    /// A name that no setting has.
    #[error("no setting is called `{name}`; {help}")]
    Unknown {
        /// The name.
        name: String,
        /// Which names are like it, or which ones there are.
        help: String,
    },
    /// A value of another kind than its setting.
    #[error("setting {name} = {value}: it must be {kind}")]
    Type {
        /// The setting's name.
        name: String,
        /// The value.
        value: String,
        /// What it should be.
        kind: String,
    },
    /// A value outside of what makes sense.
    #[error("setting {name} = {value}: it must be {rule}")]
    Value {
        /// The setting's name.
        name: String,
        /// Its value.
        value: String,
        /// What is asked of it.
        rule: String,
    },
}
