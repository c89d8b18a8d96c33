use super::frame::RealFrame;
use crate::error::EvaluateError;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What to do about a table that is not one of apples.
const COLUMNS: &str = "give CSV with a header and the columns frame, box_name and wood, which is seen, doubtful or none";

/// Whether a person sees the wood nearest to an apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum WoodSeen {
    /// It is seen.
    Seen,
    /// There may be some.
    Doubtful,
    /// None is seen.
    None,
    /// Nobody has looked.
    Unlisted,
}

impl WoodSeen {
    /// Its name in tables and files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Seen => "seen",
            Self::Doubtful => "doubtful",
            Self::None => "none",
            Self::Unlisted => "unlisted",
        }
    }
}

/// What a person says of one apple.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct AppleWood {
    /// Id of the frame.
    pub frame: String,
    /// Name of the apple's box.
    pub box_name: String,
    /// Whether its wood is seen.
    pub wood: WoodSeen,
}

/// A table of apples, and where it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct AppleWoodTable {
    /// Its file.
    pub path: PathBuf,
    /// Its lines.
    pub apples: Vec<AppleWood>,
}

impl AppleWoodTable {
    /// Reads CSV with at least the columns `frame`, `box_name` and `wood` (seen, doubtful or none).
    ///
    /// # Errors
    ///
    /// [`EvaluateError::Io`]; [`EvaluateError::Malformed`] where a column is missing, a word is another, or an apple
    /// stands twice.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, EvaluateError> {
        #[derive(Deserialize)]
        struct Line {
            frame: String,
            box_name: String,
            wood: String,
        }
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|source| EvaluateError::Io {
            path: path.to_owned(),
            source,
        })?;
        let mut table = Self {
            path: path.to_owned(),
            apples: Vec::new(),
        };
        for line in csv::Reader::from_reader(text.as_bytes()).deserialize() {
            let line: Line = line.map_err(|e| table.malformed(e.to_string(), COLUMNS))?;
            let known = [WoodSeen::Seen, WoodSeen::Doubtful, WoodSeen::None];
            let Some(wood) = known.into_iter().find(|w| w.name() == line.wood) else {
                let problem = format!(
                    "apple {} of {}: wood is `{}`",
                    line.box_name, line.frame, line.wood
                );
                return Err(table.malformed(problem, "write seen, doubtful or none"));
            };
            if table.find(&line.frame, &line.box_name).is_some() {
                let problem = format!("apple {} of {} stands twice", line.box_name, line.frame);
                return Err(table.malformed(problem, "give each apple one line"));
            }
            table.apples.push(AppleWood {
                frame: line.frame,
                box_name: line.box_name,
                wood,
            });
        }
        if table.apples.is_empty() {
            return Err(table.malformed("no apples".to_owned(), COLUMNS));
        }
        Ok(table)
    }

    /// What it says of an apple; [`WoodSeen::Unlisted`] where nothing.
    pub fn wood(&self, frame: &str, box_name: &str) -> WoodSeen {
        self.find(frame, box_name)
            .map_or(WoodSeen::Unlisted, |apple| apple.wood)
    }

    /// Checks that it names the boxes of `frames`; lines about other frames are left alone.
    ///
    /// # Errors
    ///
    /// [`EvaluateError::Malformed`] for a box that a frame has not or has twice, for an apple whose wood is seen where
    /// the frame's strokes have no wood, and where no line is about any of the frames.
    pub fn check(&self, frames: &[RealFrame]) -> Result<(), EvaluateError> {
        let mut concerned = false;
        for apple in &self.apples {
            let Some(frame) = frames.iter().find(|f| f.frame.id == apple.frame) else {
                continue;
            };
            concerned = true;
            let boxes = frame.boxes().iter();
            let named = boxes.filter(|b| b.name == apple.box_name).count();
            if named != 1 {
                let problem = format!(
                    "frame {} has {named} boxes named {}",
                    apple.frame, apple.box_name
                );
                return Err(self.malformed(
                    problem,
                    "name each apple as its box, which has a name of its own",
                ));
            }
            if apple.wood == WoodSeen::Seen && frame.wood_strokes().next().is_none() {
                let problem = format!(
                    "the wood of apple {} of {} is seen, and no stroke of wood is drawn there",
                    apple.box_name, apple.frame
                );
                return Err(self.malformed(problem, "draw it, or write doubtful or none"));
            }
        }
        if !concerned {
            let names: Vec<&str> = frames.iter().map(|f| f.frame.id.as_str()).collect();
            let problem = format!("no line is about {}", names.join(" or "));
            return Err(self.malformed(problem, "name frames by their folders' names"));
        }
        Ok(())
    }

    fn find(&self, frame: &str, box_name: &str) -> Option<&AppleWood> {
        self.apples
            .iter()
            .find(|apple| apple.frame == frame && apple.box_name == box_name)
    }

    fn malformed(&self, problem: String, remedy: &str) -> EvaluateError {
        EvaluateError::Malformed {
            path: self.path.clone(),
            problem,
            remedy: remedy.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<AppleWoodTable, EvaluateError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("apples.csv");
        std::fs::write(&path, text).unwrap();
        AppleWoodTable::read(path)
    }

    #[test]
    fn apples_are_found_by_frame_and_box() {
        let table = read("note,wood,frame,box_name\n,seen,a,1\n\"x, y\",none,b,1\n").unwrap();
        assert_eq!(table.wood("a", "1"), WoodSeen::Seen);
        assert_eq!(table.wood("b", "1"), WoodSeen::None);
        assert_eq!(table.wood("b", "2"), WoodSeen::Unlisted);
    }

    #[test]
    fn nonsense_is_refused_with_its_place() {
        for (text, part) in [
            ("frame,box_name\na,1\n", "wood"),
            ("frame,box_name,wood\na,1,perhaps\n", "`perhaps`"),
            ("frame,box_name,wood\na,1,unlisted\n", "`unlisted`"),
            ("frame,box_name,wood\na,1,seen\na,1,none\n", "stands twice"),
            ("frame,box_name,wood\n", "no apples"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(
                message.contains("apples.csv") && message.contains(part),
                "{message}"
            );
        }
    }
}
