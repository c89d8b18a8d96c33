//! A RANSAC engine: robust fitting of any model to any data, given a way to fit the model to a few data and to
//! measure the residuals of the others.
//!
//! The engine is independent of geometry and owns no data. Implement [`Estimator`] for a view of your own data, and
//! combine the rest from parts:
//!
//! ```
//! use pomona_ransac::{Candidates, Estimator, FixedCount, InlierCount, Ransac, RefitOnce};
//! use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
//! use std::ops::Range;
//!
//! /// Points of a plane, and lines y = slope · x + intercept through them.
//! struct Points { x: Vec<f64>, y: Vec<f64> }
//!
//! #[derive(Clone)]
//! struct Line { slope: f64, intercept: f64 }
//!
//! impl Estimator for Points {
//!     type Model = Line;
//!     const SAMPLE_SIZE: usize = 2;
//!
//!     fn len(&self) -> usize { self.x.len() }
//!
//!     fn fit(&self, sample: &[usize], candidates: &mut Candidates<Line>) {
//!         let [i, j] = [sample[0], sample[1]];
//!         let slope = (self.y[j] - self.y[i]) / (self.x[j] - self.x[i]);
//!         if slope.is_finite() {
//!             candidates.push(Line { slope, intercept: self.y[i] - slope * self.x[i] });
//!         }
//!     }
//!
//!     fn refit(&self, inliers: &[usize], _current: &Line) -> Option<Line> {
//!         let n = inliers.len() as f64;
//!         let mean = |v: &[f64]| inliers.iter().map(|&i| v[i]).sum::<f64>() / n;
//!         let (mx, my) = (mean(&self.x), mean(&self.y));
//!         let sxy: f64 = inliers.iter().map(|&i| (self.x[i] - mx) * (self.y[i] - my)).sum();
//!         let sxx: f64 = inliers.iter().map(|&i| (self.x[i] - mx).powi(2)).sum();
//!         (sxx > 0.0).then(|| Line { slope: sxy / sxx, intercept: my - sxy / sxx * mx })
//!     }
//!
//!     fn residuals(&self, line: &Line, block: Range<usize>, out: &mut [f64]) {
//!         for (r, i) in out.iter_mut().zip(block) {
//!             *r = (self.y[i] - line.slope * self.x[i] - line.intercept).abs();
//!         }
//!     }
//! }
//!
//! // Forty points on y = 2x + 1, every fourth of them an outlier.
//! let x: Vec<f64> = (0..40).map(f64::from).collect();
//! let y = x.iter().map(|x| 2.0 * x + 1.0 + if x % 4.0 == 0.0 { 50.0 + x * x } else { 0.0 });
//! let points = Points { y: y.collect(), x };
//!
//! let report = Ransac::new(InlierCount::within(0.1))
//!     .local_optimization(RefitOnce)
//!     .stopping(FixedCount::new(200))
//!     .run(&points, &mut ChaCha8Rng::seed_from_u64(7))?;
//! assert_eq!(report.inliers.len(), 30);
//! assert!((report.model.slope - 2.0).abs() < 1e-12);
//! # Ok::<(), pomona_ransac::RansacError>(())
//! ```
//!
//! # Concepts
//!
//! - An [`Estimator`] fits models to a minimal sample, refits a model to its
//!   inliers, and measures the residuals of one *block* of data at a time.
//! - A [`Sampler`] picks the sample ([`Uniform`], [`Prosac`], [`Local`], [`Pairs`]); a [`Constraint`] may reject the
//!   sample, or the model before scoring, and is checked again after every refit.
//! - A [`Scorer`] turns the residuals of a block into a gain of at most one per datum:
//!   [`InlierCount`], [`Msac`], [`MarginalScore`], or [`PerDatum`] with individual thresholds and weights. [`WithPrior`]
//!   adds what is known of the model itself.
//! - [`InitialModels`] are hypotheses that the caller has before any sample is drawn.
//! - A [`Preemption`] abandons a model before all data are scored: [`Lossless`], which never changes the result, or
//!   [`Statistical`], whose probability of changing it is a parameter.
//! - A [`LocalOptimization`] refits: [`RefitOnce`], [`LeastSquares`], [`Reweighted`], and
//!   [`NearBest`], which also refits the hypotheses that score almost as well as the best.
//! - A [`Stopping`] rule ends the search: [`FixedCount`], [`Confidence`], [`TimeBudget`], [`Until`], or a combination
//!   with [`or`](Stopping::or).
//! - The [`Report`] is computed from the final model alone, so that its score,
//!   inliers and residuals are consistent. If the estimator provides derivatives ([`Estimator::linearize`]), it
//!   contains the noise and the model's [`Covariance`].
//!
//! [`Ransac::candidates`] gives the best few models that differ instead of one, for a finer comparison of your own:
//!
//! ```
//! # use pomona_ransac::{Candidates, Estimator, FixedCount, Msac, Ransac, WithPrior};
//! # use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
//! # struct Readings(Vec<f64>);
//! # impl Estimator for Readings {
//! #     type Model = f64;
//! #     const SAMPLE_SIZE: usize = 1;
//! #     fn len(&self) -> usize { self.0.len() }
//! #     fn fit(&self, sample: &[usize], candidates: &mut Candidates<f64>) { candidates.push(self.0[sample[0]]); }
//! #     fn refit(&self, _: &[usize], _: &f64) -> Option<f64> { None }
//! #     fn residuals(&self, value: &f64, block: std::ops::Range<usize>, out: &mut [f64]) {
//! #         for (r, i) in out.iter_mut().zip(block) { *r = (self.0[i] - value).abs(); }
//! #     }
//! # }
//! // Thermometers that agree on two values; the outdoor one is near the forecast of 9 degrees.
//! let readings = Readings(vec![20.1, 19.9, 20.0, 9.1, 8.8, 9.3, 40.0]);
//! let near_forecast = |degrees: &f64| -0.5 * (degrees - 9.0).abs();
//! let best = Ransac::new(WithPrior::new(Msac::within(0.5), near_forecast))
//!     .initial_models(vec![9.0])
//!     .stopping(FixedCount::new(50))
//!     .candidates(&readings, 2, &mut ChaCha8Rng::seed_from_u64(1))?;
//! assert_eq!(best[0].model, 9.0);
//! assert_eq!(best[1].model, 20.0);
//! # Ok::<(), pomona_ransac::RansacError>(())
//! ```
//!
//! If the data contain several structures, [`Sequential`] finds one after the other among the remaining data, and a
//! [`Competition`] selects among candidate models that compete for the data.
//!
//! A [`Workspace`] is the memory of a search: with a reused one, [`Ransac::run_with`] allocates nothing.
//!
//! Randomness is a counter: iteration `i` draws from a generator keyed by (seed, `i`) alone; the seed is one number
//! taken from the caller's generator. Iterations are computed in rounds and merged in order, so the report is the
//! same, bit for bit, for any size of a round and any number of threads.
//!
//! # Not here
//!
//! Geometry, point clouds, files. The crate `pomona-fit` fits geometric primitives (sphere, line, plane, cylinder)
//! with this engine.
//!
//! # Features
//!
//! - `rayon`, off by default: `Ransac::threads` and `Ransac::parallel` distribute the work over the threads of a
//!   `rayon` pool.
//!
//! # References
//!
//! The source of each method is given at its type. The fundamental ones:
//! Fischler and Bolles 1981, "Random sample consensus", doi 10.1145/358669.358692.
//! Torr and Zisserman 2000, "MLESAC", doi 10.1006/cviu.1999.0832 (the score [`Msac`]).

mod candidates;
mod confidence;
mod constraint;
mod covariance;
mod draws;
mod engine;
mod error;
mod estimator;
mod initial_models;
mod lane;
mod linearization;
mod local;
mod noise;
mod preemption;
mod report;
mod run;
mod runners_up;
mod sampler;
mod scorer;
mod search;
mod settings;
mod shuffle;
mod stopping;
mod structures;
mod time_budget;
mod triangle;
mod workspace;

pub use candidates::Candidates;
pub use confidence::Confidence;
pub use constraint::{Chain, Constraint, Constraints, Unconstrained};
pub use covariance::Covariance;
pub use draws::Draws;
pub use engine::Ransac;
pub use error::RansacError;
pub use estimator::{BLOCK, Estimator};
pub use initial_models::{InitialModels, NoInitialModels};
pub use linearization::Linearization;
pub use local::{
    LeastSquares, LocalOptimization, NearBest, NoRefit, Refiner, RefitOnce, Reweighted, Scored,
    Then,
};
pub use preemption::{Exhaustive, Look, Lossless, MAX_LOOKS, Preemption, Statistical};
pub use report::{Counts, MAX_RULES, Rejections, Report, ResidualStatistics};
pub use sampler::{
    Anywhere, Local, Neighbourhood, Pairs, Partners, Prosac, Sampler, Spread, Uniform,
};
pub use scorer::{
    Flat, InlierCount, Kernel, Marginal, MarginalScore, Msac, PerDatum, PerDatumError, Quadratic,
    Scorer, Threshold, Tukey, WithPrior,
};
pub use shuffle::Shuffle;
pub use stopping::{Either, FixedCount, Progress, StopReason, Stopping, Until};
pub use structures::{Competition, Ended, Extraction, Instance, Selection, Sequential};
pub use time_budget::TimeBudget;
pub use triangle::MAX_PARAMETERS;
pub use workspace::Workspace;

/// Pages beside the reference.
#[cfg(any(doc, doctest))]
pub mod guide {
    // The first definition of a link wins; the one in the file is for readers of the file.
    /// [settings]: mod@settings
    #[doc = ""]
    #[doc = include_str!("../docs/own-estimator.md")]
    pub mod own_estimator {}
    #[doc = include_str!("../docs/settings.md")]
    pub mod settings {}
}

/// The examples of the README are compiled and run with those of the reference.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
