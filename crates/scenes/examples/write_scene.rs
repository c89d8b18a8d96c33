//! Writes the first scene of a suite as a frame folder.
//!
//! `cargo run -p pomona-scenes --example write_scene SUITE FOLDER`

use pomona_scenes::Suite;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [suite, folder] = arguments.as_slice() else {
        return Err("usage: write_scene SUITE FOLDER".into());
    };
    let scene = Suite::named(suite)?
        .scenes()
        .next()
        .ok_or("the suite is empty")?;
    scene.write(folder)?;
    println!(
        "{} with {} apples in {folder}",
        scene.frame.id,
        scene.truth.apples.len()
    );
    Ok(())
}
