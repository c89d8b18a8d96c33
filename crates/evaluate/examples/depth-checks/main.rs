//! What depth is worth to a detector's boxes, on suites and frames with truth:
//! `cargo run --release -p pomona-evaluate --example depth-checks -- orchard harsh row --count 40`.
//!
//! Arguments: suites or folders with truth, `--frame FOLDER` for a frame that has boxes alone, `--count N` frames of
//! each suite, `--config FILE` settings, `--json`.

mod boxes;
mod fixed_detector;
mod measure;
mod poster;
mod search;
mod splits;

use fixed_detector::find;
use measure::{DepthCheckResult, measure_boxed_frame, measure_depth_checks};
use pomona::Config;
use pomona_cloud::Frame;
use pomona_detect::Detection;
use pomona_evaluate::Subject;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut names, mut frames, mut count, mut json) = (Vec::new(), Vec::new(), None, false);
    let mut config = Config::default();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument}: no value"));
        match argument.as_str() {
            "--count" => count = Some(value()?.parse()?),
            "--config" => config = Config::read(value()?)?,
            "--frame" => frames.push(Frame::read(value()?)?),
            "--json" => json = true,
            _ => names.push(argument),
        }
    }
    let mut subjects = Vec::new();
    for name in &names {
        subjects.extend(Subject::named(name, count)?);
    }
    let mut results = measure_depth_checks(&subjects, &config, 0, &|| {})?;
    for frame in &frames {
        results.push(measure_boxed_frame(frame, &config, 0)?);
    }
    if json {
        println!("{}", serde_json::to_string_pretty(&results)?);
        return Ok(());
    }
    for result in &results {
        print(result);
    }
    for frame in &frames {
        list(frame, &config)?;
    }
    Ok(())
}

/// What depth says of each box of a frame.
fn list(frame: &Frame, config: &Config) -> Result<(), Box<dyn Error>> {
    let boxes: Vec<_> = frame.boxes.iter().flatten().collect();
    let detections = boxes.iter().map(|b| Detection {
        x_min: b.x_min,
        y_min: b.y_min,
        x_max: b.x_max,
        y_max: b.y_max,
        score: b.score,
        class: 0,
    });
    let found = find(frame, detections.collect(), config)?;
    println!("{}:", frame.id);
    for found in &found.boxes {
        let numbers = found.bounds.name.split('+').filter_map(|n| n.parse().ok());
        let names: Vec<&str> = numbers
            .filter_map(|n: usize| Some(boxes.get(n)?.name.as_str()))
            .collect();
        let name = if names.is_empty() {
            found.bounds.name.clone()
        } else {
            names.join("+")
        };
        let sphere = found.sphere.map_or_else(String::new, |s| {
            format!("r {:.1} mm at {:.3} m", s.radius * 1e3, s.center.z)
        });
        println!("  {name:<10} {:<10} {sphere}", found.origin.mark.name());
    }
    Ok(())
}

fn percent(part: usize, all: usize) -> f64 {
    100.0 * part as f64 / all.max(1) as f64
}

fn print(result: &DepthCheckResult) {
    println!(
        "{}: {} frames, {:.3} ms a box",
        result.suite, result.frames, result.box_ms
    );
    for (kind, counts) in &result.marks {
        let marks: Vec<String> = counts
            .marks
            .iter()
            .map(|(name, n)| format!("{name} {n}"))
            .collect();
        println!(
            "  {kind:<17} {:>5} boxes, {:>5.1} % refused, {:>5.1} % without depth ({})",
            counts.boxes,
            percent(counts.refused, counts.boxes),
            percent(counts.no_depth, counts.boxes),
            marks.join(", ")
        );
    }
    let m = &result.merging;
    println!(
        "  of {} split boxes {:.1} % joined rightly, {:.1} % left with one; of {} whole ones {} joined and {} marked \
         wrongly",
        m.split,
        percent(m.rightly_merged, m.split),
        percent(m.left_with_one, m.split),
        m.whole,
        m.wrongly_merged,
        m.wrongly_of_another
    );
    let s = &result.search;
    println!(
        "  of {} withheld apples {} found ({} of {} well seen), {} false finds, {:.0} ms a frame",
        s.withheld,
        s.found,
        s.found_well_seen,
        s.withheld_well_seen,
        s.false_finds,
        s.total_ms / result.frames.max(1) as f64
    );
}
