//! Prints what the targets of a suite are like, and how long it took to generate them.
//!
//! `cargo run --release -p pomona-scenes --example statistics SUITE [SCENES]`

use pomona_scenes::{AppleTruth, Suite};
use pomona_statistics::inverse_cdf;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [suite, rest @ ..] = arguments.as_slice() else {
        return Err("usage: statistics SUITE [SCENES]".into());
    };
    let suite = Suite::named(suite)?;
    let count = rest.first().map_or(Ok(suite.len()), |n| n.parse())?;
    let start = Instant::now();
    let (mut targets, mut apples, mut readings) = (Vec::new(), 0, 0);
    for case in suite.cases_to(count) {
        let scene = case.scene();
        apples += scene.truth.apples.len();
        readings += scene.frame.depth.reading_count();
        let is_target = |a: &AppleTruth| a.target != Some(false);
        targets.extend(scene.truth.apples.into_iter().filter(is_target));
    }
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{}: {count} scenes in {seconds:.1} s, {apples} apples, {} targets, {} readings a scene",
        suite.name(),
        targets.len(),
        readings / count.max(1)
    );
    quantiles("distance (m)", targets.iter().map(|a| a.center[2]));
    quantiles("radius (mm)", targets.iter().map(|a| a.radius * 1e3));
    quantiles(
        "visible share",
        targets.iter().filter_map(|a| a.visible_share),
    );
    let branches = || targets.iter().filter_map(|a| a.branch.as_ref());
    println!("{} targets have a branch", branches().count());
    quantiles("branch radius (mm)", branches().map(|b| b.radius * 1e3));
    quantiles(
        "its visible length (mm)",
        branches().filter_map(|b| b.visible_length).map(|l| l * 1e3),
    );
    quantiles(
        "its visible pixels",
        branches()
            .filter_map(|b| b.visible_pixels)
            .map(|p| p as f64),
    );
    Ok(())
}

fn quantiles(name: &str, values: impl Iterator<Item = f64>) {
    let mut values: Vec<f64> = values.collect();
    let [least, tenth, half, nine_tenths, most] =
        [0.0, 0.1, 0.5, 0.9, 1.0].map(|q| inverse_cdf(&mut values, q).unwrap_or(f64::NAN));
    println!(
        "  {name:<24} least {least:8.2}  10 % {tenth:8.2}  half {half:8.2}  90 % {nine_tenths:8.2}  most {most:8.2}",
    );
}
