//! The proof that every setting has a reader.

use crate::{Description, Setting, Settings, set};
use toml::Value;

/// Something that is answered under some settings; a test states several, so that each setting matters in one.
pub struct Situation<'a, T> {
    base: T,
    about: &'a [&'a str],
    answer: Box<dyn Fn(&T) -> String + 'a>,
}

impl<'a, T: Settings> Situation<'a, T> {
    /// `answer` is everything that is answered, as text; `base` are the settings beside the one that is changed.
    pub fn new(base: T, answer: impl Fn(&T) -> String + 'a) -> Self {
        Self {
            base,
            about: &[],
            answer: Box::new(answer),
        }
    }

    /// The same, tried only for settings whose path begins with one of `prefixes`. It saves time.
    #[must_use]
    pub fn about(mut self, prefixes: &'a [&'a str]) -> Self {
        self.about = prefixes;
        self
    }

    fn is_about(&self, path: &str) -> bool {
        self.about.is_empty() || self.about.iter().any(|prefix| path.starts_with(prefix))
    }

    /// Whether a value of `setting` changes the answer from `usual`.
    fn shows(&self, setting: &Setting, special: &[Value], usual: &str) -> bool {
        let changes = |value: Value| {
            let changed = set(&self.base, &setting.path, value);
            changed.is_ok_and(|c| c.check("").is_ok() && (self.answer)(&c) != usual)
        };
        let mut values = special.iter().cloned().chain(setting.other_values());
        values.any(changes)
    }
}

/// The settings, of those that `asked` selects by their path, that change the answer of no situation. `special` has
/// values, as in a settings file, for settings that would not show by a factor, an end of their range or another
/// choice.
///
/// # Panics
///
/// Where `special` names no setting, or its value is no TOML.
#[expect(
    clippy::panic,
    reason = "for tests, which should fail where they are wrong"
)]
pub fn unread<T: Settings>(
    situations: &[Situation<'_, T>],
    special: &[(&str, &str)],
    asked: impl Fn(&str) -> bool,
) -> Vec<String> {
    let description = Description::of::<T>();
    let special: Vec<(&str, Value)> = special
        .iter()
        .map(
            |(path, text)| match (description.setting(path), text.parse()) {
                (Some(_), Ok(value)) => (*path, value),
                (None, _) => panic!("there is no setting {path}"),
                (_, Err(error)) => panic!("{path} = {text}: {error}"),
            },
        )
        .collect();
    let usual: Vec<String> = situations.iter().map(|s| (s.answer)(&s.base)).collect();
    let settings = description.settings.iter().filter(|s| asked(&s.path));
    let is_unread = |setting: &&Setting| {
        let of_this = special.iter().filter(|(path, _)| *path == setting.path);
        let of_this: Vec<Value> = of_this.map(|(_, value)| value.clone()).collect();
        let mut all = situations.iter().zip(&usual);
        !all.any(|(s, usual)| s.is_about(&setting.path) && s.shows(setting, &of_this, usual))
    };
    settings.filter(is_unread).map(|s| s.path.clone()).collect()
}
