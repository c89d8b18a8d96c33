//! Names that no setting has, answered by those that are like them.

use crate::{ConfigError, Description};

/// Likeness from which on a name is offered: 1 for equal ones.
const ALIKE: f64 = 0.7;

/// Names that are offered at most.
const OFFERED: usize = 3;

/// The error for `name`, with the names of settings that are like it.
pub(crate) fn unknown(name: &str, description: &Description) -> ConfigError {
    let inside = format!("{name}.");
    let known = || description.settings.iter().map(|s| s.path.as_str());
    let section: Vec<&str> = known().filter(|path| path.starts_with(&inside)).collect();
    let help = if section.is_empty() {
        let alike = alike(name, known());
        if alike.is_empty() {
            format!("there are {}", known().collect::<Vec<_>>().join(", "))
        } else {
            let quoted: Vec<String> = alike.iter().map(|path| format!("`{path}`")).collect();
            format!("did you mean {}?", quoted.join(" or "))
        }
    } else {
        format!("it is a section, with {}", section.join(", "))
    };
    ConfigError::Unknown {
        name: name.to_owned(),
        help,
    }
}

/// Those of `known` that are most like `name`, best first. Where some have its last part in another section, those
/// alone.
fn alike<'k>(name: &str, known: impl Iterator<Item = &'k str> + Clone) -> Vec<&'k str> {
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let own = last(name);
    let moved: Vec<&str> = known.clone().filter(|path| last(path) == own).collect();
    if !moved.is_empty() {
        return moved.into_iter().take(OFFERED).collect();
    }
    let mut scored: Vec<(f64, &str)> = known
        .map(|path| {
            let whole = strsim::normalized_damerau_levenshtein(name, path);
            let part = strsim::jaro_winkler(&own, &last(path));
            (whole.max(0.95 * part), path)
        })
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .collect();
    // A stable order, so that equals stay as they are declared.
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    let offered = scored.into_iter().take(OFFERED);
    offered.map(|(_, path)| path).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [&str; 5] = [
        "method",
        "fruit.radius_max_m",
        "paper.shell_inner",
        "paper.shell_outer",
        "robust.branch_radius_max_m",
    ];

    fn nearest(name: &str) -> Vec<&'static str> {
        alike(name, KNOWN.into_iter())
    }

    #[test]
    fn the_most_like_comes_first() {
        assert_eq!(nearest("metod"), ["method"]);
        assert_eq!(nearest("paper.shel_outer")[0], "paper.shell_outer");
        assert!(nearest("shell").contains(&"paper.shell_inner"));
        assert!(nearest("xyzzy").is_empty());
    }

    #[test]
    fn a_name_of_another_section_is_found() {
        assert_eq!(nearest("shell_outer"), ["paper.shell_outer"]);
        assert_eq!(nearest("paper.radius_max_m"), ["fruit.radius_max_m"]);
    }
}
