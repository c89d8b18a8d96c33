//! What exporters of the YOLO families write into a model's file about it, as Ultralytics does.

use crate::classes;
use pomona_network::Malformed;

/// What is known so of a model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Metadata {
    /// The names of its classes.
    pub(crate) names: Option<Vec<String>>,
    pub(crate) task: Task,
    /// Whether its output is suppressed inside the model.
    pub(crate) end_to_end: bool,
}

/// What a model was trained for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) enum Task {
    /// Boxes, also where nothing is said.
    #[default]
    Boxes,
    /// Boxes, and numbers behind them for a mask or key points, which are not read.
    BoxesAndMore,
    /// Something else, by its name.
    Other(String),
}

impl Metadata {
    pub(crate) fn new(entries: &[(String, String)]) -> Self {
        let value = |key: &str| {
            let entry = entries.iter().find(|(name, _)| name == key);
            entry.map(|(_, value)| value.trim())
        };
        let is_true = |text: &str| text.eq_ignore_ascii_case("true") || text == "1";
        let has_suppression = |arguments: &str| {
            let plain: String = arguments
                .chars()
                .filter(|c| !matches!(c, '\'' | '"' | ' '))
                .collect();
            plain.to_ascii_lowercase().contains("nms:true")
        };
        Self {
            names: classes::from_metadata(entries),
            task: match value("task") {
                None | Some("" | "detect") => Task::Boxes,
                Some("segment" | "pose") => Task::BoxesAndMore,
                Some(other) => Task::Other(other.to_owned()),
            },
            end_to_end: value("end2end").is_some_and(is_true)
                || value("args").is_some_and(has_suppression),
        }
    }

    /// Refuses a model that gives no upright boxes.
    pub(crate) fn check_task(&self) -> Result<(), Malformed> {
        let Task::Other(task) = &self.task else {
            return Ok(());
        };
        let what = match &**task {
            "obb" => "rotated boxes",
            "classify" => "a class for the whole image",
            _ => "something other than boxes",
        };
        Err(Malformed::new(
            "metadata",
            format!(
                "the model's task is `{task}`: it gives {what}, and apples are boxed upright here"
            ),
            "train and export it for the task `detect`",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(entries: &[(&str, &str)]) -> Metadata {
        let entries: Vec<_> = entries
            .iter()
            .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
            .collect();
        Metadata::new(&entries)
    }

    #[test]
    fn task_names_and_suppression_are_read() {
        assert_eq!(of(&[]), Metadata::default());
        let known = of(&[
            ("task", "segment"),
            ("end2end", "True"),
            ("names", "{0: 'apple'}"),
        ]);
        assert_eq!(known.task, Task::BoxesAndMore);
        assert!(known.end_to_end && known.names == Some(vec!["apple".to_owned()]));
        assert!(of(&[("args", "{'batch': 1, 'nms': True}")]).end_to_end);
        assert!(!of(&[("args", "{'batch': 1, 'nms': False}"), ("end2end", "False")]).end_to_end);
    }

    #[test]
    fn tasks_without_upright_boxes_are_refused_by_name() {
        for (task, words) in [
            ("obb", "rotated boxes"),
            ("classify", "whole image"),
            ("depth", "`depth`"),
        ] {
            let fault = of(&[("task", task)]).check_task().unwrap_err();
            assert!(fault.problem.contains(words), "{fault:?}");
        }
        assert!(of(&[("task", "pose")]).check_task().is_ok());
    }
}
