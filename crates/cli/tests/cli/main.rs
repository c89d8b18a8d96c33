//! The program as its users run it: arguments in; files, output and exit codes out.

#![allow(
    clippy::unwrap_used,
    reason = "the functions that tests share are tests too"
)]

mod bad_files;
mod bad_frames;
mod binary;
mod box_files;
mod calibrate;
mod camera_poses;
mod cameras;
mod convert;
mod detect;
mod detected;
mod detection;
mod fuse;
mod inspect;
mod large_fruit;
mod pick;
mod real;
mod real_frames;
mod robot;
mod scene;
mod scenes;
mod schema;
mod segment;
mod settings;
mod shell;
mod tutorial;
mod warnings;
mod wood;
