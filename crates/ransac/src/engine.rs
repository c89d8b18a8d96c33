use crate::{
    Chain, FixedCount, Lossless, NoInitialModels, NoRefit, Unconstrained, Uniform,
    settings::Settings,
};

/// A search, put together from its parts.
///
/// By default samples are uniform, nothing is constrained or refitted, models are
/// abandoned by the lossless bound alone, no model is known beforehand, and the search ends after 1000 hypotheses.
#[derive(Clone, Copy, Debug)]
pub struct Ransac<
    S,
    P = Uniform,
    C = Unconstrained,
    L = NoRefit,
    T = FixedCount,
    B = Lossless,
    G = NoInitialModels,
> {
    pub(crate) scorer: S,
    pub(crate) sampler: P,
    pub(crate) constraints: C,
    pub(crate) local: L,
    pub(crate) stopping: T,
    pub(crate) preemption: B,
    pub(crate) initial: G,
    pub(crate) settings: Settings,
}

/// The search with one part replaced by another of any type; the parts that stay are named.
macro_rules! with_part {
    ($search:ident, $new:ident; $($kept:ident),*) => {{
        let Self { $($kept,)* .. } = $search;
        Ransac { $new, $($kept),* }
    }};
}

impl<S> Ransac<S> {
    /// A search for the model that `scorer` likes best.
    pub fn new(scorer: S) -> Self {
        Self {
            scorer,
            sampler: Uniform,
            constraints: Unconstrained,
            local: NoRefit,
            stopping: FixedCount::new(1000),
            preemption: Lossless::default(),
            initial: NoInitialModels,
            settings: Settings::default(),
        }
    }
}

impl<S, P, C, L, T, B, G> Ransac<S, P, C, L, T, B, G> {
    /// Draws samples with `sampler`.
    #[must_use]
    pub fn sampler<Q>(self, sampler: Q) -> Ransac<S, Q, C, L, T, B, G> {
        with_part!(self, sampler; scorer, constraints, local, stopping, preemption, initial, settings)
    }

    /// Adds a constraint to those there are; they are asked in the order added.
    #[must_use]
    pub fn constraint<D>(self, constraint: D) -> Ransac<S, P, Chain<C, D>, L, T, B, G> {
        let constraints = Chain {
            earlier: self.constraints,
            last: constraint,
        };
        with_part!(self, constraints; scorer, sampler, local, stopping, preemption, initial, settings)
    }

    /// Improves models with `local`.
    #[must_use]
    pub fn local_optimization<M>(self, local: M) -> Ransac<S, P, C, M, T, B, G> {
        with_part!(self, local; scorer, sampler, constraints, stopping, preemption, initial, settings)
    }

    /// Ends the search by the rule `stopping`.
    #[must_use]
    pub fn stopping<U>(self, stopping: U) -> Ransac<S, P, C, L, U, B, G> {
        with_part!(self, stopping; scorer, sampler, constraints, local, preemption, initial, settings)
    }

    /// Rejects hopeless models early by the rule `preemption`.
    #[must_use]
    pub fn preemption<A>(self, preemption: A) -> Ransac<S, P, C, L, T, A, G> {
        with_part!(self, preemption; scorer, sampler, constraints, local, stopping, initial, settings)
    }

    /// Compares models that are known beforehand before it draws the first sample: see
    /// [`InitialModels`](crate::InitialModels).
    ///
    /// ```
    /// use pomona_ransac::{Msac, Ransac};
    ///
    /// // The line found in the frame before, as slope and intercept.
    /// let previous = [(2.0, 1.0)];
    /// let search = Ransac::new(Msac::within(0.1)).initial_models(&previous[..]);
    /// ```
    #[must_use]
    pub fn initial_models<H>(self, initial: H) -> Ransac<S, P, C, L, T, B, H> {
        with_part!(self, initial; scorer, sampler, constraints, local, stopping, preemption, settings)
    }

    /// Gives no model with fewer inliers than this, or than a minimal sample has.
    #[must_use]
    pub fn min_inliers(mut self, min_inliers: usize) -> Self {
        self.settings.min_inliers = min_inliers;
        self
    }

    /// Whether the report has the noise and the covariance of the model, where the estimator gives
    /// derivatives; `true` by default.
    ///
    /// They take one pass over the inliers, which counts where a search takes less than a millisecond.
    #[must_use]
    pub fn covariance(mut self, wanted: bool) -> Self {
        self.settings.covariance = wanted;
        self
    }

    /// Computes at most this many iterations on one thread before the best score is brought up to
    /// date; 32 by default, and 0 is taken as 1.
    ///
    /// Only the speed depends on it. A long round reads the data less often and lets the threads
    /// meet less often; a short one abandons hopeless models by a fresher bound.
    #[must_use]
    pub fn round(mut self, iterations: usize) -> Self {
        self.settings.round = iterations.max(1);
        self
    }

    /// Shares the work among `threads` tasks of the current `rayon` pool; 0 is taken as 1, and
    /// more than 1024 as 1024.
    ///
    /// Only the speed depends on it: the report is the same for any number of threads, bit for bit.
    #[cfg(feature = "rayon")]
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.settings.threads = threads.clamp(1, 1024);
        self
    }

    /// Shares the work among all threads of the current `rayon` pool.
    #[cfg(feature = "rayon")]
    #[must_use]
    pub fn parallel(self) -> Self {
        self.threads(rayon::current_num_threads())
    }
}
