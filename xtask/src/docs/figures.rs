//! Figures by their name: each stands in a golden run or in `docs/figures.toml`, and nowhere else.

use super::directive::Directive;
use anyhow::{Context, Result, ensure};
use std::{fs, path::Path};
use xtask_gate::{Field, Golden};

const GOLDENS: &str = "fixtures/golden";
const FIGURES: &str = "docs/figures.toml";
/// What each table of the figures says beside them.
const ORIGIN: [&str; 2] = ["command", "measured"];

/// Golden runs and measured figures.
pub(super) struct Figures {
    goldens: Vec<(String, Golden)>,
    measured: toml::Table,
}

impl Figures {
    pub(super) fn read(root: &Path) -> Result<Self> {
        let mut goldens = Vec::new();
        for entry in fs::read_dir(root.join(GOLDENS)).context(GOLDENS)? {
            let path = entry?.path();
            let what = || path.display().to_string();
            let golden = serde_json::from_str(&fs::read_to_string(&path).with_context(what)?)
                .with_context(what)?;
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            goldens.push((name.into_owned(), golden));
        }
        let path = root.join(FIGURES);
        let text = if path.exists() {
            fs::read_to_string(&path).context(FIGURES)?
        } else {
            String::new()
        };
        let measured = measured(&text).context(FIGURES)?;
        Ok(Self { goldens, measured })
    }

    /// The figure `RUN.FIELD`, with the decimals that are asked for.
    pub(super) fn text(&self, directive: &Directive) -> Result<String> {
        let name = &directive.subject;
        let (run, field) = name
            .rsplit_once('.')
            .with_context(|| format!("`{name}`: a figure is RUN.FIELD"))?;
        if let Some(value) = self.measured.get(run).and_then(|table| table.get(field)) {
            return Ok(match (value.as_str(), number(value)) {
                (None, Some(number)) => decimals(number, directive.decimals),
                (text, _) => text.map_or_else(|| value.to_string(), ToOwned::to_owned),
            });
        }
        let golden = self.goldens.iter().find(|(id, _)| id == run);
        let (_, golden) = golden.with_context(|| {
            format!("no golden run and no table of {FIGURES} is called `{run}`")
        })?;
        let known = Field::named(field).with_context(|| format!("no field `{field}`"))?;
        let value = golden.values.get(known.pointer.trim_start_matches('/'));
        let value = value.with_context(|| format!("{GOLDENS}/{run}.json holds no `{field}`"))?;
        Ok(decimals(value * known.per_si, directive.decimals))
    }
}

fn measured(text: &str) -> Result<toml::Table> {
    let tables: toml::Table = text.parse()?;
    for (name, table) in &tables {
        for key in ORIGIN {
            ensure!(
                table.get(key).is_some_and(toml::Value::is_str),
                "[{name}]: say where the figures come from: {} = \"…\"",
                ORIGIN.join(" = \"…\", ")
            );
        }
    }
    Ok(tables)
}

fn number(value: &toml::Value) -> Option<f64> {
    value
        .as_float()
        .or_else(|| value.as_integer().map(|i| i as f64))
}

fn decimals(number: f64, decimals: Option<usize>) -> String {
    decimals.map_or_else(|| number.to_string(), |n| format!("{number:.n$}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::root;

    fn figure(figures: &Figures, text: &str) -> Result<String> {
        figures.text(&Directive::parse(text).unwrap())
    }

    #[test]
    fn figures_of_golden_runs_are_in_the_unit_of_their_name() {
        let mut figures = Figures::read(root()).unwrap();
        let (_, golden) = figures
            .goldens
            .iter_mut()
            .find(|(id, _)| id == "lab150.robust")
            .unwrap();
        golden.values.insert("angle/error/mean".into(), 0.0067);
        assert_eq!(
            figure(&figures, "lab150.robust.angle_mean_deg; decimals 2").unwrap(),
            "0.38"
        );
        for wrong in ["lab150.angle_mean_deg", "lab150.robust.beauty", "lab150"] {
            assert!(figure(&figures, wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn measured_figures_say_where_they_come_from() {
        let text = "[held-out]\ncommand = \"pomona evaluate orchard\"\nmeasured = \"two cores\"\nangle = 1.25\ncases = 200\n";
        let figures = Figures {
            goldens: Vec::new(),
            measured: measured(text).unwrap(),
        };
        assert_eq!(
            figure(&figures, "held-out.angle; decimals 1").unwrap(),
            "1.2"
        );
        assert_eq!(figure(&figures, "held-out.cases").unwrap(), "200");
        assert_eq!(
            figure(&figures, "held-out.command").unwrap(),
            "pomona evaluate orchard"
        );
        assert!(measured("[a]\nangle = 1.0\n").is_err());
    }
}
