//! What a marker asks for: a command or a name, and options.

use anyhow::{Context, Result, bail};

/// `COMMAND; option VALUE; option VALUE`
#[derive(Debug, Default, PartialEq)]
pub(super) struct Directive {
    pub subject: String,
    /// Language of the fenced block; `markdown` is pasted as it is.
    pub language: String,
    /// First and last line of each part that is shown; all where there is none.
    pub lines: Vec<(usize, usize)>,
    /// File of the command's output folder, in place of what it prints.
    pub file: Option<String>,
    /// Place in that JSON.
    pub pointer: Option<String>,
    /// Significant digits of numbers in JSON.
    pub digits: Option<usize>,
    /// Decimals of a figure.
    pub decimals: Option<usize>,
    /// Keys in JSON whose value is shown as `…`.
    pub omit: Vec<String>,
}

impl Directive {
    pub(super) fn parse(text: &str) -> Result<Self> {
        let mut parts = text.split(';').map(str::trim);
        let mut directive = Self {
            subject: parts.next().unwrap_or_default().to_owned(),
            language: "text".to_owned(),
            ..Self::default()
        };
        for part in parts {
            let (option, value) = part.split_once(' ').unwrap_or((part, ""));
            let value = value.trim();
            let number = || {
                value
                    .parse()
                    .with_context(|| format!("`{part}`: no number"))
            };
            match option {
                "as" => value.clone_into(&mut directive.language),
                "lines" => directive.lines = ranges(value)?,
                "file" => directive.file = Some(value.to_owned()),
                "at" => directive.pointer = Some(value.to_owned()),
                "digits" => directive.digits = Some(number()?),
                "decimals" => directive.decimals = Some(number()?),
                "omit" => directive.omit = value.split(',').map(|key| key.trim().into()).collect(),
                _ => bail!(
                    "no option `{option}`; there are as, lines, file, at, digits, decimals, omit"
                ),
            }
        }
        Ok(directive)
    }
}

/// `1-6,24-` or `3`
fn ranges(text: &str) -> Result<Vec<(usize, usize)>> {
    let range = |part: &str| {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let last = if last.is_empty() {
            usize::MAX
        } else {
            last.parse()?
        };
        anyhow::Ok((first.parse()?, last))
    };
    let parts = text.split(',').map(|part| range(part.trim()));
    parts
        .collect::<Result<_>>()
        .with_context(|| format!("`lines {text}`: write `1-6,24-`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_follow_the_command() {
        let text =
            "pomona pick frame --out OUT; file picks.json; at /picks/3; as json; lines 1-6, 24-";
        let directive = Directive::parse(text).unwrap();
        assert_eq!(directive.subject, "pomona pick frame --out OUT");
        assert_eq!(directive.file.as_deref(), Some("picks.json"));
        assert_eq!(directive.pointer.as_deref(), Some("/picks/3"));
        assert_eq!(directive.language, "json");
        assert_eq!(directive.lines, [(1, 6), (24, usize::MAX)]);
        for wrong in [
            "pomona; colour red",
            "pomona; lines a",
            "pomona; digits many",
        ] {
            assert!(Directive::parse(wrong).is_err(), "{wrong}");
        }
    }
}
