//! The command line of pomona: which way to pick each apple of an RGB-D frame.
//!
//! Each command has a file of its own; none holds an algorithm.

mod apple_cloud;
mod arguments;
mod calibrate;
mod camera_pose;
mod completions;
mod config;
mod convert;
mod detect;
mod detector;
mod evaluate;
mod frame_arguments;
mod fuse;
mod image_paths;
mod inspect;
mod output_folder;
mod pick;
mod picture;
mod progress;
mod scenes;
mod segment;
mod segmenter;
mod settings;
mod summary;
mod table;
mod terminal;
mod wood;

use std::io::ErrorKind;
use std::process::ExitCode;

/// What the program ends with where the input was bad, as for a wrong command line.
const BAD_INPUT: u8 = 2;

fn main() -> ExitCode {
    let arguments = arguments::Arguments::read();
    let terminal = terminal::Terminal::new(arguments.color);
    match arguments.run(terminal) {
        Ok(()) => ExitCode::SUCCESS,
        // Whoever reads our output has seen enough, as `head` does.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            terminal.error(&error);
            ExitCode::from(BAD_INPUT)
        }
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let source = error.downcast_ref::<std::io::Error>();
    source.is_some_and(|e| e.kind() == ErrorKind::BrokenPipe)
}
