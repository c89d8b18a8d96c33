use std::fmt;

/// What a setting holds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// `true` or `false`.
    Flag,
    /// A whole number, 0 or more.
    Count,
    /// A number.
    Number,
    /// So many numbers.
    Numbers(usize),
    /// One of these words.
    Choice(&'static [Choice]),
}

impl Kind {
    /// Whether a value is of this kind.
    pub fn accepts(self, value: &toml::Value) -> bool {
        let number = |value: &toml::Value| value.is_float() || value.is_integer();
        match self {
            Self::Flag => value.is_bool(),
            Self::Count => value.as_integer().is_some_and(|n| n >= 0),
            Self::Number => number(value),
            Self::Numbers(length) => value
                .as_array()
                .is_some_and(|all| all.len() == length && all.iter().all(number)),
            Self::Choice(choices) => {
                let word = value.as_str();
                choices.iter().any(|choice| word == Some(choice.name))
            }
        }
    }
}

/// In words that follow 'it must be'.
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag => f.write_str("true or false"),
            Self::Count => f.write_str("a whole number, 0 or more"),
            Self::Number => f.write_str("a number"),
            Self::Numbers(length) => write!(f, "a list of {length} numbers"),
            Self::Choice(choices) => {
                let names: Vec<&str> = choices.iter().map(|choice| choice.name).collect();
                write!(f, "one of {}", names.join(", "))
            }
        }
    }
}

/// One word that a setting may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The word.
    pub name: &'static str,
    /// The lines of its documentation.
    pub docs: &'static [&'static str],
}

impl Choice {
    /// What it stands for.
    pub fn meaning(&self) -> String {
        joined(self.docs)
    }
}

/// Lines of documentation as one.
pub(crate) fn joined(docs: &[&str]) -> String {
    let words = docs.iter().flat_map(|line| line.split_whitespace());
    words.collect::<Vec<_>>().join(" ")
}
