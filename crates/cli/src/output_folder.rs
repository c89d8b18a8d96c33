use anyhow::{anyhow, bail};
use serde::Deserialize;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// A file whose `schema` says that this program wrote it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RecordFile<'a> {
    /// Its name in the folder.
    pub(crate) name: &'a str,
    /// How its schema begins: `pomona.picks/`.
    pub(crate) schema: &'a str,
}

impl RecordFile<'_> {
    /// Whether the folder holds this file, with this schema.
    fn is_in(self, folder: &Path) -> bool {
        #[derive(Deserialize)]
        struct Head {
            schema: String,
        }
        let head = fs::read(folder.join(self.name))
            .ok()
            .and_then(|bytes| serde_json::from_slice::<Head>(&bytes).ok());
        head.is_some_and(|head| head.schema.starts_with(self.schema))
    }
}

/// A folder in which a command may write its files.
///
/// Every command claims the names that it writes before it does any work. Files of those names that no earlier run
/// of the command wrote are somebody else's, and refused.
#[derive(Debug)]
pub(crate) struct OutputFolder {
    folder: PathBuf,
    /// The file that is published last.
    record: String,
    /// Files that an earlier run wrote; those that this one does not write again are removed.
    earlier: Vec<String>,
}

impl OutputFolder {
    /// Claims the names that `writes` knows, for a command that leaves these records. The first record, where it is
    /// there, says that an earlier run wrote the files of those names.
    pub(crate) fn claim(
        folder: &Path,
        records: &[RecordFile<'_>],
        writes: impl Fn(&str) -> bool,
    ) -> anyhow::Result<Self> {
        let names: Vec<&str> = records.iter().map(|record| record.name).collect();
        let known = |name: &str| records.iter().any(|r| r.name == name && r.is_in(folder));
        let has_run = names.first().is_some_and(|name| known(name));
        Self::claim_unless(folder, &names, &writes, |name| {
            if names.contains(&name) {
                known(name)
            } else {
                has_run && writes(name)
            }
        })
    }

    /// Removes what an earlier run left in `folder` if its record is there, such as one that this run does not write.
    pub(crate) fn remove_earlier(
        folder: &Path,
        record: RecordFile<'_>,
        writes: impl Fn(&str) -> bool,
    ) -> anyhow::Result<()> {
        if !record.is_in(folder) {
            return Ok(());
        }
        let refused = |name: &str, e: &io::Error| {
            anyhow!(
                "{}: cannot be removed: {e}; remove it",
                folder.join(name).display()
            )
        };
        // The record last: it is what says that the rest is ours.
        let others = names(folder).map_err(|e| refused("", &e))?;
        let others = others.iter().map(String::as_str);
        let others = others.filter(|name| *name != record.name && writes(name));
        for name in others.chain([record.name]) {
            fs::remove_file(folder.join(name)).map_err(|e| refused(name, &e))?;
        }
        Ok(())
    }

    /// Claims the names `written` for a command whose `record` lists the files of its run, `earlier`.
    pub(crate) fn claim_listed(
        folder: &Path,
        record: &str,
        written: &[String],
        earlier: &[String],
    ) -> anyhow::Result<Self> {
        let is_in = |names: &[String], name: &str| names.iter().any(|n| n == name);
        let writes = |name: &str| is_in(written, name);
        Self::claim_unless(folder, &[record], writes, |name| is_in(earlier, name))
    }

    fn claim_unless(
        folder: &Path,
        records: &[&str],
        writes: impl Fn(&str) -> bool,
        is_earlier: impl Fn(&str) -> bool,
    ) -> anyhow::Result<Self> {
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        let names = match names(folder) {
            Ok(names) => names,
            Err(e) if e.kind() == ErrorKind::NotFound => Vec::new(),
            Err(e) => bail!("--out {}: {e}; name a folder", folder.display()),
        };
        let record = records.first().copied().unwrap_or_default();
        let (earlier, others): (Vec<_>, Vec<_>) = names.into_iter().partition(|n| is_earlier(n));
        let is_claimed = |name: &&String| records.contains(&name.as_str()) || writes(name);
        if let Some(foreign) = others.iter().find(is_claimed) {
            let why = if records.contains(&foreign.as_str()) {
                "it is not a result of this program".to_owned()
            } else {
                format!("no {record} says that this program wrote it")
            };
            bail!(
                "{}: would be replaced, and {why}; name another folder by --out",
                folder.join(foreign).display()
            );
        }
        Ok(Self {
            folder: folder.to_owned(),
            record: record.to_owned(),
            earlier,
        })
    }

    /// Makes the hidden folder that collects the files: inside the folder where it is there, else beside it.
    pub(crate) fn stage(&self) -> anyhow::Result<Staging<'_>> {
        let hidden = format!(".pomona-{}.part", std::process::id());
        let (part, parent) = if self.folder.exists() {
            (self.folder.join(hidden), &*self.folder)
        } else {
            let parent = self.folder.parent().unwrap_or(Path::new(""));
            (self.folder.with_file_name(hidden), parent)
        };
        let made: Vec<_> = parent
            .ancestors()
            .take_while(|p| !p.as_os_str().is_empty() && !p.exists())
            .map(Path::to_owned)
            .collect();
        let staging = Staging {
            output: self,
            part,
            made: made.into_iter().rev().collect(),
            published: false,
        };
        fs::create_dir_all(parent)
            .and_then(|()| fs::create_dir(&staging.part))
            .map_err(|e| self.refused(&e))?;
        Ok(staging)
    }

    fn refused(&self, error: &io::Error) -> anyhow::Error {
        anyhow!(
            "{}: cannot be written: {error}; check that the place is writable and has room",
            self.folder.display()
        )
    }
}

/// The files of one run, written to a hidden folder and published together.
///
/// What is not published disappears again, with the folders that were made for it.
#[derive(Debug)]
pub(crate) struct Staging<'a> {
    output: &'a OutputFolder,
    part: PathBuf,
    /// Folders that were not there before, the outermost first.
    made: Vec<PathBuf>,
    published: bool,
}

impl Staging<'_> {
    /// The path at which to write the file `name` before it is published.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.part.join(name)
    }

    /// Writes `text` as the file `name`.
    pub(crate) fn write_text(&self, name: &str, text: &str) -> anyhow::Result<()> {
        fs::write(self.file(name), text)
            .map_err(|e| anyhow!("{name}: cannot be written: {e}; check that there is room"))
    }

    /// Puts the files in place, the record last, and removes those of the earlier run that this one did not write.
    pub(crate) fn publish(mut self) -> anyhow::Result<()> {
        self.put_in_place().map_err(|e| self.output.refused(&e))?;
        self.published = true;
        Ok(())
    }

    fn put_in_place(&self) -> io::Result<()> {
        let OutputFolder {
            folder,
            record,
            earlier,
        } = self.output;
        if !folder.exists() {
            return fs::rename(&self.part, folder);
        }
        let written = names(&self.part)?;
        for stale in earlier.iter().filter(|name| !written.contains(name)) {
            fs::remove_file(folder.join(stale))?;
        }
        // The record last: whoever waits for it finds the rest in place.
        let (last, rest): (Vec<_>, Vec<_>) = written.iter().partition(|name| *name == record);
        for name in rest.into_iter().chain(last) {
            fs::rename(self.part.join(name), folder.join(name))?;
        }
        fs::remove_dir(&self.part)
    }
}

impl Drop for Staging<'_> {
    fn drop(&mut self) {
        if self.published {
            return;
        }
        // The error that led here is the one to report.
        let _ = fs::remove_dir_all(&self.part);
        for folder in self.made.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// The names of what a folder holds, in order.
fn names(folder: &Path) -> io::Result<Vec<String>> {
    let names = fs::read_dir(folder)?.map(|e| Ok(e?.file_name().to_string_lossy().into_owned()));
    let mut names = names.collect::<io::Result<Vec<_>>>()?;
    names.sort_unstable();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RESULTS: RecordFile<'_> = RecordFile {
        name: "results.json",
        schema: "pomona.results/",
    };
    const RECORD: &str = r#"{"schema": "pomona.results/1"}"#;

    fn claim(folder: &Path) -> anyhow::Result<OutputFolder> {
        OutputFolder::claim(folder, &[RESULTS], |name| {
            name.starts_with("cloud-") || name == "picture.png"
        })
    }

    fn write(folder: &Path, names: &[&str]) {
        let output = claim(folder).unwrap();
        let staging = output.stage().unwrap();
        for name in names {
            staging.write_text(name, RECORD).unwrap();
        }
        staging.publish().unwrap();
    }

    #[test]
    fn a_later_run_replaces_the_earlier_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("a/b");
        write(&folder, &["results.json", "picture.png", "cloud-3"]);
        fs::write(folder.join("notes.txt"), "mine").unwrap();
        write(&folder, &["results.json", "cloud-12"]);
        assert_eq!(
            names(&folder).unwrap(),
            ["cloud-12", "notes.txt", "results.json"]
        );
        assert_eq!(names(dir.path()).unwrap(), ["a"]);
    }

    #[test]
    fn what_is_not_published_disappears() {
        let dir = tempfile::tempdir().unwrap();
        let output = claim(&dir.path().join("a/b/c")).unwrap();
        let staging = output.stage().unwrap();
        staging.write_text("results.json", RECORD).unwrap();
        drop(staging);
        assert!(names(dir.path()).unwrap().is_empty());
    }

    #[test]
    fn files_of_others_are_not_replaced() {
        for (name, content) in [
            ("results.json", "{}"),
            ("picture.png", "holiday"),
            ("cloud-1", "sky"),
        ] {
            let dir = tempfile::tempdir().unwrap();
            fs::write(dir.path().join(name), content).unwrap();
            let message = claim(dir.path()).unwrap_err().to_string();
            assert!(
                message.contains(name) && message.contains("--out"),
                "{message}"
            );
        }
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("file"), "").unwrap();
        assert!(claim(&dir.path().join("file")).is_err());
        assert!(claim(&dir.path().join("new")).is_ok());
    }

    #[test]
    fn each_record_must_have_its_own_schema() {
        let dir = tempfile::tempdir().unwrap();
        let other = RecordFile {
            name: "other.json",
            schema: "pomona.other/",
        };
        let claim = || OutputFolder::claim(dir.path(), &[RESULTS, other], |_| false);
        fs::write(dir.path().join("results.json"), RECORD).unwrap();
        assert!(claim().is_ok());
        fs::write(dir.path().join("other.json"), RECORD).unwrap();
        assert!(claim().unwrap_err().to_string().contains("other.json"));
        fs::write(
            dir.path().join("other.json"),
            r#"{"schema": "pomona.other/1"}"#,
        )
        .unwrap();
        assert!(claim().is_ok());
    }

    #[test]
    fn a_record_may_list_its_files() {
        let dir = tempfile::tempdir().unwrap();
        let list = |names: &[&str]| names.iter().map(ToString::to_string).collect::<Vec<_>>();
        for name in ["results.json", "a", "b", "c"] {
            fs::write(dir.path().join(name), RECORD).unwrap();
        }
        let claim = |written: &[&str], earlier: &[&str]| {
            OutputFolder::claim_listed(dir.path(), "results.json", &list(written), &list(earlier))
        };
        assert!(claim(&["a"], &[]).is_err());
        let foreign = claim(&["c"], &["results.json", "a", "b"]).unwrap_err();
        assert!(
            foreign.to_string().contains("c: would be replaced"),
            "{foreign}"
        );
        let output = claim(&["b"], &["results.json", "a", "b"]).unwrap();
        let staging = output.stage().unwrap();
        staging.write_text("b", "new").unwrap();
        staging.write_text("results.json", RECORD).unwrap();
        staging.publish().unwrap();
        assert_eq!(names(dir.path()).unwrap(), ["b", "c", "results.json"]);
    }
}
