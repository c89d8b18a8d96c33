//! The text of a PLY file: lines of the header, and the numbers behind it.

use super::vertex::Vertex;
use ply_rs_bw::ply::ElementDef;
use pomona_files::Malformed;

const DAMAGED: &str = "write the cloud again; this file is cut short or damaged";

/// A text whose lines end in `\n`, `\r\n` or `\r`.
///
/// An element may be spread over several lines, and a line may hold several; a number that is left over on a line
/// contradicts the header.
pub(super) struct Tokens<'a> {
    pub(super) rest: &'a [u8],
    /// Number of the line read last, from 1.
    pub(super) line: usize,
    /// What is left of that line.
    open: &'a [u8],
}

impl<'a> Tokens<'a> {
    /// The text `rest`, behind so many lines.
    pub(super) fn new(rest: &'a [u8], line: usize) -> Self {
        Self {
            rest,
            line,
            open: &[],
        }
    }

    pub(super) fn next_line(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.line += 1;
        let end = self
            .rest
            .iter()
            .position(|b| matches!(b, b'\n' | b'\r'))
            .unwrap_or(self.rest.len());
        let (line, tail) = self.rest.split_at(end);
        let broken = tail.strip_prefix(b"\r\n").or_else(|| tail.get(1..));
        self.rest = broken.unwrap_or_default();
        Some(line)
    }

    /// The next word, on this line or a later one.
    fn next(&mut self) -> Option<&'a [u8]> {
        loop {
            let start = self.open.trim_ascii_start();
            if !start.is_empty() {
                let end = start
                    .iter()
                    .position(u8::is_ascii_whitespace)
                    .unwrap_or(start.len());
                let (word, rest) = start.split_at(end);
                self.open = rest;
                return Some(word);
            }
            self.open = self.next_line()?;
        }
    }

    fn is_mid_line(&self) -> bool {
        !self.open.trim_ascii().is_empty()
    }

    /// The next element, which is the `index`-th from 0 of its kind.
    pub(super) fn vertex(
        &mut self,
        element: &ElementDef,
        index: usize,
    ) -> Result<Vertex, Malformed> {
        let started_at = self.is_mid_line().then_some(self.line);
        let mut next = |name: &str| {
            let fault = |line: usize, problem: String| {
                Malformed::new(format!("line {line}"), problem, DAMAGED)
            };
            let ends = || {
                format!(
                    "ends before property `{name}` of {} {} of {}",
                    element.name,
                    index + 1,
                    element.count
                )
            };
            let word = self.next().ok_or_else(|| fault(self.line, ends()))?;
            let text = String::from_utf8_lossy(word);
            let value = text.parse::<f64>();
            value.map_err(|_| {
                fault(
                    self.line,
                    format!("property `{name}` is `{text}`, not a number"),
                )
            })
        };
        let vertex = Vertex::from_numbers(element, &mut next)?;
        let begins_a_line = started_at.is_none_or(|line| line == self.line);
        let is_last = index + 1 == element.count;
        match started_at {
            Some(line) if !begins_a_line => Err(left_over(element, line)),
            _ if is_last && self.is_mid_line() => Err(left_over(element, self.line)),
            _ => Ok(vertex),
        }
    }
}

fn left_over(element: &ElementDef, line: usize) -> Malformed {
    let names: Vec<&str> = element.properties.values().map(|p| &*p.name).collect();
    let problem = format!(
        "more numbers than the properties of {}: {}",
        element.name,
        names.join(", ")
    );
    Malformed::new(
        format!("line {line}"),
        problem,
        "declare every property in the header, or write the cloud again",
    )
}
