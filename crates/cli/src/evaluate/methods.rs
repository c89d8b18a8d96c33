//! The methods and variants that are compared.

use super::arguments::EvaluateArguments;
use anyhow::{anyhow, bail};
use pomona::{CheckedFrame, Config, FrameAnswer, Method, PickError, Picker, RobotFromCamera};
use pomona_evaluate::PickMethod;

/// A method under its settings, and the name that it bears in the result.
pub(super) struct Named {
    name: String,
    pub(super) picker: Picker,
}

impl PickMethod for Named {
    fn name(&self) -> &str {
        &self.name
    }

    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError> {
        self.picker.answer(frame, seed)
    }

    fn answer_for_robot(
        &self,
        frame: &CheckedFrame<'_>,
        seed: u64,
        robot_from_camera: &RobotFromCamera,
    ) -> Result<FrameAnswer, PickError> {
        self.picker.answer_for_robot(frame, seed, robot_from_camera)
    }
}

/// The methods that are asked for, and after them the variants.
pub(super) fn pickers(arguments: &EvaluateArguments) -> anyhow::Result<Vec<Named>> {
    let mut named: Vec<Named> = methods(arguments)?
        .into_iter()
        .map(|picker| Named {
            name: picker.name().to_owned(),
            picker,
        })
        .collect();
    for path in &arguments.variants {
        let stem = path.file_stem().unwrap_or_default();
        let name = stem.to_string_lossy().into_owned();
        if named.iter().any(|other| other.name == name) {
            bail!(
                "--variant {}: `{name}` is given twice; rename the file",
                path.display()
            );
        }
        let picker = Picker::new(Config::read(path)?)?;
        named.push(Named { name, picker });
    }
    Ok(named)
}

fn methods(arguments: &EvaluateArguments) -> anyhow::Result<Vec<Picker>> {
    let config = arguments.settings.config()?;
    if arguments.methods.is_empty() {
        return Ok(vec![Picker::new(config)?]);
    }
    let mut pickers: Vec<Picker> = Vec::new();
    for name in &arguments.methods {
        let method = Method::from_name(name)
            .ok_or_else(|| anyhow!("--method {name}: there is no such method"))?;
        if pickers.iter().any(|p| p.config().method == method) {
            bail!("--method {name} is given twice; give each method once");
        }
        pickers.push(Picker::new(config.clone().with(|c| c.method = method))?);
    }
    Ok(pickers)
}
