//! What the check of boxes is worth, whoever drew them: boxes about apples and on nothing, drawn by seed, picked with and
//! without it: `cargo run --release -p pomona-evaluate --example box-checks -- orchard@5000 harsh@5000 --count 40`.
//!
//! Arguments: suites or folders with truth, `--count N` frames of each suite, `--empty FOLDER` a frame whose boxes hold no
//! apple, `--frame FOLDER` a frame whose boxes hold apples; boxes on nothing are then drawn away from those of the
//! `--apples FILE` before it, such as the boxes of a detector with a low threshold.

mod tally;

use pomona::{CheckedFrame, Config, Picker};
use pomona_cloud::{BoxChoice, BoxImage, Frame, PixelBox, read_boxes};
use pomona_evaluate::{Subject, boxes_about, boxes_on_nothing};
use pomona_scenes::AppleTruth;
use rayon::prelude::*;
use std::error::Error;
use tally::{Counts, Table};

/// Boxes on nothing in a frame, …
const EMPTY_BOXES: usize = 10;

/// … and more of them for each of its apples.
const EMPTY_BOXES_PER_APPLE: usize = 2;

/// Boxes on nothing in a frame without truth.
const EMPTY_BOXES_OF_FRAME: usize = 300;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut names, mut count) = (Vec::new(), None);
    let (mut empty, mut frames, mut apples) = (Vec::new(), Vec::new(), None);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument}: no value"));
        match argument.as_str() {
            "--count" => count = Some(value()?.parse()?),
            "--empty" => empty.push(Frame::read(value()?)?),
            "--apples" => apples = Some(value()?),
            "--frame" => frames.push((Frame::read(value()?)?, apples.take())),
            _ => names.push(argument),
        }
    }
    let pickers = Pickers::new()?;
    let mut table = Table::default();
    for name in &names {
        let subjects = Subject::named(name, count)?;
        let tables: Vec<_> = subjects
            .par_iter()
            .enumerate()
            .map(|(i, subject)| {
                pickers
                    .of_subject(subject, i as u64)
                    .map_err(|e| e.to_string())
            })
            .collect();
        for counted in tables {
            table.join(counted?);
        }
    }
    for frame in &empty {
        let boxes = frame.boxes.clone().unwrap_or_default();
        pickers.add(&frame.id, "empty, of a file", frame, boxes, &mut table)?;
    }
    for (frame, apples) in &frames {
        pickers.of_frame(frame, apples.as_deref(), &mut table)?;
    }
    table.print();
    Ok(())
}

/// One that checks boxes, and one that does not.
struct Pickers {
    checked: Picker,
    unchecked: Picker,
}

impl Pickers {
    fn new() -> Result<Self, Box<dyn Error>> {
        let mut config = Config::default();
        let checked = Picker::new(config.clone())?;
        config.robust.check_boxes = false;
        Ok(Self {
            checked,
            unchecked: Picker::new(config)?,
        })
    }

    fn of_subject(&self, subject: &Subject, seed: u64) -> Result<Table, Box<dyn Error>> {
        let made = subject.load()?;
        let (frame, apples) = (&made.frame, &made.truth.apples);
        let mut table = Table::default();
        for (kind, least, most) in [
            ("apples 60 to 100 % visible", 0.6, 2.0),
            ("apples 30 to 60 % visible", 0.3, 0.6),
            ("apples less visible", 0.0, 0.3),
        ] {
            let visible =
                |apple: &&AppleTruth| (least..most).contains(&apple.visible_share.unwrap_or(1.0));
            let of_kind: Vec<AppleTruth> = apples.iter().filter(visible).cloned().collect();
            let mut boxes: Vec<PixelBox> = of_kind.iter().map(|a| a.bounds.clone()).collect();
            boxes.extend(boxes_about(&of_kind, frame, seed));
            self.add(&subject.suite, kind, frame, boxes, &mut table)?;
        }
        let count = EMPTY_BOXES + EMPTY_BOXES_PER_APPLE * apples.len();
        let boxes = boxes_on_nothing(apples, frame, count, seed);
        self.add(&subject.suite, "empty", frame, boxes, &mut table)?;
        Ok(table)
    }

    fn of_frame(
        &self,
        frame: &Frame,
        apples: Option<&str>,
        table: &mut Table,
    ) -> Result<(), Box<dyn Error>> {
        let own = frame.boxes.clone().unwrap_or_default();
        let mut known: Vec<AppleTruth> = own.iter().map(known_by_box).collect();
        self.add(&frame.id, "apples, its own boxes", frame, own, table)?;
        if let Some(file) = apples {
            let image = BoxImage::new(frame.color.width, frame.color.height);
            let more = read_boxes(file, &image, &BoxChoice::default())?;
            known.extend(more.value.iter().map(known_by_box));
        }
        let boxes = boxes_on_nothing(&known, frame, EMPTY_BOXES_OF_FRAME, 0);
        self.add(&frame.id, "empty", frame, boxes, table)
    }

    /// Picks `boxes` both ways and counts.
    fn add(
        &self,
        suite: &str,
        kind: &'static str,
        frame: &Frame,
        boxes: Vec<PixelBox>,
        table: &mut Table,
    ) -> Result<(), Box<dyn Error>> {
        if boxes.is_empty() {
            return Ok(());
        }
        let mut frame = frame.clone();
        frame.boxes = Some(boxes);
        let frame = CheckedFrame::new(&frame)?;
        let without = self.unchecked.pick(&frame, 0, None)?;
        let with = self.checked.pick(&frame, 0, None)?;
        table.add(suite, kind, &Counts::of(&without.apples, &with.apples));
        Ok(())
    }
}

/// An apple of which nothing but its box is known.
fn known_by_box(bounds: &PixelBox) -> AppleTruth {
    AppleTruth {
        bounds: bounds.clone(),
        center: [0.0; 3],
        radius: 0.0,
        branch: None,
        direction: None,
        target: None,
        visible_share: None,
        leaves: None,
    }
}
