use pomona_ransac::Estimator;

/// An estimator whose refit can be held to a condition on the model.
///
/// This is what lets a constraint keep a refit instead of refusing it: where the best fit
/// leaves a window, the best of the fits on the window's bound is asked for. All estimators of this crate do it.
///
/// A constraint of one's own, for spheres that stand on a table:
///
/// ```
/// use pomona_fit::{HeldRefit, Points, SphereEstimator, SphereRefit};
/// use pomona_geometry::Sphere;
/// use pomona_ransac::{Constraint, FixedCount, LeastSquares, Msac, Ransac};
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
///
/// /// Spheres that do not reach below z = 0.
/// struct OnTheTable;
///
/// impl<E: HeldRefit<Model = Sphere>> Constraint<E> for OnTheTable {
///     fn name(&self) -> &'static str { "table" }
///     fn allows_model(&self, _: &E, s: &Sphere) -> bool { s.center.z >= s.radius }
///     fn restore(
///         &self, estimator: &E, inliers: &[usize], weights: Option<&[f64]>, refit: &Sphere,
///     ) -> Option<Sphere> {
///         // A little above, so that rounding does not break the rule.
///         let height = |s: &Sphere| s.center.z - s.radius - 1e-9;
///         estimator.refit_held(inliers, weights, refit, &height)
///     }
/// }
///
/// // The upper half of a ball, measured 1 mm too low, with an error of as much.
/// let (mut x, mut y, mut z) = (vec![], vec![], vec![]);
/// for i in 0..300 {
///     let (up, a) = (f64::from(i) / 300.0, f64::from(i) * 2.4);
///     let across = (1.0 - up * up).sqrt();
///     x.push(0.04 * across * a.cos());
///     y.push(0.04 * across * a.sin());
///     z.push(0.04 * up + 0.039 + 0.001 * (f64::from(i) * 1.7).sin());
/// }
/// let estimator = SphereEstimator::new(Points::new(&x, &y, &z)?, SphereRefit::Geometric);
/// let report = Ransac::new(Msac::within(0.005))
///     .constraint(OnTheTable)
///     .local_optimization(LeastSquares::default())
///     .stopping(FixedCount::new(500))
///     .run(&estimator, &mut ChaCha8Rng::seed_from_u64(1))?;
/// assert!((report.model.center.z - report.model.radius).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait HeldRefit: Estimator {
    /// Among the models for which `condition` is zero, the one near `start` with the least sum of squared
    /// distances to `inliers`, each with its weight of `weights` if they are given, and with the
    /// prior if the estimator has one.
    ///
    /// `condition` should be smooth about `start` and of order one (a length divided by the window's
    /// width, say): it is fulfilled to 1e-11. Its derivatives are taken by differences.
    /// `None` where no model near `start` fulfils it, and where the inliers do not determine one.
    fn refit_held(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        start: &Self::Model,
        condition: &dyn Fn(&Self::Model) -> f64,
    ) -> Option<Self::Model>;
}
