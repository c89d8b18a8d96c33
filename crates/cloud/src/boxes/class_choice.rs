//! Which of the classes that a file or a model names is meant.

use serde::Deserialize;
use std::fmt;

/// A class, by its number or its name.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a class's name or number")]
pub enum ClassChoice {
    /// By its number in the file's or the model's own list.
    Number(usize),
    /// By its name.
    Name(String),
}

impl ClassChoice {
    /// What is looked for where nobody says which class.
    pub const DEFAULT_NAME: &str = "apple";

    /// Which of `names` are called `wanted`: the ones of exactly this name; if there are none, regardless of case; and
    /// if there are none either, those that have all its words, such as `Apple_Ripe` for `apple`.
    ///
    /// Words end at whatever is no letter and before a capital within; a plural counts as its singular. A name that
    /// goes on to a part of the plant or to what befalls it, such as `apple leaf` or `apple_scab`, is another thing.
    pub fn named(wanted: &str, names: &[&str]) -> Vec<usize> {
        let those = |is: &dyn Fn(&str) -> bool| -> Vec<usize> {
            let found = names.iter().enumerate().filter(|(_, name)| is(name));
            found.map(|(index, _)| index).collect()
        };
        let exact = those(&|name| name == wanted);
        if !exact.is_empty() {
            return exact;
        }
        let same = those(&|name| name.trim().eq_ignore_ascii_case(wanted.trim()));
        if !same.is_empty() {
            return same;
        }
        those(&|name| is_kind_of(wanted, name))
    }
}

impl fmt::Display for ClassChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => write!(f, "`{name}`"),
        }
    }
}

/// Words after which a name that has `apple` in it is no longer that of the fruit.
const OTHER_THINGS: [&str; 20] = [
    "leaf", "leave", "tree", "trunk", "branch", "branche", "stem", "stalk", "flower", "blossom",
    "bud", "wood", "twig", "shoot", "disease", "scab", "rust", "tag", "core", "orchard",
];

/// Whether a class called `name` is one of `wanted`, by their words.
pub(super) fn is_kind_of(wanted: &str, name: &str) -> bool {
    let (wanted, name) = (words(wanted), words(name));
    let other = |word: &String| OTHER_THINGS.contains(&word.as_str()) && !wanted.contains(word);
    !wanted.is_empty() && wanted.iter().all(|word| name.contains(word)) && !name.iter().any(other)
}

/// The words of a name in small letters, each in its singular where that is without an `s`.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut after_small = false;
    for c in name.chars() {
        if !c.is_alphabetic() || (c.is_uppercase() && after_small) {
            words.push(String::new());
        }
        after_small = c.is_lowercase();
        if c.is_alphabetic()
            && let Some(word) = words.last_mut()
        {
            word.extend(c.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    for word in &mut words {
        if word.len() > 3 && word.ends_with('s') && !word.ends_with("ss") {
            word.pop();
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_names_come_before_case_and_case_before_words() {
        let named = |names: &[&str]| ClassChoice::named("apple", names);
        assert_eq!(named(&["Apple", "apple", "apple_ripe"]), [1]);
        assert_eq!(named(&["leaf", " APPLE ", "apple_ripe"]), [1]);
        assert_eq!(
            named(&["Leaf", "Apple_Ripe", "Stem", "green apples"]),
            [1, 3]
        );
        assert_eq!(named(&["ripeApple", "AppleRipe", "apple2"]), [0, 1, 2]);
        assert!(named(&["pineapple", "fruit", ""]).is_empty());
        assert!(named(&["apple leaf", "AppleTree", "apple_branches", "apple scab"]).is_empty());
        assert_eq!(
            ClassChoice::named("apple leaf", &["Apple_Leaves", "apple", "Apple-Leaf"]),
            [2]
        );
        assert!(ClassChoice::named("", &["apple"]).is_empty());
    }
}
