use crate::error::EvaluateError;
use pomona_cloud::Frame;
use pomona_scenes::{Case, Orientation, Scene, Suite, TRUTH_FILE, Truth};
use std::path::{Path, PathBuf};

/// What stands between the name of a suite and the first seed of another draw of it.
const DRAW: char = '@';

/// Largest first seed that is taken: more would take long to count up to.
const LARGEST_SEED: usize = 100_000_000;

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
        Self::drawn_anew(suite, 0, count)
    }

    /// The same from the scene seed `first` on: scenes like the suite's own that nobody has looked at, where methods
    /// were fitted to those. They are counted under `SUITE@first`.
    pub fn drawn_anew(suite: Suite, first: usize, count: Option<usize>) -> Vec<Self> {
        // A seed of the lab is one draw of all orientations.
        let of_a_seed = match suite {
            Suite::Lab15 | Suite::Lab150 => Orientation::PAPER.len(),
            _ => 1,
        };
        let begin = first.saturating_mul(of_a_seed);
        let end = begin.saturating_add(count.unwrap_or(suite.len()));
        let name = match first {
            0 => suite.name().to_owned(),
            _ => format!("{}{DRAW}{first}", suite.name()),
        };
        let subject = |case: Case| Self {
            suite: name.clone(),
            name: case.name.clone(),
            source: Source::Case(case),
        };
        suite.cases_to(end).skip(begin).map(subject).collect()
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

    /// What `name` stands for: a suite's cases, those of another draw of it, or the frames of a folder.
    ///
    /// `orchard@1000` is the suite `orchard` with the scene seeds from 1000 on. A suite's name wins over a folder
    /// of the same name; write `./NAME` for the folder.
    ///
    /// # Errors
    ///
    /// [`EvaluateError::UnknownSubject`] where it is neither; otherwise as [`Subject::of_folder`].
    pub fn named(name: &str, count: Option<usize>) -> Result<Vec<Self>, EvaluateError> {
        if let Ok(suite) = Suite::named(name) {
            return Ok(Self::of_suite(suite, count));
        }
        if let Some((suite, first)) = name.split_once(DRAW)
            && let (Ok(suite), Ok(first)) = (Suite::named(suite), first.parse())
            && first <= LARGEST_SEED
        {
            return Ok(Self::drawn_anew(suite, first, count));
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
            Source::Folder(path) => Ok(Scene::new(Frame::read(path)?, Truth::read(path)?)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(name: &str, count: usize) -> Vec<(String, String)> {
        let subjects = Subject::named(name, Some(count)).unwrap();
        subjects.into_iter().map(|s| (s.suite, s.name)).collect()
    }

    #[test]
    fn another_draw_goes_on_from_its_seed_and_says_so() {
        let own = |suite: &str, name: &str| (suite.to_owned(), name.to_owned());
        assert_eq!(
            names("orchard@1000", 2),
            [
                own("orchard@1000", "orchard-1000"),
                own("orchard@1000", "orchard-1001")
            ]
        );
        assert_eq!(names("orchard", 2), names("orchard@0", 2));
        assert_eq!(names("lab15@3", 1), [own("lab15@3", "lab-x-90-s3")]);
        assert_eq!(
            Subject::named("row@40", None).unwrap().len(),
            Suite::Row.len()
        );
    }

    #[test]
    fn the_scenes_of_another_draw_are_those_of_its_seeds() {
        let anew = Subject::named("lab15@2", Some(1)).unwrap()[0]
            .load()
            .unwrap();
        let own = Suite::Lab15.cases_to(31).nth(30).unwrap().scene();
        assert_eq!(anew.truth.seed, own.truth.seed);
        assert_eq!(anew.frame.depth, own.frame.depth);
    }

    #[test]
    fn nonsense_is_no_draw() {
        for name in [
            "orchard@",
            "orchard@x",
            "orchard@-1",
            "orchart@3",
            "orchard@3@4",
        ] {
            let refused = Subject::named(name, None).unwrap_err().to_string();
            assert!(refused.contains(name), "{refused}");
        }
    }
}
