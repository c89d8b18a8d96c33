use pomona_ransac::Estimator;

/// An estimator whose refit can be held to a condition on the model.
///
/// This is what lets a constraint keep a refit instead of refusing it: where the best fit
/// leaves a window, the best of the fits on the window's bound is asked for. All estimators of this crate do it.
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
