//! How well a sphere is found with 30 % inliers and a noise of 1.5 mm, with and without a prior on the
//! radius: 300 points of 1000 on the whole sphere or on the camera's side of it, the others uniform in
//! a cube of six radii about it.
//!
//! No fit can come nearer to that of the true inliers than the outliers near the surface allow. With σ-wide
//! densities g of the inliers and c g(0) of the outliers the Fisher information that is left is
//! ∫ x² g/(1 + c exp(x²/2)) dx; on the whole sphere c = 0.013, and the least ratio of the errors is 1.05.

mod experiment;

use experiment::{Configuration, Score, measure};

const CLOUDS: u64 = 400;

fn main() {
    println!(
        "points  prior  score     threshold  failures  median    p95  ratio to the p95 of the true inliers (mm)"
    );
    for whole in [true, false] {
        for prior in [true, false] {
            for (score, threshold) in [
                (Score::Msac, 2.5),
                (Score::Msac, 3.0),
                (Score::Marginal, 4.0),
                (Score::Marginal, 5.0),
            ] {
                let configuration = Configuration {
                    whole,
                    prior,
                    score,
                    threshold,
                    hypotheses: 500,
                };
                let figures = measure(configuration, CLOUDS);
                println!(
                    "{:<7} {prior:<6} {:<9} {threshold:<9} {:>7.1} %  {:>6.2} {:>6.2} {:>6.2}",
                    if whole { "all" } else { "near" },
                    format!("{score:?}"),
                    100.0 * figures.failures,
                    1e3 * figures.errors[0],
                    1e3 * figures.errors[1],
                    figures.errors[1] / figures.ideal[1],
                );
            }
        }
    }
}
