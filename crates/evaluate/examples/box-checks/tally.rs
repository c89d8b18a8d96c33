//! What became of boxes without and with the check.

use pomona::{AppleAnswer, Status};
use std::collections::BTreeMap;

/// Confidence from which an answer is acted on.
const SURE: f64 = 0.5;

/// Boxes of one kind.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counts {
    boxes: usize,
    /// Picked, and picked with a confidence of at least [`SURE`], without the check.
    picked_without: usize,
    sure_without: usize,
    /// The same with it.
    picked: usize,
    sure: usize,
    /// Refused as holding no apple.
    no_apple: usize,
    /// Picked both ways with another confidence.
    changed: usize,
}

impl Counts {
    pub(crate) fn of(without: &[AppleAnswer], with: &[AppleAnswer]) -> Self {
        let count = |answers: &[AppleAnswer], wanted: &dyn Fn(&AppleAnswer) -> bool| {
            answers.iter().filter(|answer| wanted(answer)).count()
        };
        let sure = |a: &AppleAnswer| a.is_picked() && a.confidence.is_some_and(|c| c >= SURE);
        let both = without.iter().zip(with);
        Self {
            boxes: with.len(),
            picked_without: count(without, &AppleAnswer::is_picked),
            sure_without: count(without, &sure),
            picked: count(with, &AppleAnswer::is_picked),
            sure: count(with, &sure),
            no_apple: count(with, &|a| a.status == Status::NoApple),
            changed: both
                .filter(|(a, b)| a.is_picked() && b.is_picked() && a.confidence != b.confidence)
                .count(),
        }
    }

    fn join(&mut self, other: &Self) {
        self.boxes += other.boxes;
        self.picked_without += other.picked_without;
        self.sure_without += other.sure_without;
        self.picked += other.picked;
        self.sure += other.sure;
        self.no_apple += other.no_apple;
        self.changed += other.changed;
    }
}

/// Counts by suite and kind.
#[derive(Debug, Default)]
pub(crate) struct Table(BTreeMap<(String, &'static str), Counts>);

impl Table {
    pub(crate) fn add(&mut self, suite: &str, kind: &'static str, counts: &Counts) {
        let own = self.0.entry((suite.to_owned(), kind)).or_default();
        own.join(counts);
    }

    pub(crate) fn join(&mut self, other: Self) {
        for ((suite, kind), counts) in other.0 {
            self.add(&suite, kind, &counts);
        }
    }

    pub(crate) fn print(&self) {
        println!(
            "| suite | boxes | number | unchecked: picked | confidence ≥ 0.5 | checked: picked | confidence ≥ 0.5 | \
             of all, % | no_apple | other confidence |\n|---|---|---|---|---|---|---|---|---|---|"
        );
        for ((suite, kind), c) in &self.0 {
            println!(
                "| {suite} | {kind} | {} | {} | {} | {} | {} | {:.1} | {} | {} |",
                c.boxes,
                c.picked_without,
                c.sure_without,
                c.picked,
                c.sure,
                100.0 * c.sure as f64 / c.boxes.max(1) as f64,
                c.no_apple,
                c.changed
            );
        }
    }
}
