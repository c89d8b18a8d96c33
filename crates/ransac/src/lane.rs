use crate::estimator::blocks;
use crate::preemption::MAX_LOOKS;
use crate::{Candidates, Constraints, Draws, Estimator, Look, Preemption, Sampler, Scorer};
use std::ops::Range;

/// What a round's hypotheses are drawn from and scored by.
pub(crate) struct Task<'a, E, S, P, C, B> {
    pub(crate) estimator: &'a E,
    pub(crate) scorer: &'a S,
    pub(crate) sampler: &'a P,
    pub(crate) constraints: &'a C,
    pub(crate) preemption: &'a B,
    pub(crate) seed: u64,
    /// The least that a score had to exceed when the round began.
    pub(crate) bound: f64,
}

/// What one iteration's sample led to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Degenerate,
    SampleRefused(usize),
    /// This many hypotheses, which follow those of the iteration before.
    Fitted(usize),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// By the constraint of this number.
    Refused(usize),
    /// It cannot, or will hardly, exceed the round's bound.
    GivenUp,
    Scored,
}

/// A model on its way through the data.
#[derive(Debug)]
pub(crate) struct Hypothesis<M> {
    pub(crate) model: M,
    pub(crate) verdict: Verdict,
    pub(crate) gain: f64,
    looks: [(usize, f64); MAX_LOOKS],
    looked: usize,
}

impl<M> Hypothesis<M> {
    fn new(model: M, refused: Option<usize>) -> Self {
        Self {
            model,
            verdict: refused.map_or(Verdict::Scored, Verdict::Refused),
            gain: 0.0,
            looks: [(0, 0.0); MAX_LOOKS],
            looked: 0,
        }
    }

    /// Whether a search of one iteration after the other would have scored this model in full, and
    /// found it above `bound`, its bound at that time.
    pub(crate) fn exceeds<E, S, P, C, B>(&self, bound: f64, task: &Task<'_, E, S, P, C, B>) -> bool
    where
        E: Estimator<Model = M>,
        S: Scorer<E>,
        B: Preemption,
    {
        let data = task.estimator.len();
        self.verdict == Verdict::Scored
            && self.gain > bound
            && (B::LOSSLESS
                || !self.looks[..self.looked].iter().any(|&(seen, gain)| {
                    let most_left = task.scorer.most_gain(task.estimator, seen..data);
                    let look = Look {
                        seen,
                        data,
                        gain,
                        most_left,
                    };
                    task.preemption.gives_up(&look, bound)
                }))
    }
}

/// One thread's share of a round, and the memory it works in.
#[derive(Debug)]
pub(crate) struct Lane<M> {
    sample: Vec<usize>,
    candidates: Candidates<M>,
    pub(crate) outcomes: Vec<Outcome>,
    pub(crate) hypotheses: Vec<Hypothesis<M>>,
    live: Vec<usize>,
}

impl<M> Lane<M> {
    pub(crate) fn new() -> Self {
        Self {
            sample: Vec::new(),
            candidates: Candidates::new(0),
            outcomes: Vec::new(),
            hypotheses: Vec::new(),
            live: Vec::new(),
        }
    }

    pub(crate) fn prepare(&mut self, sample_size: usize, models: usize, round: usize) {
        self.outcomes.clear();
        self.hypotheses.clear();
        self.live.clear();
        // A round of absurd length grows its lists when it gets that far.
        let iterations = round.min(1024);
        self.outcomes.reserve(iterations);
        self.hypotheses.reserve(iterations * models);
        self.live.reserve(iterations * models);
        self.sample.resize(sample_size, 0);
        self.candidates.set_limit(models);
    }

    /// Draws, fits and scores the hypotheses of `iterations`.
    pub(crate) fn work<E, S, P, C, B>(
        &mut self,
        task: &Task<'_, E, S, P, C, B>,
        iterations: Range<u64>,
    ) where
        E: Estimator<Model = M>,
        P: Sampler<E>,
        S: Scorer<E>,
        C: Constraints<E>,
        B: Preemption,
    {
        self.outcomes.clear();
        self.hypotheses.clear();
        for iteration in iterations {
            let outcome = self.draw(task, iteration);
            self.outcomes.push(outcome);
        }
        self.score(task);
    }

    fn draw<E, S, P, C, B>(&mut self, task: &Task<'_, E, S, P, C, B>, iteration: u64) -> Outcome
    where
        E: Estimator<Model = M>,
        P: Sampler<E>,
        C: Constraints<E>,
    {
        let estimator = task.estimator;
        let mut draws = Draws::new(task.seed, iteration);
        let found = task
            .sampler
            .sample(estimator, iteration, &mut draws, &mut self.sample);
        if !found {
            return Outcome::Degenerate;
        }
        if let Some(rule) = task.constraints.refusing_sample(estimator, &self.sample) {
            return Outcome::SampleRefused(rule);
        }
        self.candidates.clear();
        estimator.fit(&self.sample, &mut self.candidates);
        if self.candidates.is_empty() {
            return Outcome::Degenerate;
        }
        let models = self.candidates.len();
        for model in self.candidates.drain() {
            let refused = task.constraints.refusing_model(estimator, &model);
            self.hypotheses.push(Hypothesis::new(model, refused));
        }
        Outcome::Fitted(models)
    }

    /// Scores all hypotheses on one block of data before the next block is touched, so that
    /// data larger than the caches are read once in a round and not once for every model.
    fn score<E, S, P, C, B>(&mut self, task: &Task<'_, E, S, P, C, B>)
    where
        E: Estimator<Model = M>,
        S: Scorer<E>,
        B: Preemption,
    {
        let Self {
            hypotheses, live, ..
        } = self;
        let data = task.estimator.len();
        live.clear();
        live.extend((0..hypotheses.len()).filter(|&h| hypotheses[h].verdict == Verdict::Scored));
        let mut next_look = task.preemption.next_look(0, data);
        let mut looks = 0;
        for block in blocks(data) {
            if live.is_empty() {
                break;
            }
            let seen = block.end;
            for &h in &*live {
                let hypothesis = &mut hypotheses[h];
                hypothesis.gain +=
                    task.scorer
                        .block_gain(task.estimator, &hypothesis.model, block.clone());
            }
            let due = next_look <= seen && seen < data;
            if due && (B::LOSSLESS || looks < MAX_LOOKS) {
                let most_left = task.scorer.most_gain(task.estimator, seen..data);
                live.retain(|&h| {
                    let hypothesis = &mut hypotheses[h];
                    let gain = hypothesis.gain;
                    if !B::LOSSLESS {
                        hypothesis.looks[looks] = (seen, gain);
                        hypothesis.looked = looks + 1;
                    }
                    let look = Look {
                        seen,
                        data,
                        gain,
                        most_left,
                    };
                    let hopeless = task.preemption.gives_up(&look, task.bound);
                    if hopeless {
                        hypothesis.verdict = Verdict::GivenUp;
                    }
                    !hopeless
                });
                looks += 1;
                next_look = task.preemption.next_look(seen, data);
            }
        }
    }
}
