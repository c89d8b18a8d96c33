use pomona_files::Warning;
use serde::{Deserialize, Serialize};

/// What was assumed about the input, or is doubtful about it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct WarningRecord {
    /// What it is about, for programs; `docs/output.md` explains each.
    #[cfg_attr(test, schemars(extend("enum" = tests::codes())))]
    pub code: String,
    /// `note` for what was taken for granted and is right for most inputs, `warning` for what makes the answers doubtful.
    #[cfg_attr(test, schemars(extend("enum" = ["note", "warning"])))]
    pub level: String,
    /// The same for people.
    pub message: String,
}

impl From<&Warning> for WarningRecord {
    fn from(warning: &Warning) -> Self {
        Self {
            code: warning.code.name().to_owned(),
            level: warning.level().name().to_owned(),
            message: warning.message.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use pomona_files::WarningCode;

    /// The names of all codes.
    pub(super) fn codes() -> Vec<&'static str> {
        WarningCode::ALL.iter().map(|code| code.name()).collect()
    }

    #[test]
    fn every_code_is_explained_in_the_docs() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/output.md");
        let docs = std::fs::read_to_string(path).unwrap();
        for code in WarningCode::ALL {
            let meaning: Vec<_> = code.meaning().split_whitespace().collect();
            let (name, level) = (code.name(), code.level().name());
            let row = format!("| `{name}` | {level} | {} |", meaning.join(" "));
            assert!(docs.contains(&row), "docs/output.md lacks the row\n{row}");
        }
    }
}
