use anyhow::{anyhow, bail};
use serde::Deserialize;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The answers of one frame.
pub(crate) const PICKS: &str = "picks.json";
/// The picture of one frame.
pub(crate) const PICTURE: &str = "picture.png";

/// The recording of one frame; runs of builds without the feature remove it all the same.
pub(crate) const RECORDING: &str = "recording.mcap";

/// The name under which the cloud of an apple is written.
pub(crate) fn cloud_name(id: usize) -> String {
    format!("apple-{id}.ply")
}

/// Whether a run of ours may have written a file of this name.
fn is_ours(name: &str) -> bool {
    let is_cloud = |name: &str| {
        let id = name.strip_prefix("apple-")?.strip_suffix(".ply")?;
        id.parse::<usize>().ok()
    };
    let is_message = |name: &str| {
        let message = name
            .strip_prefix("ros-")
            .and_then(|n| n.strip_suffix(".yaml"));
        message.is_some_and(|n| !n.is_empty())
    };
    let is_fixed = [PICKS, PICTURE, RECORDING].contains(&name);
    is_fixed || is_cloud(name).is_some() || is_message(name)
}

/// Refuses a folder in which our files would replace somebody else's.
///
/// A folder with a `picks.json` of ours was written by us; one without must not hold
/// any of our names.
pub(crate) fn refuse_foreign(folder: &Path) -> anyhow::Result<()> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(()),
        Err(e) => bail!("--out {}: {e}; name a folder", folder.display()),
    };
    let picks = folder.join(PICKS);
    if picks.exists() {
        if is_record(&picks) {
            return Ok(());
        }
        bail!(
            "{}: is not a result of this program; name another folder by --out",
            picks.display()
        );
    }
    for entry in entries {
        let entry = entry.map_err(|e| anyhow!("--out {}: {e}", folder.display()))?;
        if is_ours(&entry.file_name().to_string_lossy()) {
            bail!(
                "{}: would be replaced, and no {PICKS} says that this program wrote it; name another folder by --out",
                entry.path().display()
            );
        }
    }
    Ok(())
}

fn is_record(path: &Path) -> bool {
    #[derive(Deserialize)]
    struct Head {
        schema: String,
    }
    let head = fs::read(path)
        .ok()
        .and_then(|bytes| serde_json::from_slice::<Head>(&bytes).ok());
    head.is_some_and(|head| head.schema.starts_with("pomona.picks/"))
}

/// The files of one frame, collected out of sight and put in place together.
///
/// What is not published disappears again, with the folders that were made for it.
#[derive(Debug)]
pub(crate) struct OutputFolder {
    folder: PathBuf,
    part: PathBuf,
    /// Folders that were not there before, the outermost first.
    made: Vec<PathBuf>,
    published: bool,
}

impl OutputFolder {
    /// Makes the hidden folder that collects the files for `folder`: inside it where it is
    /// there, else beside it.
    pub(crate) fn new(folder: &Path) -> anyhow::Result<Self> {
        let hidden = format!(".pomona-{}.part", std::process::id());
        let (part, parent) = if folder.exists() {
            (folder.join(hidden), folder)
        } else {
            let parent = folder.parent().unwrap_or(Path::new(""));
            (folder.with_file_name(hidden), parent)
        };
        let made: Vec<_> = parent
            .ancestors()
            .take_while(|p| !p.as_os_str().is_empty() && !p.exists())
            .map(Path::to_owned)
            .collect();
        let this = Self {
            folder: folder.to_owned(),
            part,
            made: made.into_iter().rev().collect(),
            published: false,
        };
        fs::create_dir_all(parent)
            .and_then(|()| fs::create_dir(&this.part))
            .map_err(|e| this.refused(&e))?;
        Ok(this)
    }

    /// Where to write the file `name` for now.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.part.join(name)
    }

    /// Puts the files in place. Ours of an earlier run that this one did not write are removed.
    pub(crate) fn publish(self) -> anyhow::Result<()> {
        self.publish_replacing(PICKS, is_ours)
    }

    /// Puts the files in place, `main` last. Files of an earlier run, which `is_earlier` knows by their names, are
    /// removed where this one did not write them.
    pub(crate) fn publish_replacing(
        mut self,
        main: &str,
        is_earlier: impl Fn(&str) -> bool,
    ) -> anyhow::Result<()> {
        self.put_in_place(main, is_earlier)
            .map_err(|e| self.refused(&e))?;
        self.published = true;
        Ok(())
    }

    fn put_in_place(&self, main: &str, is_earlier: impl Fn(&str) -> bool) -> std::io::Result<()> {
        if !self.folder.exists() {
            return fs::rename(&self.part, &self.folder);
        }
        let names = |dir: &Path| -> std::io::Result<Vec<String>> {
            let names =
                fs::read_dir(dir)?.map(|e| Ok(e?.file_name().to_string_lossy().into_owned()));
            names.collect()
        };
        let written = names(&self.part)?;
        for stale in names(&self.folder)?
            .iter()
            .filter(|n| is_earlier(n) && !written.contains(n))
        {
            fs::remove_file(self.folder.join(stale))?;
        }
        // The answers last: whoever waits for them finds the rest in place.
        let (last, rest): (Vec<_>, Vec<_>) = written.iter().partition(|name| *name == main);
        for name in rest.into_iter().chain(last) {
            fs::rename(self.part.join(name), self.folder.join(name))?;
        }
        fs::remove_dir(&self.part)
    }

    fn refused(&self, error: &std::io::Error) -> anyhow::Error {
        anyhow!(
            "{}: cannot be written: {error}; check that the place is writable and has room",
            self.folder.display()
        )
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        if self.published {
            return;
        }
        // The error that brought us here is the one to report.
        let _ = fs::remove_dir_all(&self.part);
        for folder in self.made.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Writes `text` as the file `name` of `output`.
pub(crate) fn write_text(output: &OutputFolder, name: &str, text: &str) -> anyhow::Result<()> {
    fs::write(output.file(name), text)
        .map_err(|e| anyhow!("{name}: cannot be written: {e}; check that there is room"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RECORD: &str = r#"{"schema": "pomona.picks/1"}"#;

    fn write(folder: &Path, names: &[&str]) {
        let output = OutputFolder::new(folder).unwrap();
        for name in names {
            write_text(&output, name, RECORD).unwrap();
        }
        output.publish().unwrap();
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_later_run_replaces_the_earlier_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("a/b");
        write(&folder, &[PICKS, PICTURE, "apple-3.ply"]);
        fs::write(folder.join("notes.txt"), "mine").unwrap();
        fs::write(folder.join("apple-x.ply"), "mine").unwrap();
        refuse_foreign(&folder).unwrap();
        write(&folder, &[PICKS, "apple-12.ply"]);
        assert_eq!(
            names(&folder),
            ["apple-12.ply", "apple-x.ply", "notes.txt", PICKS]
        );
        assert_eq!(names(dir.path()), ["a"]);
    }

    #[test]
    fn what_is_not_published_disappears() {
        let dir = tempfile::tempdir().unwrap();
        let output = OutputFolder::new(&dir.path().join("a/b/c")).unwrap();
        write_text(&output, PICKS, RECORD).unwrap();
        drop(output);
        assert!(names(dir.path()).is_empty());
    }

    #[test]
    fn files_of_others_are_not_replaced() {
        for (name, content) in [(PICKS, "{}"), (PICTURE, "holiday"), ("apple-1.ply", "ply")] {
            let dir = tempfile::tempdir().unwrap();
            fs::write(dir.path().join(name), content).unwrap();
            let message = refuse_foreign(dir.path()).unwrap_err().to_string();
            assert!(
                message.contains(name) && message.contains("--out"),
                "{message}"
            );
        }
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("file"), "").unwrap();
        assert!(refuse_foreign(&dir.path().join("file")).is_err());
        assert!(refuse_foreign(&dir.path().join("new")).is_ok());
    }
}
