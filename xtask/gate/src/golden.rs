use crate::field::Field;
use crate::limits::SuiteLimits;
use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Name and version of the form of [`Golden`].
pub const GOLDEN_SCHEMA: &str = "pomona.golden/1";

/// What the last blessed run of a suite gave, in metres and radians.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Golden {
    /// [`GOLDEN_SCHEMA`].
    pub schema: String,
    /// Suite.
    pub suite: String,
    /// Method.
    pub method: String,
    /// Seed of the method.
    pub seed: u64,
    /// Frames.
    pub cases: u64,
    /// The limited fields, by their place in the suite's result.
    pub values: BTreeMap<String, f64>,
}

impl Golden {
    /// Takes the limited fields out of a suite's result.
    ///
    /// # Errors
    ///
    /// Where the result lacks its number of cases.
    pub fn of(result: &Value, limits: &SuiteLimits) -> Result<Self> {
        let cases = result
            .get("cases")
            .and_then(Value::as_u64)
            .context("a result without `cases`")?;
        let fields = limits.fields.keys().filter_map(|name| Field::named(name));
        Ok(Self {
            schema: GOLDEN_SCHEMA.to_owned(),
            suite: limits.name.clone(),
            method: limits.method.clone(),
            seed: limits.seed,
            cases,
            values: fields.flat_map(|field| field.values(result)).collect(),
        })
    }

    /// Reads the golden of a run; `None` where there is none.
    ///
    /// # Errors
    ///
    /// Where the file is there and is not one.
    pub fn read(folder: &Path, limits: &SuiteLimits) -> Result<Option<Self>> {
        let path = Self::path(folder, limits);
        if !path.exists() {
            return Ok(None);
        }
        let what = || path.display().to_string();
        let golden: Self =
            serde_json::from_str(&std::fs::read_to_string(&path).with_context(what)?)
                .with_context(what)?;
        ensure!(
            golden.schema == GOLDEN_SCHEMA,
            "{}: its schema is `{}`",
            what(),
            golden.schema
        );
        Ok(Some(golden))
    }

    /// Writes it where [`Golden::read`] finds it.
    ///
    /// # Errors
    ///
    /// Where the file cannot be written.
    pub fn write(&self, folder: &Path, limits: &SuiteLimits) -> Result<()> {
        let path = Self::path(folder, limits);
        let text = serde_json::to_string_pretty(self)? + "\n";
        std::fs::create_dir_all(folder)
            .and_then(|()| std::fs::write(&path, text))
            .with_context(|| path.display().to_string())
    }

    fn path(folder: &Path, limits: &SuiteLimits) -> std::path::PathBuf {
        folder.join(limits.id() + ".json")
    }
}
