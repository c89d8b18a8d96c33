use crate::{
    Candidates, Chain, Constraints, Counts, Draws, Estimator, FixedCount, LocalOptimization,
    NoRefit, Progress, RansacError, Refiner, Rejections, Report, Sampler, Scored, Scorer,
    StopReason, Stopping, Unconstrained, Uniform, report::residual_statistics,
};
use rand_core::Rng;

/// A search, put together from its parts.
///
/// By default samples are uniform, nothing is constrained or refitted, and the search
/// ends after 1000 hypotheses.
#[derive(Clone, Copy, Debug)]
pub struct Ransac<S, P = Uniform, C = Unconstrained, L = NoRefit, T = FixedCount> {
    scorer: S,
    sampler: P,
    constraints: C,
    local: L,
    stopping: T,
    min_inliers: usize,
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
            min_inliers: 0,
        }
    }
}

impl<S, P, C, L, T> Ransac<S, P, C, L, T> {
    /// Takes samples from `sampler`.
    #[must_use]
    pub fn sampler<Q>(self, sampler: Q) -> Ransac<S, Q, C, L, T> {
        let Self {
            scorer,
            constraints,
            local,
            stopping,
            min_inliers,
            ..
        } = self;
        Ransac {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            min_inliers,
        }
    }

    /// Adds a constraint to those there are; they are asked in the order added.
    #[must_use]
    pub fn constraint<D>(self, constraint: D) -> Ransac<S, P, Chain<C, D>, L, T> {
        let Self {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            min_inliers,
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
            min_inliers,
        }
    }

    /// Betters models by `local`.
    #[must_use]
    pub fn local_optimization<M>(self, local: M) -> Ransac<S, P, C, M, T> {
        let Self {
            scorer,
            sampler,
            constraints,
            stopping,
            min_inliers,
            ..
        } = self;
        Ransac {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            min_inliers,
        }
    }

    /// Ends by `stopping`.
    #[must_use]
    pub fn stopping<U>(self, stopping: U) -> Ransac<S, P, C, L, U> {
        let Self {
            scorer,
            sampler,
            constraints,
            local,
            min_inliers,
            ..
        } = self;
        Ransac {
            scorer,
            sampler,
            constraints,
            local,
            stopping,
            min_inliers,
        }
    }

    /// Gives no model with fewer inliers than this, or than a minimal sample has.
    #[must_use]
    pub fn min_inliers(self, min_inliers: usize) -> Self {
        Self {
            min_inliers,
            ..self
        }
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
    {
        let seed = rng.next_u64();
        if estimator.len() < E::SAMPLE_SIZE {
            return Err(RansacError::TooFewData {
                needed: E::SAMPLE_SIZE,
                available: estimator.len(),
            });
        }
        let mut search = Search::new(self, estimator);
        let stopped = search.run(seed)?;
        search.finish(stopped)
    }
}

/// The state of one run.
struct Search<'a, E: Estimator, S, P, C, L, T> {
    parts: &'a Ransac<S, P, C, L, T>,
    estimator: &'a E,
    counts: Counts,
    progress: Progress,
    best: Option<Scored<E::Model>>,
    sample: Vec<usize>,
    candidates: Candidates<E::Model>,
    inliers: Vec<usize>,
}

impl<'a, E, S, P, C, L, T> Search<'a, E, S, P, C, L, T>
where
    E: Estimator,
    P: Sampler<E>,
    S: Scorer<E>,
    C: Constraints<E>,
    L: LocalOptimization<E>,
    T: Stopping,
{
    fn new(parts: &'a Ransac<S, P, C, L, T>, estimator: &'a E) -> Self {
        let rules = Constraints::<E>::len(&parts.constraints);
        let mut counts = Counts {
            rules: rules.min(crate::MAX_RULES),
            ..Counts::default()
        };
        for rule in 0..counts.rules {
            let constraint = Constraints::<E>::name(&parts.constraints, rule);
            counts.rejections[rule] = Rejections {
                constraint,
                ..Rejections::default()
            };
        }
        Self {
            parts,
            estimator,
            counts,
            progress: Progress {
                data: estimator.len(),
                sample_size: E::SAMPLE_SIZE,
                ..Progress::default()
            },
            best: None,
            sample: vec![0; E::SAMPLE_SIZE],
            candidates: Candidates::new(E::MAX_MODELS),
            inliers: Vec::with_capacity(estimator.len()),
        }
    }

    /// Iterates until the stopping rule has a reason.
    fn run(&mut self, seed: u64) -> Result<StopReason, RansacError> {
        if self.parts.stopping.reason(&self.progress).is_some() {
            return Err(RansacError::NothingDrawn);
        }
        loop {
            self.iterate(seed, self.progress.draws);
            self.progress.draws += 1;
            if let Some(reason) = self.parts.stopping.reason(&self.progress) {
                return Ok(reason);
            }
        }
    }

    fn iterate(&mut self, seed: u64, iteration: u64) {
        let Self {
            parts, estimator, ..
        } = *self;
        let mut draws = Draws::new(seed, iteration);
        if !parts
            .sampler
            .sample(estimator, iteration, &mut draws, &mut self.sample)
        {
            self.counts.degenerate += 1;
            return;
        }
        if let Some(rule) = parts.constraints.refusing_sample(estimator, &self.sample) {
            self.counts.rejection(rule).samples += 1;
            return;
        }
        self.candidates.clear();
        estimator.fit(&self.sample, &mut self.candidates);
        self.counts.degenerate += u64::from(self.candidates.is_empty());

        let mut candidates = std::mem::replace(&mut self.candidates, Candidates::new(0));
        for model in candidates.drain() {
            if let Some(rule) = parts.constraints.refusing_model(estimator, &model) {
                self.counts.rejection(rule).models += 1;
                continue;
            }
            self.progress.hypotheses += 1;
            let bound = self
                .best
                .as_ref()
                .map_or(f64::NEG_INFINITY, |best| best.score);
            match parts.scorer.score(estimator, &model, bound) {
                Some(score) => self.promote(Scored { model, score }),
                None => self.counts.pruned += 1,
            }
        }
        self.candidates = candidates;
    }

    /// Makes a model the best one, after local optimisation.
    fn promote(&mut self, model: Scored<E::Model>) {
        let local = &self.parts.local;
        let best = local.improve(&mut self.refiner(), model);
        self.parts
            .scorer
            .select(self.estimator, &best.model, &mut self.inliers);
        self.progress.best_inliers = self.inliers.len();
        self.best = Some(best);
    }

    fn refiner(&mut self) -> Refiner<'_, E, S, C> {
        Refiner {
            estimator: self.estimator,
            scorer: &self.parts.scorer,
            constraints: &self.parts.constraints,
            inliers: &mut self.inliers,
            counts: &mut self.counts,
        }
    }

    /// The last refit, and the report of what came out of it.
    fn finish(mut self, stopped: StopReason) -> Result<Report<E::Model>, RansacError> {
        let Some(best) = self.best.take() else {
            return Err(self.no_model());
        };
        let local = &self.parts.local;
        let Scored { model, score } = local.finish(&mut self.refiner(), best);
        self.parts
            .scorer
            .select(self.estimator, &model, &mut self.inliers);
        let needed = self.parts.min_inliers.max(E::SAMPLE_SIZE);
        if self.inliers.len() < needed {
            return Err(RansacError::NoConsensus {
                inliers: self.inliers.len(),
                needed,
            });
        }
        self.counts.draws = self.progress.draws;
        self.counts.hypotheses = self.progress.hypotheses;
        Ok(Report {
            residuals: residual_statistics(self.estimator, &model, &self.inliers),
            model,
            inliers: self.inliers,
            score,
            stopped,
            counts: self.counts,
        })
    }

    fn no_model(&self) -> RansacError {
        let draws = self.progress.draws;
        let most = self
            .counts
            .rejections()
            .iter()
            .max_by_key(|r| r.samples + r.models);
        match most {
            Some(rule) if rule.samples + rule.models > 0 => RansacError::ConstraintNeverMet {
                draws,
                constraint: rule.constraint,
            },
            _ => RansacError::AllDegenerate { draws },
        }
    }
}
