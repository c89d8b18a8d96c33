//! What samples are checked for in either form.

use pomona_files::Malformed;
use pomona_transforms::TransformError;

/// Refuses ids that are empty or given twice; `place` is where each is given.
pub(super) fn check_ids(ids: &[(String, &str)]) -> Result<(), Malformed> {
    let mut seen = std::collections::HashMap::new();
    for (place, id) in ids {
        if id.trim().is_empty() {
            return Err(Malformed::new(
                place.as_str(),
                "the id is empty",
                "give each sample an id of its own",
            ));
        }
        if let Some(first) = seen.insert(*id, place) {
            return Err(Malformed::new(
                place.as_str(),
                format!("the id `{id}` is given at {first} already"),
                "give each sample an id of its own",
            ));
        }
    }
    Ok(())
}

/// What is wrong with the numbers of a transform, at a place of the file.
pub(super) fn not_rigid(place: impl Into<String>, error: &TransformError) -> Malformed {
    let text = error.to_string();
    let (problem, remedy) = text.split_once("; ").unwrap_or((&text, "copy all digits"));
    Malformed::new(place, problem, remedy)
}
