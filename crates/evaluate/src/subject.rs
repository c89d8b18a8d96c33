use crate::EvaluateError;
use pomona_cloud::Frame;
use pomona_scenes::{Case, Scene, Suite, TRUTH_FILE, Truth};
use std::path::{Path, PathBuf};

/// One frame to be evaluated, not yet generated or read.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The suite it is counted under.
    pub suite: String,
    /// Its name.
    pub name: String,
    source: Source,
}

#[derive(Clone, Debug)]
enum Source {
    Case(Case),
    Folder(PathBuf),
}

impl Subject {
    /// The first `count` cases of a suite, generated in memory when they are asked for; all of its own
    /// without a count, and further draws where the count is larger.
    pub fn of_suite(suite: Suite, count: Option<usize>) -> Vec<Self> {
        let subject = |case: Case| Self {
            suite: suite.name().to_owned(),
            name: case.name.clone(),
            source: Source::Case(case),
        };
        suite
            .cases_to(count.unwrap_or(suite.len()))
            .map(subject)
            .collect()
    }

    /// The frames of a folder: itself where it holds a `truth.json`, otherwise the folders
    /// in it that do, by name. They are counted under the name of the folder given.
    ///
    /// # Errors
    ///
    /// [`EvaluateError::Io`], and [`EvaluateError::NoTruth`] where nothing knows a truth.
    pub fn of_folder(
        folder: impl AsRef<Path>,
        count: Option<usize>,
    ) -> Result<Vec<Self>, EvaluateError> {
        let folder = folder.as_ref();
        let mut found = Vec::new();
        if folder.join(TRUTH_FILE).is_file() {
            found.push(folder.to_owned());
        } else {
            let io = |source| EvaluateError::Io {
                path: folder.to_owned(),
                source,
            };
            for entry in std::fs::read_dir(folder).map_err(io)? {
                let path = entry.map_err(io)?.path();
                if path.join(TRUTH_FILE).is_file() {
                    found.push(path);
                }
            }
        }
        found.sort();
        if found.is_empty() {
            return Err(EvaluateError::NoTruth {
                path: folder.to_owned(),
            });
        }
        let name = |path: &Path| {
            let name = path.file_name().map(ToOwned::to_owned);
            let name =
                name.or_else(|| path.canonicalize().ok()?.file_name().map(ToOwned::to_owned));
            name.unwrap_or_default().to_string_lossy().into_owned()
        };
        let suite = name(folder);
        let subject = |path: PathBuf| Self {
            suite: suite.clone(),
            name: name(&path),
            source: Source::Folder(path),
        };
        Ok(found
            .into_iter()
            .take(count.unwrap_or(usize::MAX))
            .map(subject)
            .collect())
    }

    /// What `name` stands for: a suite's cases, or the frames of a folder.
    ///
    /// A suite's name wins over a folder of the same name; write `./NAME` for the folder.
    ///
    /// # Errors
    ///
    /// [`EvaluateError::UnknownSubject`] where it is neither; otherwise as [`Subject::of_folder`].
    pub fn named(name: &str, count: Option<usize>) -> Result<Vec<Self>, EvaluateError> {
        if let Ok(suite) = Suite::named(name) {
            return Ok(Self::of_suite(suite, count));
        }
        if Path::new(name).is_dir() {
            return Self::of_folder(name, count);
        }
        let suites = Suite::ALL.iter().map(Suite::name).collect();
        Err(EvaluateError::UnknownSubject {
            name: name.to_owned(),
            suites,
        })
    }

    /// Generates or reads the frame and its truth.
    ///
    /// # Errors
    ///
    /// [`EvaluateError::Frame`] and [`EvaluateError::Scene`] for a folder that cannot be read.
    pub fn load(&self) -> Result<Scene, EvaluateError> {
        match &self.source {
            Source::Case(case) => Ok(case.scene()),
            Source::Folder(path) => Ok(Scene {
                frame: Frame::read(path)?,
                truth: Truth::read(path)?,
            }),
        }
    }
}
