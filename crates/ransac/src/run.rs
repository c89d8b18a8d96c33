use crate::{
    Constraints, Estimator, InitialModels, LocalOptimization, Preemption, Ransac, RansacError,
    Report, Sampler, Scored, Scorer, Stopping, Workspace, runners_up::Keep, search::Search,
};
use rand_core::Rng;

impl<S, P, C, L, T, B, G> Ransac<S, P, C, L, T, B, G> {
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
        G: InitialModels<E::Model>,
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
        G: InitialModels<E::Model>,
    {
        let report = Search::new(self, estimator, workspace, rng.next_u64()).report()?;
        Ok(workspace.report.insert(report))
    }

    /// Searches, and gives not the best model alone but up to `models`, and 1000 at most, that differ: the best hypothesis
    /// and those next to it, however low their scores, each after its last refit.
    ///
    /// Two hypotheses differ where less than four fifths of the union of their inliers are common to both. They are the
    /// candidates among which a [`Competition`](crate::Competition) chooses, or a finer comparison of the caller's. A rule
    /// that waits to be confident of the best model ends too early for the smaller ones: better a
    /// [`FixedCount`](crate::FixedCount). One number is taken from `rng`.
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
        G: InitialModels<E::Model>,
    {
        let mut workspace = Workspace::new();
        let keep = Keep {
            models: models.saturating_sub(1),
            share: None,
        };
        Search::keeping(keep, self, estimator, &mut workspace, rng.next_u64()).candidates()
    }
}
