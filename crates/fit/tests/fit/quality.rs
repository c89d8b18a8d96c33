//! A sphere with 30 % inliers and a noise of 1.5 mm; the example `sphere_quality` prints more of the same.

#[path = "../../examples/sphere_quality/experiment.rs"]
mod experiment;

use experiment::{Configuration, Score, measure};

#[test]
fn a_sphere_is_found_as_if_the_outliers_were_known() {
    for (prior, failures) in [(true, 0.02), (false, 0.1)] {
        let whole = Configuration {
            whole: true,
            prior,
            score: Score::Msac,
            threshold: 3.0,
            hypotheses: 500,
        };
        let found = measure(whole, 400);
        println!("{whole:?} {found:?}");
        assert!(found.failures <= failures, "{found:?}");
        // The bound for any fit is 1.05.
        assert!(found.errors[1] <= 1.1 * found.ideal[1], "{found:?}");
        assert!(found.errors[0] <= 1.1 * found.ideal[0], "{found:?}");

        let near_side = Configuration {
            whole: false,
            score: Score::Marginal,
            threshold: 4.0,
            ..whole
        };
        let found = measure(near_side, 200);
        println!("{near_side:?} {found:?}");
        assert!(found.failures <= failures, "{found:?}");
        // Outliers behind the sphere have more leverage than points of its near side.
        assert!(found.errors[1] <= 1.35 * found.ideal[1], "{found:?}");
    }
}
