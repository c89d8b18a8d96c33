//! How alike rendered and real frames are: statistics of depth, colour classes and wood about boxed apples, and what the
//! methods do on them, as the table of docs/scenes.md.
//!
//! `cargo run --release -p pomona-cli --example likeness -- [--count N] [--no-methods] [--variant FILE] SUITE...
//! [--real FOLDER... --strokes FILE --apples FILE --calipers FILE]`
//!
//! `SUITE@1000` are the scenes of a suite from seed 1000 on. A folder of `--real` is a frame with boxes, in which a
//! person has drawn wood. A part of the figures needs the built-in segmenter.

mod answers;
mod arguments;
mod source;
mod statistics;

use arguments::Arguments;
use pomona_segment::{CloseUps, SegmenterOptions};
use source::Source;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse(std::env::args().skip(1))?;
    let options = SegmenterOptions::default();
    let (segmenter, close_ups) = (options.open()?, CloseUps::open(&options)?);
    let mut columns = Vec::new();
    for name in &arguments.suites {
        columns.push(Source::of_suite(name, arguments.count)?);
    }
    if !arguments.real.is_empty() {
        columns.push(Source::of_frames(&arguments)?);
    }
    let mut table: Vec<(String, Vec<String>)> = Vec::new();
    for (number, source) in columns.iter_mut().enumerate() {
        let mut rows = statistics::rows(source, &*segmenter)?;
        if arguments.methods {
            rows.extend(answers::rows(source, &close_ups, &arguments.variants)?);
        }
        for (name, value) in rows {
            match table.iter_mut().find(|row| row.0 == name) {
                Some(row) => row.1.resize(number, String::new()),
                None => table.push((name.clone(), vec![String::new(); number])),
            }
            if let Some(row) = table.iter_mut().find(|row| row.0 == name) {
                row.1.push(value);
            }
        }
    }
    let names: Vec<&str> = columns.iter().map(|source| &*source.name).collect();
    println!("| | {} |", names.join(" | "));
    println!("|---|{}", "---|".repeat(names.len()));
    for (name, mut cells) in table {
        cells.resize(names.len(), String::new());
        println!("| {name} | {} |", cells.join(" | "));
    }
    Ok(())
}
