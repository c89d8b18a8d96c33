use strsim::levenshtein;

/// Names that are offered at most.
const OFFERED: usize = 3;

/// The names that are most like `wanted`, best first, three at most and each in backquotes; all of them where there
/// are no more, so that a message always has something to offer.
pub fn nearest(wanted: &str, names: &[&str]) -> String {
    let wanted = wanted.to_lowercase();
    let mut ranked: Vec<(usize, &str)> = names
        .iter()
        .map(|name| (levenshtein(&wanted, &name.to_lowercase()), *name))
        .collect();
    ranked.sort_unstable();
    let offered: Vec<String> = ranked
        .iter()
        .take(OFFERED)
        .map(|(_, name)| format!("`{name}`"))
        .collect();
    offered.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_changes_are_near() {
        let names = ["person", "orange", "apple", "maple", "banana"];
        assert_eq!(nearest("Aple", &names), "`apple`, `maple`, `orange`");
        assert_eq!(nearest("x", &[]), "");
    }
}
