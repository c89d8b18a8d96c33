//! A program that answers fitting jobs, ours or a peer's.

use super::clouds::{Mode, Primitive};
use anyhow::{Context, Result, bail};
use std::{
    ffi::OsString,
    io::{BufRead, BufReader, Write},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
};

/// An engine and what it can do.
pub(super) struct Engine {
    pub name: &'static str,
    /// What a reader of the table must know about it.
    pub remark: &'static str,
    /// What it can do: it is asked nothing else.
    pub jobs: &'static [(Primitive, Mode)],
    /// Slow ones get fewer scenes of each suite, and one round.
    pub max_scenes: usize,
    /// Program and arguments, or why there is none.
    pub program: Result<Vec<OsString>, String>,
}

impl Engine {
    pub(super) fn does(&self, primitive: Primitive, mode: Mode) -> bool {
        self.jobs.contains(&(primitive, mode))
    }
}

/// What an engine answered.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Answer {
    pub milliseconds: f64,
    /// Models scored; `None` where the engine does not tell.
    pub hypotheses: Option<f64>,
    /// Empty where there was none.
    pub model: Vec<f64>,
}

/// A running engine.
pub(super) struct Process {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Process {
    pub(super) fn start(program: &[OsString]) -> Result<Self> {
        let (name, arguments) = program.split_first().context("no program")?;
        let mut child = Command::new(name)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .with_context(|| format!("cannot start {}", name.display()))?;
        let input = child.stdin.take().context("no standard input")?;
        let output = BufReader::new(child.stdout.take().context("no standard output")?);
        Ok(Self {
            child,
            input,
            output,
        })
    }

    /// Asks and waits for the answer; an error where the program died or babbles.
    pub(super) fn ask(&mut self, job: &str) -> Result<Answer> {
        writeln!(self.input, "{job}")?;
        self.input.flush()?;
        let mut line = String::new();
        if self.output.read_line(&mut line)? == 0 {
            bail!("it ended with {}", self.child.wait()?);
        }
        parse(&line)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may be gone already, which is as good.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn parse(line: &str) -> Result<Answer> {
    let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
    let numbers = numbers.with_context(|| format!("no answer: '{}'", line.trim_end()))?;
    let [milliseconds, hypotheses, model @ ..] = numbers.as_slice() else {
        bail!("no answer: '{}'", line.trim_end());
    };
    Ok(Answer {
        milliseconds: *milliseconds,
        hypotheses: (*hypotheses > 0.0).then_some(*hypotheses),
        model: model.to_vec(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_a_line_of_numbers() {
        let answer = parse("1.5 1000 0 0 0.8 0.04\n").unwrap();
        assert_eq!(answer.hypotheses, Some(1000.0));
        assert_eq!(answer.model, [0.0, 0.0, 0.8, 0.04]);
        assert!(parse("1.5 0\n").unwrap().model.is_empty());
        assert!(parse("1.5\n").is_err());
        assert!(parse("Traceback (most recent call last):\n").is_err());
    }
}
