//! Where the results go: the output folder and standard output.

use crate::output_folder::{OutputFolder, RecordFile};
use crate::pick::PICKS;
use crate::terminal;
use anyhow::bail;
use clap::Args;
use serde::Serialize;
use std::path::PathBuf;

/// The page that every evaluation writes.
pub(super) const REPORT: &str = "report.html";

#[derive(Debug, Args)]
pub(super) struct Results {
    /// Output folder. Files of earlier runs are replaced.
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: PathBuf,
    /// Print the result to standard output as JSON instead of the table.
    #[arg(long)]
    pub(super) json: bool,
}

impl Results {
    /// Claims the names of an evaluation's record and its page, and those that `writes` knows.
    pub(super) fn claim(
        &self,
        record: &str,
        schema: &str,
        writes: impl Fn(&str) -> bool,
    ) -> anyhow::Result<OutputFolder> {
        if self.out.join(PICKS).exists() {
            bail!(
                "{}: holds the answers of `pomona pick`; name another folder by --out",
                self.out.display()
            );
        }
        let record = RecordFile {
            name: record,
            schema,
        };
        OutputFolder::claim(&self.out, &[record], |name| name == REPORT || writes(name))
    }

    /// Prints the result as it was asked for.
    pub(super) fn print(&self, result: &impl Serialize, text: &str) -> anyhow::Result<()> {
        if self.json {
            return terminal::print(&json(result)?);
        }
        let place = self.out.display();
        terminal::print(&format!("{text}\nwritten to {place}\n"))
    }
}

/// As the files hold it.
pub(super) fn json(result: &impl Serialize) -> serde_json::Result<String> {
    Ok(serde_json::to_string_pretty(result)? + "\n")
}
