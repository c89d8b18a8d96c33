use crate::lane::{Event, Kind, Lane, Task};
use crate::local::Refitted;
use crate::workspace::Buffers;
use crate::{
    Confidence, Constraints, Counts, Estimator, InitialModels, LocalOptimization, Preemption,
    Progress, Ransac, RansacError, Refiner, Rejections, Report, Sampler, Scored, Scorer,
    StopReason, Stopping, Workspace,
    noise::uncertainty,
    report::residual_statistics,
    runners_up::{Keep, RunnersUp},
};
use std::ops::Range;

/// The state of one run.
///
/// Iterations are computed in rounds and merged in order: what happens in a round depends on no
/// other iteration of it, and everything that depends on order happens in the merge.
pub(crate) struct Search<'a, E: Estimator, S, P, C, L, T, B, G> {
    parts: &'a Ransac<S, P, C, L, T, B, G>,
    estimator: &'a E,
    lanes: &'a mut Vec<Lane<E::Model>>,
    buffers: &'a mut Buffers,
    runners_up: &'a mut RunnersUp<E::Model>,
    keep: Keep,
    seed: u64,
    counts: Counts,
    progress: Progress,
    best: Option<Scored<E::Model>>,
    latest: Option<Refitted<E::Model>>,
}

impl<'a, E, S, P, C, L, T, B, G> Search<'a, E, S, P, C, L, T, B, G>
where
    E: Estimator,
    P: Sampler<E>,
    S: Scorer<E>,
    C: Constraints<E>,
    L: LocalOptimization<E>,
    T: Stopping,
    B: Preemption,
    G: InitialModels<E::Model>,
{
    pub(crate) fn new(
        parts: &'a Ransac<S, P, C, L, T, B, G>,
        estimator: &'a E,
        workspace: &'a mut Workspace<E::Model>,
        seed: u64,
    ) -> Self {
        let keep = Keep {
            models: parts.local.runners_up(),
            share: Some(parts.local.near()),
        };
        Self::keeping(keep, parts, estimator, workspace, seed)
    }

    /// A search that keeps other runners-up than the local optimisation wants.
    pub(crate) fn keeping(
        keep: Keep,
        parts: &'a Ransac<S, P, C, L, T, B, G>,
        estimator: &'a E,
        workspace: &'a mut Workspace<E::Model>,
        seed: u64,
    ) -> Self {
        workspace.prepare::<E>(estimator.len(), keep.models, parts.settings);
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
            lanes: &mut workspace.lanes,
            buffers: &mut workspace.buffers,
            runners_up: &mut workspace.runners_up,
            keep,
            seed,
            counts,
            progress: Progress {
                data: estimator.len(),
                sample_size: E::SAMPLE_SIZE,
                ..Progress::default()
            },
            best: None,
            latest: None,
        }
    }

    /// Searches, and reports.
    pub(crate) fn report(mut self) -> Result<Report<E::Model>, RansacError> {
        let (best, stopped) = self.best_hypothesis()?;
        self.finish(best, stopped)
    }

    /// Searches; the best model and the runners-up, each after its last refit.
    pub(crate) fn candidates(mut self) -> Result<Vec<Scored<E::Model>>, RansacError> {
        let (best, _) = self.best_hypothesis()?;
        let mut all = Vec::new();
        self.refit_each(best, |refitted| all.push(refitted));
        Ok(all)
    }

    /// Draws and scores until the rule ends it.
    fn best_hypothesis(&mut self) -> Result<(Scored<E::Model>, StopReason), RansacError> {
        if self.estimator.len() < E::SAMPLE_SIZE {
            return Err(RansacError::TooFewData {
                needed: E::SAMPLE_SIZE,
                available: self.estimator.len(),
            });
        }
        let mut stopped = self.parts.stopping.reason(&self.progress);
        self.compare_initial();
        if stopped.is_some() && self.best.is_none() {
            return Err(RansacError::NothingDrawn);
        }
        stopped = stopped.or_else(|| self.parts.stopping.reason(&self.progress));
        let stopped = loop {
            if let Some(reason) = stopped {
                break reason;
            }
            stopped = self.round();
        };
        let best = self.best.take().ok_or_else(|| self.no_model())?;
        Ok((best, stopped))
    }

    fn best_score(&self) -> f64 {
        self.best
            .as_ref()
            .map_or(f64::NEG_INFINITY, |best| best.score)
    }

    /// What a score must exceed to be of use.
    fn bound(&self) -> f64 {
        self.near(self.best_score()).max(self.runners_up.floor())
    }

    /// What a runner-up of a score exceeds; the score itself where none is kept.
    fn near(&self, score: f64) -> f64 {
        match self.keep.share {
            _ if self.keep.models == 0 || score == f64::NEG_INFINITY => score,
            Some(share) => score.min(score * share),
            None => f64::NEG_INFINITY,
        }
    }

    fn task(&self) -> Task<'a, E, S, P, C, B> {
        Task {
            estimator: self.estimator,
            scorer: &self.parts.scorer,
            sampler: &self.parts.sampler,
            constraints: &self.parts.constraints,
            preemption: &self.parts.preemption,
            seed: self.seed,
            bound: self.bound(),
        }
    }

    /// How many iterations the next round computes: no more than the rule still wants, and few in vain
    /// when the rule ends the search in the middle of a round. So the rounds double only as long as the
    /// rule wants many more, and are an eighth of what was drawn after that.
    fn round_size(&self) -> u64 {
        let settings = &self.parts.settings;
        let threads = settings.threads as u64;
        let largest = (settings.round as u64).saturating_mul(threads);
        let drawn = self.progress.draws;
        let wanted = self.parts.stopping.draws_left(&self.progress);
        let doubled = drawn.min(wanted / 8);
        let grown = doubled.max(drawn / 8).max(threads);
        grown.min(largest).min(wanted).max(1)
    }

    /// Computes a round and merges it; the reason to stop, if there is one.
    fn round(&mut self) -> Option<StopReason> {
        let task = self.task();
        let start = self.progress.draws;
        let size = self.round_size();
        let share = size.div_ceil(self.lanes.len() as u64);
        let shares = move |lane: usize| -> Range<u64> {
            let first = (lane as u64 * share).min(size);
            start + first..start + (first + share).min(size)
        };
        work(self.lanes, &task, shares);

        let lanes = std::mem::take(self.lanes);
        let stopped = lanes.iter().find_map(|lane| self.merge(&task, lane));
        *self.lanes = lanes;
        stopped
    }

    /// Compares the models that are known beforehand, as many at a time as a round has iterations.
    fn compare_initial(&mut self) {
        for models in self
            .parts
            .initial
            .models()
            .chunks(self.parts.settings.round)
        {
            let task = self.task();
            let mut lanes = std::mem::take(self.lanes);
            if let Some(lane) = lanes.first_mut() {
                lane.compare(&task, models);
                let mut next = 0;
                for event in &lane.events {
                    if let Kind::ModelRefused(rule) = event.kind {
                        self.counts.rejection(rule).models += 1;
                    } else {
                        self.judge(&task, lane, next);
                        next += 1;
                    }
                }
                self.counts.initial += next as u64;
            }
            *self.lanes = lanes;
        }
    }

    /// Takes in what a lane computed, one iteration after the other.
    fn merge(
        &mut self,
        task: &Task<'_, E, S, P, C, B>,
        lane: &Lane<E::Model>,
    ) -> Option<StopReason> {
        let mut next = 0;
        let mut accepted = false;
        for &Event { kind, last } in &lane.events {
            match kind {
                Kind::Degenerate => self.counts.degenerate += 1,
                Kind::SampleRefused(rule) => self.counts.rejection(rule).samples += 1,
                Kind::ModelRefused(rule) => self.counts.rejection(rule).models += 1,
                Kind::Hypothesis => {
                    self.progress.hypotheses += 1;
                    self.counts.pruned += u64::from(!self.judge(task, lane, next));
                    next += 1;
                    accepted = true;
                }
            }
            if last {
                self.progress.accepted += u64::from(std::mem::take(&mut accepted));
                self.progress.draws += 1;
                if let Some(reason) = self.parts.stopping.reason(&self.progress) {
                    return Some(reason);
                }
            }
        }
        None
    }

    /// Makes a hypothesis the best model, or a runner-up, or nothing; whether it is the best.
    fn judge(
        &mut self,
        task: &Task<'_, E, S, P, C, B>,
        lane: &Lane<E::Model>,
        hypothesis: usize,
    ) -> bool {
        if !lane.exceeds(hypothesis, self.bound(), task) {
            return false;
        }
        let hypothesis = &lane.hypotheses[hypothesis];
        let scored = Scored {
            model: hypothesis.model.clone(),
            score: hypothesis.score(),
        };
        let best = scored.score > self.best_score();
        if best {
            self.promote(scored);
        } else {
            self.keep(scored);
        }
        best
    }

    /// Makes a model the best one, after local optimisation; the one before becomes a runner-up.
    fn promote(&mut self, model: Scored<E::Model>) {
        let local = &self.parts.local;
        let best = local.improve(&mut self.refiner(), model);
        self.progress.best_inliers = if S::COUNTS {
            best.score as usize
        } else {
            self.parts.scorer.count(self.estimator, &best.model)
        };
        self.progress.best_score = Some(best.score);
        if self.keep.models > 0 {
            let inliers = &mut self.buffers.inliers;
            self.parts
                .scorer
                .select(self.estimator, &best.model, inliers);
            self.runners_up.best(inliers);
        }
        if let Some(former) = self.best.replace(best) {
            self.keep(former);
        }
    }

    /// Keeps a hypothesis that is near the best for the end.
    fn keep(&mut self, near: Scored<E::Model>) {
        if self.runners_up.wants(near.score) {
            let inliers = &mut self.buffers.inliers;
            self.parts
                .scorer
                .select(self.estimator, &near.model, inliers);
            self.runners_up.offer(near, inliers);
        }
    }

    /// Gives the best model and the runners-up to `take`, each after its last refit.
    fn refit_each(&mut self, best: Scored<E::Model>, mut take: impl FnMut(Scored<E::Model>)) {
        let local = &self.parts.local;
        let bound = self.near(best.score);
        take(local.finish(&mut self.refiner(), best));
        let mut runners_up = std::mem::take(self.runners_up);
        for near in runners_up.drain(bound) {
            take(local.finish(&mut self.refiner(), near));
        }
        *self.runners_up = runners_up;
    }

    fn refiner(&mut self) -> Refiner<'_, E, S, C> {
        Refiner {
            estimator: self.estimator,
            scorer: &self.parts.scorer,
            constraints: &self.parts.constraints,
            inliers: &mut self.buffers.inliers,
            weights: &mut self.buffers.numbers,
            counts: &mut self.counts,
            latest: &mut self.latest,
        }
    }

    /// The last refits, and the report of what came out of them.
    fn finish(
        mut self,
        hypothesis: Scored<E::Model>,
        stopped: StopReason,
    ) -> Result<Report<E::Model>, RansacError> {
        let mut best = None::<Scored<E::Model>>;
        self.refit_each(hypothesis, |refitted| {
            if best.as_ref().is_none_or(|b| refitted.score > b.score) {
                best = Some(refitted);
            }
        });
        let Some(Scored { model, score }) = best else {
            return Err(self.no_model());
        };
        self.parts
            .scorer
            .select(self.estimator, &model, &mut self.buffers.inliers);
        let inliers = std::mem::take(&mut self.buffers.inliers);
        let needed = self.needed();
        if inliers.len() < needed {
            let found = inliers.len();
            self.buffers.inliers = inliers;
            return Err(RansacError::NoConsensus {
                inliers: found,
                needed,
            });
        }
        self.progress.best_inliers = inliers.len();
        self.counts.draws = self.progress.draws;
        self.counts.accepted = self.progress.accepted;
        self.counts.hypotheses = self.progress.hypotheses;
        let stated = self.parts.stopping.confidence(&self.progress);
        let confidence =
            stated.unwrap_or_else(|| 1.0 - Confidence::miss_probability(&self.progress));
        let (sigma, covariance) = if self.parts.settings.covariance {
            uncertainty(self.estimator, &self.parts.scorer, &model, &inliers)
        } else {
            (None, None)
        };
        Ok(Report {
            sigma,
            covariance,
            residuals: residual_statistics(
                self.estimator,
                &model,
                &inliers,
                &mut self.buffers.numbers,
            ),
            confidence,
            model,
            inliers,
            score,
            stopped,
            counts: self.counts,
        })
    }

    /// The least number of inliers.
    fn needed(&self) -> usize {
        self.parts.settings.min_inliers.max(E::SAMPLE_SIZE)
    }

    fn no_model(&self) -> RansacError {
        let needed = self.needed();
        let draws = self.progress.draws;
        let most = self
            .counts
            .rejections()
            .iter()
            .max_by_key(|r| r.samples + r.models);
        match most {
            _ if self.progress.hypotheses + self.counts.initial > 0 => {
                RansacError::NoConsensus { inliers: 0, needed }
            }
            Some(rule) if rule.samples + rule.models > 0 => RansacError::ConstraintNeverMet {
                draws,
                constraint: rule.constraint,
            },
            _ => RansacError::AllDegenerate { draws },
        }
    }
}

/// Computes a round: each lane its share, on threads of their own where there are several.
fn work<E, S, P, C, B>(
    lanes: &mut [Lane<E::Model>],
    task: &Task<'_, E, S, P, C, B>,
    shares: impl Fn(usize) -> Range<u64> + Sync,
) where
    E: Estimator,
    P: Sampler<E>,
    S: Scorer<E>,
    C: Constraints<E>,
    B: Preemption,
{
    #[cfg(feature = "rayon")]
    if lanes.len() > 1 {
        use rayon::prelude::*;
        lanes
            .par_iter_mut()
            .enumerate()
            .for_each(|(lane, memory)| memory.work(task, shares(lane)));
        return;
    }
    for (lane, memory) in lanes.iter_mut().enumerate() {
        memory.work(task, shares(lane));
    }
}
