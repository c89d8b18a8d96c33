//! The methods that the estimators over a view of points share, each written once.
//!
//! They expand within the `impl` of an estimator that has a field `points`. A macro and not a trait with defaults:
//! the engine's trait has defaults already, and these are the faster ones of those who keep points.

/// `len`, `residuals` and `residuals_of` by the distance of a point from the model, and `same_model`.
macro_rules! residuals_by_distance {
    ($model:ty, $distance:ident $(, $absolute:ident)?) => {
        fn len(&self) -> usize {
            self.points.len()
        }

        fn residuals(&self, model: &$model, block: Range<usize>, out: &mut [f64]) {
            for (r, i) in out.iter_mut().zip(block) {
                *r = model.$distance(&self.points.get(i))$(.$absolute())?;
            }
        }

        fn residuals_of(&self, model: &$model, data: &[usize], out: &mut [f64]) {
            for (r, &i) in out.iter_mut().zip(data) {
                *r = model.$distance(&self.points.get(i))$(.$absolute())?;
            }
        }

        fn same_model(&self, one: &$model, other: &$model) -> bool {
            one == other
        }
    };
}

/// `count_within`, `truncated_gain` and `select_within` by the kernel that `$kernel` makes of a model and a threshold.
macro_rules! scores_by_kernel {
    ($model:ty, $kernel:expr) => {
        fn count_within(&self, model: &$model, block: Range<usize>, threshold: f64) -> usize {
            simd::count(self.points.block(block), $kernel(model, threshold))
        }

        fn truncated_gain(&self, model: &$model, block: Range<usize>, threshold: f64) -> f64 {
            if threshold == 0.0 {
                return self.count_within(model, block, threshold) as f64;
            }
            simd::gain(self.points.block(block), $kernel(model, threshold))
        }

        fn select_within(
            &self,
            model: &$model,
            block: Range<usize>,
            threshold: f64,
            out: &mut Vec<usize>,
        ) {
            let first = block.start;
            simd::select(
                self.points.block(block),
                first,
                $kernel(model, threshold),
                out,
            );
        }
    };
}

/// `refit` and `refit_weighted` by the estimator's own `geometric` least squares.
macro_rules! geometric_refits {
    ($model:ty) => {
        fn refit(&self, inliers: &[usize], current: &$model) -> Option<$model> {
            self.geometric(inliers, None, current, None)
        }

        fn refit_weighted(
            &self,
            inliers: &[usize],
            weights: &[f64],
            current: &$model,
        ) -> Option<$model> {
            self.geometric(inliers, Some(weights), current, None)
        }
    };
}

/// `refit_held` by the method `$fit`, which takes a condition.
macro_rules! held_refit {
    ($model:ty, $fit:ident) => {
        fn refit_held(
            &self,
            inliers: &[usize],
            weights: Option<&[f64]>,
            start: &$model,
            condition: &dyn Fn(&$model) -> f64,
        ) -> Option<$model> {
            self.$fit(inliers, weights, start, Some(condition))
        }
    };
}

/// The builder method `prior` of an estimator with a field `knowledge`.
macro_rules! radius_prior {
    () => {
        /// Refits use a prior on the radius; `point_sigma` is the standard deviation of the points about the model.
        ///
        /// # Errors
        ///
        /// Unless `point_sigma` is positive and finite.
        pub fn prior(self, prior: RadiusPrior, point_sigma: f64) -> Result<Self, PriorError> {
            let knowledge = Some(Knowledge::new(prior, point_sigma)?);
            Ok(Self { knowledge, ..self })
        }
    };
}

pub(crate) use {
    geometric_refits, held_refit, radius_prior, residuals_by_distance, scores_by_kernel,
};
