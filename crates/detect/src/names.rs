/// The names that are most like `wanted`, best first, three at most and each in backquotes; all of them where there
/// are no more, so that a message always has something to offer.
pub(crate) fn nearest(wanted: &str, names: &[&str]) -> String {
    let wanted = wanted.to_lowercase();
    let mut ranked: Vec<(usize, &str)> = names
        .iter()
        .map(|name| (distance(&wanted, &name.to_lowercase()), *name))
        .collect();
    ranked.sort_unstable();
    let shown: Vec<String> = ranked
        .iter()
        .take(3)
        .map(|(_, name)| format!("`{name}`"))
        .collect();
    shown.join(", ")
}

/// Fewest characters to insert, remove or replace that turn one text into the other (Levenshtein 1966).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, a) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, b) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(a != *b);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_changes_are_near() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("apple", "apple"), 0);
        let names = ["person", "orange", "apple", "maple", "banana"];
        assert_eq!(nearest("Aple", &names), "`apple`, `maple`, `orange`");
        assert_eq!(nearest("x", &[]), "");
    }
}
