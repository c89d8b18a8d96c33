use crate::field::Field;
use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What `xtask/regress.toml` holds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The runs, in the order in which they are made.
    #[serde(rename = "suite")]
    pub suites: Vec<SuiteLimits>,
    /// Runs over real frames, made where the frames are at hand.
    #[serde(default)]
    pub real: Vec<RealLimits>,
}

/// One run over real frames: what is given to it, and what is asked of its methods.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RealLimits {
    /// Name of the run.
    pub name: String,
    /// Folders of the frames, relative to the project; the run is left out where one is not there.
    pub frames: Vec<PathBuf>,
    /// The strokes of their wood.
    pub strokes: PathBuf,
    /// Which apples' wood is seen.
    pub apples: PathBuf,
    /// What tells wood: `none`, `built-in` or a model.
    pub segmenter: String,
    /// Number of perturbed copies of each frame.
    pub repeats: usize,
    /// Settings of methods that are variants, named by their files.
    #[serde(default)]
    pub variants: Vec<PathBuf>,
    /// What is asked of each method or variant: floors and ceilings, since there are no goldens of real frames.
    #[serde(rename = "method")]
    pub methods: Vec<SuiteLimits>,
}

/// One run: a suite under a method, and what is asked of it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SuiteLimits {
    /// Name of the suite.
    pub name: String,
    /// Name of the method.
    pub method: String,
    /// Only so many cases, from the first.
    pub count: Option<usize>,
    /// Seed of the method.
    #[serde(default)]
    pub seed: u64,
    /// Run only by `--full`.
    #[serde(default)]
    pub full: bool,
    /// The fields that count, by their names in [`super::FIELDS`].
    pub fields: BTreeMap<String, FieldLimits>,
}

/// What is asked of one field, in the unit of its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldLimits {
    /// It may not be less.
    pub floor: Option<f64>,
    /// It may not be more.
    pub ceiling: Option<f64>,
    /// It may not be worse than the golden value by more than this.
    pub tolerance: Option<f64>,
}

impl Limits {
    /// Reads and checks the file.
    ///
    /// # Errors
    ///
    /// Where it cannot be read, and as [`Limits::parse`].
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .with_context(|| format!("cannot read {}", path.display()))?;
        Self::parse(&text).with_context(|| path.display().to_string())
    }

    /// Reads the text of such a file and checks it.
    ///
    /// # Errors
    ///
    /// Where it is not TOML of this form, names a field that there is not, or limits one in no way or by nonsense.
    pub fn parse(text: &str) -> Result<Self> {
        let limits: Self = toml::from_str(text)?;
        let real = limits.real.iter().flat_map(|real| &real.methods);
        for field in real.clone().flat_map(|method| method.fields.values()) {
            ensure!(
                field.tolerance.is_none(),
                "real frames have no goldens, and so no tolerance"
            );
        }
        let runs: Vec<&SuiteLimits> = limits.suites.iter().chain(real).collect();
        for (i, suite) in runs.iter().enumerate() {
            let id = suite.id();
            let twice = runs[i + 1..].iter().any(|other| other.id() == id);
            ensure!(!twice, "{id} is given twice");
            ensure!(!suite.fields.is_empty(), "{id}: no field is limited");
            for (name, field) in &suite.fields {
                ensure!(
                    Field::named(name).is_some(),
                    "{id}: there is no field `{name}`"
                );
                let all = [field.floor, field.ceiling, field.tolerance];
                ensure!(
                    all.iter().any(Option::is_some),
                    "{id}: `{name}` is not limited"
                );
                ensure!(
                    all.iter().flatten().all(|v| v.is_finite()),
                    "{id}: `{name}` is not a number"
                );
                ensure!(
                    field.tolerance.is_none_or(|t| t >= 0.0),
                    "{id}: `{name}` has a negative tolerance"
                );
                let empty = field
                    .floor
                    .zip(field.ceiling)
                    .is_some_and(|(low, high)| low > high);
                ensure!(!empty, "{id}: `{name}` has its floor above its ceiling");
            }
        }
        Ok(limits)
    }
}

impl SuiteLimits {
    /// Suite and method, as one word.
    pub fn id(&self) -> String {
        format!("{}.{}", self.name, self.method)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn real_frames_have_limits_without_tolerance() {
        let text = |limit: &str| {
            format!(
                "suite = []\n[[real]]\nname = \"r\"\nframes = [\"a\"]\nstrokes = \"s\"\napples = \"c\"\n\
                 segmenter = \"none\"\nrepeats = 2\n[[real.method]]\nname = \"r\"\nmethod = \"paper\"\n\
                 [real.method.fields]\nright_of_answers_share = {limit}\n"
            )
        };
        let limits = Limits::parse(&text("{ floor = 0.2 }")).unwrap();
        assert_eq!(limits.real[0].methods[0].id(), "r.paper");
        let refused = Limits::parse(&text("{ tolerance = 0.2 }")).unwrap_err();
        assert!(refused.to_string().contains("goldens"), "{refused}");
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        for (fields, part) in [
            ("angle_men_deg = { ceiling = 1 }", "angle_men_deg"),
            ("angle_mean_deg = {}", "not limited"),
            ("angle_mean_deg = { ceiling = nan }", "not a number"),
            ("angle_mean_deg = { tolerance = -1 }", "negative"),
            (
                "angle_mean_deg = { floor = 2, ceiling = 1 }",
                "above its ceiling",
            ),
            ("angle_mean_deg = { roof = 2 }", "roof"),
            ("", "no field"),
        ] {
            let text =
                format!("[[suite]]\nname = \"a\"\nmethod = \"m\"\n[suite.fields]\n{fields}\n");
            let message = format!("{:#}", Limits::parse(&text).unwrap_err());
            assert!(message.contains(part), "{fields}: {message}");
        }
    }
}
