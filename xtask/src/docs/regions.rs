//! The marked regions of a Markdown file.
//!
//! A block runs from a line `<!-- from: … -->` or `<!-- picture: … -->` to a line `<!-- end -->`; a figure stands
//! within a line, `<!-- figure: … -->0.4<!-- end -->`. Fenced code blocks are left alone.

use super::directive::Directive;
use anyhow::{Context, Result};

const CLOSE: &str = "-->";
const END: &str = "<!-- end -->";
const FIGURE: &str = "<!-- figure:";

/// What fills a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Output,
    Picture,
    Figure,
}

/// One region as it stands.
pub(super) struct Region<'a> {
    pub kind: Kind,
    /// Line of the opening marker, from 1.
    pub line: usize,
    pub directive: &'a Directive,
    pub body: &'a str,
}

/// The text with every region filled anew.
pub(super) fn fill(
    text: &str,
    filling: &mut dyn FnMut(&Region) -> Result<String>,
) -> Result<String> {
    let mut filled = String::new();
    let mut lines = text.split_inclusive('\n').enumerate();
    let mut fenced = false;
    while let Some((i, line)) = lines.next() {
        let number = i + 1;
        fenced ^= line.trim_start().starts_with("```");
        let Some((kind, directive)) = opening(line).filter(|_| !fenced) else {
            filled += &if fenced {
                line.to_owned()
            } else {
                figures(line, number, filling)?
            };
            continue;
        };
        let mut body = String::new();
        loop {
            let (_, line) = lines
                .next()
                .with_context(|| format!("line {number}: no `{END}` after this marker"))?;
            if line.trim() == END {
                break;
            }
            body += line;
        }
        let directive = Directive::parse(directive).with_context(|| format!("line {number}"))?;
        let region = Region {
            kind,
            line: number,
            directive: &directive,
            body: &body,
        };
        filled += line;
        filled += &filling(&region)?;
        filled += END;
        filled.push('\n');
    }
    Ok(filled)
}

/// The kind and the directive of a marker that opens a block.
fn opening(line: &str) -> Option<(Kind, &str)> {
    let inner = line
        .trim()
        .strip_prefix("<!--")?
        .strip_suffix(CLOSE)?
        .trim();
    let output = inner.strip_prefix("from:").map(|rest| (Kind::Output, rest));
    output.or_else(|| {
        inner
            .strip_prefix("picture:")
            .map(|rest| (Kind::Picture, rest))
    })
}

/// A line with its figures filled in.
fn figures(
    line: &str,
    number: usize,
    filling: &mut dyn FnMut(&Region) -> Result<String>,
) -> Result<String> {
    let mut filled = String::new();
    let mut rest = line;
    while let Some(start) = rest.find(FIGURE) {
        let open =
            || format!("line {number}: write `<!-- figure: NAME -->0.4<!-- end -->` in one line");
        let (directive, after) = rest[start + FIGURE.len()..]
            .split_once(CLOSE)
            .with_context(open)?;
        let (body, after) = after.split_once(END).with_context(open)?;
        let directive_of = Directive::parse(directive).with_context(|| format!("line {number}"))?;
        let region = Region {
            kind: Kind::Figure,
            line: number,
            directive: &directive_of,
            body,
        };
        let value = filling(&region)?;
        filled += &rest[..start];
        filled.extend([FIGURE, directive, CLOSE, &value, END]);
        rest = after;
    }
    Ok(filled + rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(text: &str) -> Result<String> {
        fill(text, &mut |region| {
            let body = region.body.trim();
            let subject = &region.directive.subject;
            Ok(match region.kind {
                Kind::Figure => format!("[{subject} for {body}]"),
                Kind::Output | Kind::Picture => format!("[{subject} for {body}]\n"),
            })
        })
    }

    #[test]
    fn blocks_and_figures_are_filled_and_the_rest_stays() {
        let text = "# Title\n<!-- from: pomona config; as toml -->\nold\nlines\n<!-- end -->\nafter\n\
            | 1 | <!-- figure: lab.mean -->0.4<!-- end -->° and <!-- figure: b --><!-- end --> |\n";
        assert_eq!(
            filled(text).unwrap(),
            "# Title\n<!-- from: pomona config; as toml -->\n[pomona config for old\nlines]\n<!-- end -->\nafter\n\
             | 1 | <!-- figure: lab.mean -->[lab.mean for 0.4]<!-- end -->° and <!-- figure: b -->[b for ]<!-- end --> |\n"
        );
    }

    #[test]
    fn code_blocks_are_left_alone() {
        let text = "```\n<!-- from: x -->\n<!-- figure: y -->1<!-- end -->\n```\n";
        assert_eq!(filled(text).unwrap(), text);
    }

    #[test]
    fn a_region_without_an_end_is_an_error() {
        for text in [
            "<!-- from: x -->\nold\n",
            "<!-- figure: x -->1\n<!-- end -->\n",
        ] {
            let error = filled(text).unwrap_err();
            assert!(format!("{error:#}").contains("line 1"), "{error:#}");
        }
    }
}
