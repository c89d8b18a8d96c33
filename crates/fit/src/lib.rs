//! Geometric primitives fitted to points: minimal solvers, least squares, geometric refinement, and estimators for a
//! RANSAC search.
//!
//! ```
//! use pomona_fit::{Points, RadiusWindow, SphereEstimator, SphereRefit};
//! use pomona_ransac::{FixedCount, InlierCount, Ransac, RefitOnce};
//! use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
//!
//! // The camera's side of a sphere of 40 mm at 0.8 m, every fifth point an outlier.
//! let (mut x, mut y, mut z) = (vec![], vec![], vec![]);
//! for i in 0..500 {
//!     let (s, a) = ((f64::from(i) / 500.0).sqrt(), f64::from(i) * 2.4);
//!     let r = if i % 5 == 0 { 0.055 } else { 0.04 };
//!     x.push((r * s * a.cos()) as f32);
//!     y.push((r * s * a.sin()) as f32);
//!     z.push((0.8 - r * (1.0 - s * s).sqrt()) as f32);
//! }
//! let estimator = SphereEstimator::new(Points::new(&x, &y, &z)?, SphereRefit::Algebraic);
//!
//! let report = Ransac::new(InlierCount::within(0.001))
//!     .constraint(RadiusWindow::new(0.02, 0.05)?)
//!     .local_optimization(RefitOnce)
//!     .stopping(FixedCount::new(200))
//!     .run(&estimator, &mut ChaCha8Rng::seed_from_u64(1))?;
//! assert!((report.model.radius - 0.04).abs() < 1e-6);
//! assert_eq!(report.inliers.len(), 400);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Concepts
//!
//! - [`Points`] is a view of three coordinate arrays of `f32` or `f64`; nothing is copied. Scoring uses that type,
//!   all fitting uses `f64`.
//! - A solver is a plain function from points to a primitive. A sample or a set that does
//!   not determine the primitive (coincident, collinear, coplanar, not finite) gives `None`.
//!   Minimal solvers are called `…_through`; the refits `…_geometric` and `…_weighted` take an initial estimate and
//!   never worsen it.
//! - An estimator ([`SphereEstimator`], [`LineEstimator`], [`PlaneEstimator`], [`CylinderEstimator`],
//!   [`CapsuleEstimator`], [`CircleEstimator`]) adapts a primitive to `pomona-ransac`. The minimal sample of a sphere
//!   can be chosen: [`FourPoints`], [`ThreePointsAndRadius`], [`TwoNormals`].
//! - A [`RadiusPrior`] enters refits like one additional measurement.
//! - Constraints ([`RadiusWindow`], [`DistanceWindow`], [`AngleWindow`], [`CenterSide`], [`FootSide`]) hold in the
//!   search, and a refit that violates one is repeated under it: [`HeldRefit`] finds the best fit on the bound.
//!   [`Refusing`] rejects such a refit instead.
//! - The covariance in a report is that of the primitive's local parameters, which the documentation of its estimator
//!   names.
//!
//! # Not here
//!
//! Cameras, noise models, and the meaning of the points.

mod capsule;
mod chart;
mod circle;
mod constraint;
mod coordinate;
mod cylinder;
mod held;
mod levenberg;
mod line;
mod measure;
mod moments;
mod plane;
mod points;
mod prior;
mod shared_methods;
mod simd;
mod sphere;

pub use capsule::{CapsuleEstimator, capsule_along};
pub use circle::{CircleEstimator, circle_geometric, circle_through, circle_weighted};
pub use constraint::{
    AngleWindow, CenterSide, DistanceWindow, FootSide, RadiusWindow, Refusing, WindowError,
};
pub use coordinate::Coordinate;
pub use cylinder::{
    CylinderEstimator, cylinder_geometric, cylinder_near_line, cylinder_through, cylinder_weighted,
};
pub use held::HeldRefit;
pub use line::{LineEstimator, line_least_squares};
pub use measure::{Centered, Directed, Round, Straight};
pub use plane::{PlaneEstimator, plane_least_squares};
pub use points::{Points, PointsError};
pub use prior::{PriorError, RadiusPrior};
pub use sphere::{
    FourPoints, SphereEstimator, SphereRefit, SphereSample, ThreePointsAndRadius, TwoNormals,
    sphere_geometric, sphere_least_squares, sphere_through, sphere_through_normals,
    sphere_weighted, spheres_of_radius,
};
