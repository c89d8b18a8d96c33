use crate::{
    Chain, Constraints, Estimator, FixedCount, LocalOptimization, Lossless, NoRefit, Preemption,
    RansacError, Report, Sampler, Scored, Scorer, Stopping, Unconstrained, Uniform, Workspace,
    runners_up::Keep, search::Search,
};
use rand_core::Rng;

/// A search, put together from its parts.
///
/// By default samples are uniform, nothing is constrained or refitted, models are
/// given up by the lossless bound alone, and the search ends after 1000 hypotheses.
#[derive(Clone, Copy, Debug)]
pub struct Ransac<S, P = Uniform, C = Unconstrained, L = NoRefit, T = FixedCount, B = Lossless> {
    pub(crate) scorer: S,
    pub(crate) sampler: P,
    pub(crate) constraints: C,
    pub(crate) local: L,
    pub(crate) stopping: T,
    pub(crate) preemption: B,
    pub(crate) settings: Settings,
}

/// What is a number and not a part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    pub(crate) min_inliers: usize,
    /// Iterations that one thread computes in a round at most.
    pub(crate) round: usize,
    /// Threads that share a round.
    pub(crate) threads: usize,
    /// Whether the report has the noise and the covariance.
    pub(crate) covariance: bool,
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
            settings: Settings {
                min_inliers: 0,
                round: 32,
                threads: 1,
                covariance: true,
            },
        }
    }
}

impl<S, P, C, L, T, B> Ransac<S, P, C, L, T, B> {
    /// Takes samples from `sampler`.
    #[must_use]
    pub fn sampler<Q>(self, sampler: Q) -> Ransac<S, Q, C, L, T, B> {
        let Self {
            scorer,
            constraints,
            local,
            stopping,
            preemption,
            settings,
            ..
        } = self;
        Ransac {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            preemption,
            settings,
        }
    }

    /// Adds a constraint to those there are; they are asked in the order added.
    #[must_use]
    pub fn constraint<D>(self, constraint: D) -> Ransac<S, P, Chain<C, D>, L, T, B> {
        let Self {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            preemption,
            settings,
        } = self;
        let constraints = Chain {
            earlier: constraints,
            last: constraint,
        };
        Ransac {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            preemption,
            settings,
        }
    }

    /// Betters models by `local`.
    #[must_use]
    pub fn local_optimization<M>(self, local: M) -> Ransac<S, P, C, M, T, B> {
        let Self {
            scorer,
            sampler,
            constraints,
            stopping,
            preemption,
            settings,
            ..
        } = self;
        Ransac {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            preemption,
            settings,
        }
    }

    /// Ends by `stopping`.
    #[must_use]
    pub fn stopping<U>(self, stopping: U) -> Ransac<S, P, C, L, U, B> {
        let Self {
            scorer,
            sampler,
            constraints,
            local,
            preemption,
            settings,
            ..
        } = self;
        Ransac {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            preemption,
            settings,
        }
    }

    /// Gives models up by `preemption`.
    #[must_use]
    pub fn preemption<A>(self, preemption: A) -> Ransac<S, P, C, L, T, A> {
        let Self {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            settings,
            ..
        } = self;
        Ransac {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            preemption,
            settings,
        }
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
    /// meet less often; a short one gives up hopeless models by a fresher bound.
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

    /// Searches. One number is taken from `rng`, and the outcome depends on it and the data alone.
    ///
    /// # Errors
    ///
    /// [`RansacError`] says why there is no model: too few data, samples that are all
    /// degenerate, constraints never met, too few inliers.
    pub fn run<E, R>(&self, estimator: &E, rng: &mut R) -> Result<Report<E::Model>, RansacError>
    where
        E: Estimator,
        R: Rng + ?Sized,
        P: Sampler<E>,
        S: Scorer<E>,
        C: Constraints<E>,
        L: LocalOptimization<E>,
        T: Stopping,
        B: Preemption,
    {
        let mut workspace = Workspace::new();
        Search::new(self, estimator, &mut workspace, rng.next_u64()).report()
    }

    /// The same search in memory that is used again and again; the report stays in the workspace.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn run_with<'w, E, R>(
        &self,
        workspace: &'w mut Workspace<E::Model>,
        estimator: &E,
        rng: &mut R,
    ) -> Result<&'w Report<E::Model>, RansacError>
    where
        E: Estimator,
        R: Rng + ?Sized,
        P: Sampler<E>,
        S: Scorer<E>,
        C: Constraints<E>,
        L: LocalOptimization<E>,
        T: Stopping,
        B: Preemption,
    {
        let report = Search::new(self, estimator, workspace, rng.next_u64()).report()?;
        Ok(workspace.report.insert(report))
    }

    /// Searches, and gives not the best model alone but up to `models`, and 1000 at most, that differ: the best hypothesis
    /// and those next to it, however low their scores, each after its last refit.
    ///
    /// They are the candidates among which a [`Competition`](crate::Competition) chooses. No hypothesis is given up by
    /// the lossless bound, and a rule that waits to be confident of the best model ends too early for the
    /// smaller ones: better a [`FixedCount`]. One number is taken from `rng`.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run); few inliers are none.
    pub fn candidates<E, R>(
        &self,
        estimator: &E,
        models: usize,
        rng: &mut R,
    ) -> Result<Vec<Scored<E::Model>>, RansacError>
    where
        E: Estimator,
        R: Rng + ?Sized,
        P: Sampler<E>,
        S: Scorer<E>,
        C: Constraints<E>,
        L: LocalOptimization<E>,
        T: Stopping,
        B: Preemption,
    {
        let mut workspace = Workspace::new();
        let keep = Keep {
            models: models.saturating_sub(1),
            share: 0.0,
        };
        Search::keeping(keep, self, estimator, &mut workspace, rng.next_u64()).candidates()
    }
}
