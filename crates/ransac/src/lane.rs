use crate::estimator::blocks;
use crate::preemption::MAX_LOOKS;
use crate::{
    Candidates, Constraints, Draws, Estimator, Look, Lossless, Preemption, Sampler, Scorer,
};
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

/// What happened in an iteration; where a sample gave several models, each is an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Event {
    pub(crate) kind: Kind,
    /// Whether the iteration ends with it.
    pub(crate) last: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Degenerate,
    /// By the constraint of this number.
    SampleRefused(usize),
    /// By the constraint of this number.
    ModelRefused(usize),
    /// The next one of the lane's hypotheses.
    Hypothesis,
}

/// A model on its way through the data.
#[derive(Debug)]
pub(crate) struct Hypothesis<M> {
    pub(crate) model: M,
    /// What its score is before any datum is seen.
    prior: f64,
    /// What the data seen have gained.
    gain: f64,
    /// It cannot, or will hardly, exceed the round's bound.
    given_up: bool,
}

impl<M> Hypothesis<M> {
    fn unscored(model: M) -> Self {
        Self {
            model,
            prior: 0.0,
            gain: 0.0,
            given_up: false,
        }
    }

    /// Its score, once all data have been seen.
    pub(crate) fn score(&self) -> f64 {
        self.prior + self.gain
    }
}

/// What a rule has said at one look for one bound: the gains between which it must still be asked.
#[derive(Clone, Copy, Debug)]
struct Verdicts {
    bound: f64,
    /// The largest gain known to be too little.
    given_up: f64,
    /// The least gain known to be enough.
    kept: f64,
}

impl Default for Verdicts {
    fn default() -> Self {
        Self {
            bound: f64::NAN,
            given_up: f64::NEG_INFINITY,
            kept: f64::INFINITY,
        }
    }
}

impl Verdicts {
    /// These, or none if they are for another bound.
    fn for_bound(self, bound: f64) -> Self {
        if self.bound == bound {
            self
        } else {
            Self {
                bound,
                ..Self::default()
            }
        }
    }

    /// Whether a gain is too little, by what is known or else by `ask`.
    #[inline]
    fn of(&mut self, gain: f64, ask: impl FnOnce() -> bool) -> bool {
        if gain <= self.given_up {
            return true;
        }
        if gain >= self.kept {
            return false;
        }
        let given_up = ask();
        if given_up {
            self.given_up = self.given_up.max(gain);
        } else {
            self.kept = self.kept.min(gain);
        }
        given_up
    }
}

/// One thread's share of a round, and the memory it works in.
#[derive(Debug)]
pub(crate) struct Lane<M> {
    sample: Vec<usize>,
    candidates: Candidates<M>,
    pub(crate) events: Vec<Event>,
    pub(crate) hypotheses: Vec<Hypothesis<M>>,
    live: Vec<usize>,
    /// What is known of each look, for [`MAX_LOOKS`] of them.
    verdicts: Vec<Verdicts>,
    /// How many data had been seen at each look.
    looks: Vec<usize>,
    /// [`MAX_LOOKS`] for each hypothesis: its gain at each look. Empty under a lossless rule.
    gains: Vec<f64>,
}

impl<M> Lane<M> {
    pub(crate) fn new() -> Self {
        Self {
            sample: Vec::new(),
            candidates: Candidates::new(0),
            events: Vec::new(),
            hypotheses: Vec::new(),
            live: Vec::new(),
            verdicts: Vec::new(),
            looks: Vec::new(),
            gains: Vec::new(),
        }
    }

    pub(crate) fn prepare(&mut self, sample_size: usize, models: usize, round: usize) {
        self.events.clear();
        self.hypotheses.clear();
        self.live.clear();
        // A round of absurd length grows its lists when it gets that far.
        let most = round.min(1024) * models.max(1);
        self.events.reserve(most);
        self.hypotheses.reserve(most + 1);
        self.live.reserve(most);
        self.verdicts.clear();
        self.verdicts.resize(MAX_LOOKS, Verdicts::default());
        self.looks.clear();
        self.looks.reserve(MAX_LOOKS);
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
        self.events.clear();
        self.hypotheses.clear();
        for iteration in iterations {
            self.draw(task, iteration);
        }
        self.score(task);
    }

    /// Scores models that no sample gave.
    pub(crate) fn compare<E, S, P, C, B>(&mut self, task: &Task<'_, E, S, P, C, B>, models: &[M])
    where
        M: Clone,
        E: Estimator<Model = M>,
        S: Scorer<E>,
        C: Constraints<E>,
        B: Preemption,
    {
        self.events.clear();
        self.hypotheses.clear();
        for model in models {
            let refused = task.constraints.refusing_model(task.estimator, model);
            let kind = refused.map_or(Kind::Hypothesis, Kind::ModelRefused);
            self.events.push(Event { kind, last: true });
            if refused.is_none() {
                self.hypotheses.push(Hypothesis::unscored(model.clone()));
            }
        }
        self.score(task);
    }

    fn draw<E, S, P, C, B>(&mut self, task: &Task<'_, E, S, P, C, B>, iteration: u64)
    where
        E: Estimator<Model = M>,
        P: Sampler<E>,
        C: Constraints<E>,
    {
        let estimator = task.estimator;
        let mut ends_with = |kind| self.events.push(Event { kind, last: true });
        let mut draws = Draws::new(task.seed, iteration);
        let found = task
            .sampler
            .sample(estimator, iteration, &mut draws, &mut self.sample);
        if !found {
            return ends_with(Kind::Degenerate);
        }
        if let Some(rule) = task.constraints.refusing_sample(estimator, &self.sample) {
            return ends_with(Kind::SampleRefused(rule));
        }
        self.candidates.clear();
        estimator.fit(&self.sample, &mut self.candidates);
        if self.candidates.is_empty() {
            return ends_with(Kind::Degenerate);
        }
        let Self {
            candidates,
            events,
            hypotheses,
            ..
        } = self;
        let mut take = |model| {
            let refused = task.constraints.refusing_model(estimator, &model);
            let kind = refused.map_or(Kind::Hypothesis, Kind::ModelRefused);
            events.push(Event { kind, last: false });
            // Taken first and dropped again: which models are refused cannot be foreseen, and a branch would be
            // mispredicted every other time.
            let before = hypotheses.len();
            hypotheses.push(Hypothesis::unscored(model));
            hypotheses.truncate(before + usize::from(refused.is_none()));
        };
        if let Some(only) = candidates.take_only() {
            take(only);
        } else {
            candidates.drain().for_each(take);
        }
        if let Some(event) = self.events.last_mut() {
            event.last = true;
        }
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
            hypotheses,
            live,
            verdicts,
            looks,
            gains,
            ..
        } = self;
        let data = task.estimator.len();
        live.clear();
        let most_gain = task.scorer.most_gain(task.estimator, 0..data);
        for (h, hypothesis) in hypotheses.iter_mut().enumerate() {
            let prior = task.scorer.prior(task.estimator, &hypothesis.model);
            hypothesis.prior = prior;
            let unseen = Look {
                seen: 0,
                data,
                gain: 0.0,
                most_left: most_gain,
                counts: S::COUNTS,
            };
            let hopeless =
                prior != 0.0 && Lossless::default().gives_up(&unseen, task.bound - prior);
            hypothesis.given_up = hopeless || !prior.is_finite();
            if !hypothesis.given_up {
                live.push(h);
            }
        }
        looks.clear();
        if !B::LOSSLESS {
            gains.resize(gains.len().max(hypotheses.capacity() * MAX_LOOKS), 0.0);
        }
        let mut next_look = task.preemption.next_look(0, data);
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
            if due && (B::LOSSLESS || looks.len() < MAX_LOOKS) {
                let most_left = task.scorer.most_gain(task.estimator, seen..data);
                let mut verdict = Verdicts::default();
                if !B::LOSSLESS {
                    verdict = verdicts[looks.len()].for_bound(task.bound);
                }
                live.retain(|&h| {
                    let hypothesis = &mut hypotheses[h];
                    let gain = hypothesis.gain;
                    if !B::LOSSLESS {
                        gains[h * MAX_LOOKS + looks.len()] = gain;
                    }
                    let look = Look {
                        seen,
                        data,
                        gain,
                        most_left,
                        counts: S::COUNTS,
                    };
                    // What is known of a bound is of use where all models have the same prior: none.
                    let prior = hypothesis.prior;
                    let ask = || task.preemption.gives_up(&look, task.bound - prior);
                    hypothesis.given_up = if prior == 0.0 {
                        verdict.of(gain, ask)
                    } else {
                        ask()
                    };
                    !hypothesis.given_up
                });
                if !B::LOSSLESS {
                    verdicts[looks.len()] = verdict;
                    looks.push(seen);
                }
                next_look = task.preemption.next_look(seen, data);
            }
        }
    }

    /// Whether a search of one iteration after the other would have scored a hypothesis in full, and
    /// found it above `bound`, its bound at that time.
    pub(crate) fn exceeds<E, S, P, C, B>(
        &self,
        hypothesis: usize,
        bound: f64,
        task: &Task<'_, E, S, P, C, B>,
    ) -> bool
    where
        E: Estimator<Model = M>,
        S: Scorer<E>,
        B: Preemption,
    {
        let Hypothesis {
            prior, given_up, ..
        } = self.hypotheses[hypothesis];
        if given_up || !(self.hypotheses[hypothesis].score() > bound) {
            return false;
        }
        let data = task.estimator.len();
        // Under a lossless rule there are no looks to go through again.
        let gains = self.gains.iter().skip(hypothesis * MAX_LOOKS);
        !self.looks.iter().zip(gains).any(|(&seen, &gain)| {
            let most_left = task.scorer.most_gain(task.estimator, seen..data);
            let look = Look {
                seen,
                data,
                gain,
                most_left,
                counts: S::COUNTS,
            };
            task.preemption.gives_up(&look, bound - prior)
        })
    }
}
