use std::error::Error;
use std::path::PathBuf;

/// What is compared.
#[derive(Debug, Default)]
pub(crate) struct Arguments {
    /// Names of suites.
    pub(crate) suites: Vec<String>,
    /// Scenes of each; all of its own without.
    pub(crate) count: Option<usize>,
    /// Whether the methods are run too.
    pub(crate) methods: bool,
    /// Settings to be measured as methods.
    pub(crate) variants: Vec<PathBuf>,
    /// Folders of real frames.
    pub(crate) real: Vec<PathBuf>,
    /// Strokes of wood in them.
    pub(crate) strokes: Option<PathBuf>,
    /// Which apples' wood a person sees.
    pub(crate) apples: Option<PathBuf>,
    /// Measured diameters of the apples.
    pub(crate) calipers: Option<PathBuf>,
}

impl Arguments {
    pub(crate) fn parse(words: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
        let mut arguments = Self {
            methods: true,
            ..Self::default()
        };
        let mut real = false;
        let mut words = words.peekable();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(format!("{word} needs a value"));
            match &*word {
                "--count" => arguments.count = Some(value()?.parse()?),
                "--no-methods" => arguments.methods = false,
                "--variant" => arguments.variants.push(value()?.into()),
                "--strokes" => arguments.strokes = Some(value()?.into()),
                "--apples" => arguments.apples = Some(value()?.into()),
                "--calipers" => arguments.calipers = Some(value()?.into()),
                "--real" => real = true,
                other if other.starts_with("--") => {
                    return Err(format!("{other}: there is no such option").into());
                }
                folder if real => arguments.real.push(folder.into()),
                suite => arguments.suites.push(suite.into()),
            }
        }
        if let Some(folder) = arguments.real.iter().find(|folder| !folder.is_dir()) {
            let folder = folder.display();
            return Err(format!(
                "{folder}: there is no such folder; --real takes frames with boxes, which are not part of this project"
            )
            .into());
        }
        if arguments.suites.is_empty() && arguments.real.is_empty() {
            return Err(
                "usage: likeness [--count N] [--no-methods] [--variant FILE] SUITE... \
                        [--real FOLDER... --strokes FILE --apples FILE --calipers FILE]"
                    .into(),
            );
        }
        Ok(arguments)
    }
}
