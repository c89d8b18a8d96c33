//! Fits the two models of the method `robust` to scenes: `cargo xtask fit-wood` and `cargo xtask fit-confidence`.
//!
//! Each is a logistic model, of 'this candidate is wood' and of 'the direction is at most 20 degrees off'. Prints the
//! coefficients beside those in use, and how both do in a cross-validation over the scenes. `spread` shows on the same
//! scenes how well the stated uncertainties hold: `cargo xtask fit-spread`.

mod answers;
mod candidates;
mod logistic;
mod scenes;
mod spread;

use pomona::{CONFIDENCE_FEATURES, CONFIDENCE_MODEL, WOOD_FEATURES, WOOD_MODEL};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    match std::env::args().nth(1).as_deref() {
        Some("wood") => {
            let observations = scenes::observe(&candidates::of_scene)?;
            logistic::print(&WOOD_FEATURES, &WOOD_MODEL, &observations)
        }
        Some("confidence") => {
            let observations = scenes::observe(&answers::of_scene)?;
            logistic::print(&CONFIDENCE_FEATURES, &CONFIDENCE_MODEL, &observations)
        }
        Some("spread") => {
            spread::print(&scenes::observe(&spread::of_scene)?);
            Ok(())
        }
        _ => Err("which one: `wood`, `confidence` or `spread`?".into()),
    }
}
