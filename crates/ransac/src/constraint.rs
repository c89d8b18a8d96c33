use crate::Estimator;

/// A rule that a model must obey, asked before any scoring and again after every refit.
///
/// ```
/// use pomona_ransac::{Constraint, Estimator};
///
/// /// Refuses lines steeper than a limit.
/// struct SlopeAtMost(f64);
///
/// # struct Line { slope: f64 }
/// # trait Sloped { fn slope(&self) -> f64; }
/// impl<E: Estimator> Constraint<E> for SlopeAtMost where E::Model: Sloped {
///     fn name(&self) -> &'static str { "slope" }
///     fn allows_model(&self, _: &E, line: &E::Model) -> bool { line.slope().abs() <= self.0 }
/// }
/// ```
pub trait Constraint<E: Estimator>: Sync {
    /// What the report calls it.
    fn name(&self) -> &'static str;

    /// Whether a minimal sample is worth fitting; by default every one is.
    fn allows_sample(&self, _estimator: &E, _sample: &[usize]) -> bool {
        true
    }

    /// Whether a model obeys the rule. A model with NaN should not.
    fn allows_model(&self, estimator: &E, model: &E::Model) -> bool;

    /// A model in place of a `refit` that the rule refuses: the best that obeys it for these
    /// inliers and weights (`None` where each counts 1). By default there is none, and the refit is refused.
    ///
    /// All rules are asked about what it gives before it is taken.
    fn restore(
        &self,
        _estimator: &E,
        _inliers: &[usize],
        _weights: Option<&[f64]>,
        _refit: &E::Model,
    ) -> Option<E::Model> {
        None
    }
}

/// Any number of [`Constraint`]s, built by [`Ransac::constraint`](crate::Ransac::constraint).
///
/// Rules are numbered in the order in which they were added.
pub trait Constraints<E: Estimator>: Sync {
    /// How many rules there are.
    fn len(&self) -> usize;

    /// Whether there is no rule.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Name of a rule.
    fn name(&self, rule: usize) -> &'static str;

    /// The first rule that refuses a sample, if any does.
    fn refusing_sample(&self, estimator: &E, sample: &[usize]) -> Option<usize>;

    /// The first rule that refuses a model, if any does.
    fn refusing_model(&self, estimator: &E, model: &E::Model) -> Option<usize>;

    /// What a rule gives in place of a refit that it refuses: [`Constraint::restore`].
    fn restore(
        &self,
        _rule: usize,
        _estimator: &E,
        _inliers: &[usize],
        _weights: Option<&[f64]>,
        _refit: &E::Model,
    ) -> Option<E::Model> {
        None
    }
}

/// A refit that all rules allow, if need be restored by the one that refuses it; else the rule that refused.
pub(crate) fn allowed<E: Estimator>(
    constraints: &impl Constraints<E>,
    estimator: &E,
    inliers: &[usize],
    weights: Option<&[f64]>,
    refit: E::Model,
) -> Result<E::Model, usize> {
    let Some(rule) = constraints.refusing_model(estimator, &refit) else {
        return Ok(refit);
    };
    constraints
        .restore(rule, estimator, inliers, weights, &refit)
        .filter(|model| constraints.refusing_model(estimator, model).is_none())
        .ok_or(rule)
}

/// No constraint at all.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unconstrained;

impl<E: Estimator> Constraints<E> for Unconstrained {
    fn len(&self) -> usize {
        0
    }
    fn name(&self, _: usize) -> &'static str {
        ""
    }
    fn refusing_sample(&self, _: &E, _: &[usize]) -> Option<usize> {
        None
    }
    fn refusing_model(&self, _: &E, _: &E::Model) -> Option<usize> {
        None
    }
}

/// Earlier constraints, and one more.
#[derive(Clone, Copy, Debug)]
pub struct Chain<Earlier, Last> {
    pub(crate) earlier: Earlier,
    pub(crate) last: Last,
}

impl<E: Estimator, A: Constraints<E>, B: Constraint<E>> Constraints<E> for Chain<A, B> {
    fn len(&self) -> usize {
        self.earlier.len() + 1
    }

    fn name(&self, rule: usize) -> &'static str {
        if rule < self.earlier.len() {
            self.earlier.name(rule)
        } else {
            self.last.name()
        }
    }

    fn refusing_sample(&self, estimator: &E, sample: &[usize]) -> Option<usize> {
        self.earlier
            .refusing_sample(estimator, sample)
            .or_else(|| (!self.last.allows_sample(estimator, sample)).then(|| self.earlier.len()))
    }

    fn refusing_model(&self, estimator: &E, model: &E::Model) -> Option<usize> {
        self.earlier
            .refusing_model(estimator, model)
            .or_else(|| (!self.last.allows_model(estimator, model)).then(|| self.earlier.len()))
    }

    fn restore(
        &self,
        rule: usize,
        estimator: &E,
        inliers: &[usize],
        weights: Option<&[f64]>,
        refit: &E::Model,
    ) -> Option<E::Model> {
        if rule < self.earlier.len() {
            self.earlier
                .restore(rule, estimator, inliers, weights, refit)
        } else {
            self.last.restore(estimator, inliers, weights, refit)
        }
    }
}
