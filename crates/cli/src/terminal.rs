use anstyle::{AnsiColor, Style};
use anyhow::Error;
use clap::ColorChoice;
use pomona::Warning;
use std::io::{self, IsTerminal, Write};

/// Bold, for headings.
pub(crate) const HEADING: Style = Style::new().bold();
/// What went well.
pub(crate) const GOOD: Style = AnsiColor::Green.on_default();
/// What was refused.
pub(crate) const REFUSED: Style = AnsiColor::Yellow.on_default();
/// What is of less weight.
pub(crate) const FAINT: Style = Style::new().dimmed();
const ERROR: Style = AnsiColor::Red.on_default().bold();

/// Whether the two output streams show colours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terminal {
    color_out: bool,
    color_err: bool,
}

impl Terminal {
    /// `auto` colours what a person sees: a terminal, unless `NO_COLOR` is set or it is dumb.
    pub(crate) fn new(choice: ColorChoice) -> Self {
        let unwanted = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
            || std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        let shown = |is_terminal: bool| match choice {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => is_terminal && !unwanted,
        };
        Self {
            color_out: shown(io::stdout().is_terminal()),
            color_err: shown(io::stderr().is_terminal()),
        }
    }

    /// `text` in a style on standard output.
    pub(crate) fn paint(self, style: Style, text: &str) -> String {
        paint(self.color_out, style, text)
    }

    /// Whether messages on standard error are coloured.
    pub(crate) fn colors_messages(self) -> bool {
        self.color_err
    }

    /// Says on standard error what went wrong.
    pub(crate) fn error(self, error: &Error) {
        // The libraries' messages name their causes themselves, so only the outermost one is shown.
        self.message(ERROR, "error", &error.to_string());
    }

    /// Says on standard error what a person should know.
    pub(crate) fn note(self, text: &str) {
        self.message(REFUSED, "note", text);
    }

    /// Says on standard error what was assumed about an input, or is doubtful about it; `input` names it.
    pub(crate) fn warn(self, input: &str, warning: &Warning) {
        let text = format!("{}: {}", one_line(input), one_line(&warning.to_string()));
        self.message(REFUSED, warning.level().name(), &text);
    }

    fn message(self, style: Style, kind: &str, text: &str) {
        let kind = paint(self.color_err, style, kind);
        // Nothing is left to be told where standard error is closed.
        let _ = writeln!(io::stderr().lock(), "{kind}: {}", text.trim_end());
    }
}

fn paint(colored: bool, style: Style, text: &str) -> String {
    if colored {
        format!("{style}{text}{style:#}")
    } else {
        text.to_owned()
    }
}

/// Writes to standard output; an error, not a panic, where it is closed.
pub(crate) fn print(text: &str) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}

/// `text` for one line of a terminal: control characters, which could steer it, are replaced.
pub(crate) fn one_line(text: &str) -> String {
    text.chars()
        .map(|c| {
            if c.is_control() {
                char::REPLACEMENT_CHARACTER
            } else {
                c
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_do_not_reach_the_terminal() {
        assert_eq!(one_line("a\x1b[31mb\nc"), "a\u{fffd}[31mb\u{fffd}c");
    }

    #[test]
    fn a_style_is_closed_again() {
        assert_eq!(paint(true, HEADING, "x"), "\x1b[1mx\x1b[0m");
        assert_eq!(paint(false, HEADING, "x"), "x");
    }
}
