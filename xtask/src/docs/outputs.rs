//! What commands print and write, each run once.

use super::{directive::Directive, json, text};
use crate::{program::Program, workspace::root};
use anyhow::{Context, Result, bail, ensure};
use std::{collections::HashMap, env, fs, path::PathBuf, process::Command};

/// Where the commands write, one folder for each.
const FOLDER: &str = "target/docs";
/// Stands in a command for its output folder.
const OUT: &str = "OUT";
/// How the output folder is called in what is shown.
const SHOWN: &str = "out";

/// Runs commands and remembers.
pub(super) struct Outputs {
    program: Program,
    known: HashMap<String, Output>,
}

#[derive(Clone)]
struct Output {
    printed: String,
    folder: PathBuf,
}

impl Outputs {
    pub(super) fn new(program: Program) -> Result<Self> {
        let folder = root().join(FOLDER);
        if folder.exists() {
            fs::remove_dir_all(&folder).with_context(|| format!("cannot clear {FOLDER}"))?;
        }
        Ok(Self {
            program,
            known: HashMap::new(),
        })
    }

    /// What stands in the region.
    pub(super) fn text(&mut self, directive: &Directive) -> Result<String> {
        let output = self.run(&directive.subject)?;
        let mut shown = match &directive.file {
            Some(name) => {
                let path = output.folder.join(name);
                fs::read_to_string(&path).with_context(|| path.display().to_string())?
            }
            None => output.printed,
        };
        if directive.language == "json" {
            shown = json::shown(&shown, directive)?;
        }
        shown = text::without_times(&text::chosen(&shown, &directive.lines)?);
        let shown = shown.trim_matches('\n');
        Ok(match directive.language.as_str() {
            "markdown" => format!("{shown}\n"),
            language => format!("```{language}\n{shown}\n```\n"),
        })
    }

    /// The file that the command has made.
    pub(super) fn file(&mut self, directive: &Directive) -> Result<PathBuf> {
        let name = directive
            .file
            .as_ref()
            .context("name it by `; file NAME`")?;
        Ok(self.run(&directive.subject)?.folder.join(name))
    }

    fn run(&mut self, command_line: &str) -> Result<Output> {
        if let Some(output) = self.known.get(command_line) {
            return Ok(output.clone());
        }
        let mut words = command_line.split_whitespace();
        let mut command = match words.next() {
            Some("pomona") => self.program.command(),
            Some("xtask") => Command::new(env::current_exe().context("where is xtask?")?),
            _ => bail!("`{command_line}`: a command begins with `pomona` or `xtask`"),
        };
        let folder = format!("{FOLDER}/{}", self.known.len());
        command
            .current_dir(root())
            .args(words.map(|word| if word == OUT { &folder } else { word }))
            .envs([("NO_COLOR", "1"), ("COLUMNS", "100")])
            .env_remove("RUST_LOG");
        let run = command
            .output()
            .with_context(|| format!("cannot start `{command_line}`"))?;
        let errors = String::from_utf8_lossy(&run.stderr);
        ensure!(
            run.status.success(),
            "`{command_line}`: {}",
            errors.trim_end()
        );
        let printed = String::from_utf8(run.stdout).context("no UTF-8")?;
        let output = Output {
            printed: printed.replace(&folder, SHOWN),
            folder: root().join(folder),
        };
        self.known.insert(command_line.to_owned(), output.clone());
        Ok(output)
    }
}
