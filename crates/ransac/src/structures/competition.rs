use super::claims::{Claim, NOBODY, Share, best_move, claim, share_out};
use crate::constraint::allowed;
use crate::{
    Constraints, Covariance, Estimator, Ransac, ResidualStatistics, Scorer, noise::uncertainty,
    report::residual_statistics,
};

/// Chooses, among candidate models, those that explain the data best together.
///
/// Every datum belongs to the one chosen model with which it gains most, or to none; a set of
/// models is worth the sum of these gains less a penalty for each model. So a datum where two lines cross
/// counts once, a copy of a model is worth nothing, and a model made of pieces of others is worth what
/// these leave it. From no model on, the one addition, removal or exchange that raises the
/// worth most is made until none does; then each model is refitted to its own data
/// under the constraints, and both are repeated until nothing changes. No step lowers the worth but the
/// removal of models that have too few data.
///
/// This is the multi-structure objective of PEARL (Isack and Boykov 2012, doi 10.1007/s11263-011-0474-7) without
/// its smoothness term, so that a local search over sets takes the place of graph cuts; Multi-X
/// (Barath and Matas 2018, doi 10.1007/978-3-030-01228-1_44) does alike.
///
/// ```
/// # use pomona_ransac::{Candidates, Estimator};
/// # struct Numbers(Vec<f64>);
/// # impl Estimator for Numbers {
/// #     type Model = f64;
/// #     const SAMPLE_SIZE: usize = 1;
/// #     fn len(&self) -> usize { self.0.len() }
/// #     fn fit(&self, sample: &[usize], candidates: &mut Candidates<f64>) {
/// #         candidates.push(self.0[sample[0]]);
/// #     }
/// #     fn refit(&self, inliers: &[usize], _: &f64) -> Option<f64> {
/// #         Some(inliers.iter().map(|&i| self.0[i]).sum::<f64>() / inliers.len() as f64)
/// #     }
/// #     fn residuals(&self, model: &f64, block: std::ops::Range<usize>, out: &mut [f64]) {
/// #         for (r, i) in out.iter_mut().zip(block) { *r = (self.0[i] - model).abs(); }
/// #     }
/// # }
/// use pomona_ransac::{Competition, Msac, Ransac};
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
///
/// // Numbers about 1, and about 1.6.
/// let data = Numbers(vec![0.9, 1.0, 1.1, 1.5, 1.6, 1.7, 9.0]);
/// let search = Ransac::new(Msac::within(0.5)).min_inliers(2);
/// let candidates = search.candidates(&data, 10, &mut ChaCha8Rng::seed_from_u64(1))?;
/// let found = Competition::with_penalty(1.0).run(&search, &data, candidates.into_iter().map(|c| c.model));
/// assert_eq!(found.instances[0].data, [0, 1, 2]);
/// assert_eq!(found.instances[1].data, [3, 4, 5]);
/// assert_eq!(found.rest, [6]);
/// # Ok::<(), pomona_ransac::RansacError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Competition {
    penalty: f64,
    max_rounds: usize,
}

/// One of the chosen models, and the data that it has to itself.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Instance<M> {
    /// The model.
    pub model: M,
    /// Its data, ascending.
    pub data: Vec<usize>,
    /// What these gain.
    pub score: f64,
    /// Their residuals.
    pub residuals: ResidualStatistics,
    /// As [`Report::sigma`](crate::Report::sigma), from its own data; what a neighbour took is missing like an outlier.
    pub sigma: Option<f64>,
    /// As [`Report::covariance`](crate::Report::covariance), from its own data.
    pub covariance: Option<Covariance>,
}

/// What came out of a [`Competition`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Selection<M> {
    /// The chosen models, the highest score first; none where no candidate is worth its penalty.
    pub instances: Vec<Instance<M>>,
    /// The data of no model, ascending.
    pub rest: Vec<usize>,
    /// Sum of the scores less the penalties.
    pub worth: f64,
    /// How often models were chosen and refitted.
    pub rounds: usize,
}

impl Competition {
    /// A model must add more than `penalty` to the sum of gains: roughly as many inliers of its own.
    ///
    /// One that is negative or NaN is taken as 0, where every model stays that has a datum for itself.
    pub fn with_penalty(penalty: f64) -> Self {
        Self {
            penalty: penalty.max(0.0),
            max_rounds: 20,
        }
    }

    /// Chooses and refits at most so often; 20 times by default. With 0 nothing is refitted.
    #[must_use]
    pub fn rounds(self, max_rounds: usize) -> Self {
        Self { max_rounds, ..self }
    }

    /// Lets `candidates` compete for the data, by the scorer and under the constraints of `search`.
    ///
    /// Candidates come from [`Ransac::candidates`], from a [`Sequential`](crate::Sequential) search or from
    /// elsewhere; those that a constraint refuses take no part. A model that is left with fewer data than
    /// [`Ransac::min_inliers`] or a minimal sample is struck off. Where candidates are of
    /// equal worth, the first is taken.
    ///
    /// Memory and time of a move grow with the sum of all candidates' inliers, times the number of
    /// models chosen.
    pub fn run<E, S, P, C, L, T, B, G>(
        &self,
        search: &Ransac<S, P, C, L, T, B, G>,
        estimator: &E,
        candidates: impl IntoIterator<Item = E::Model>,
    ) -> Selection<E::Model>
    where
        E: Estimator,
        S: Scorer<E>,
        C: Constraints<E>,
    {
        let scorer = &search.scorer;
        let models: Vec<E::Model> = candidates
            .into_iter()
            .filter(|m| search.constraints.refusing_model(estimator, m).is_none())
            .collect();
        let claims = models.iter().map(|m| claim(estimator, scorer, m)).collect();
        let nobody = Share {
            owner: NOBODY,
            gain: 0.0,
            second: 0.0,
        };
        let mut contest = Contest {
            estimator,
            scorer,
            constraints: &search.constraints,
            penalty: self.penalty,
            needed: search.settings.min_inliers.max(E::SAMPLE_SIZE).max(1),
            models,
            claims,
            chosen: Vec::new(),
            shares: vec![nobody; estimator.len()],
        };
        contest.choose();
        let mut rounds = 0;
        while rounds < self.max_rounds && contest.refit() {
            rounds += 1;
            contest.choose();
        }
        contest.selection(rounds)
    }
}

/// The state of one competition.
struct Contest<'a, E: Estimator, S, C> {
    estimator: &'a E,
    scorer: &'a S,
    constraints: &'a C,
    penalty: f64,
    /// The least number of data of a model.
    needed: usize,
    models: Vec<E::Model>,
    /// Without an entry for a model that is struck off.
    claims: Vec<Claim>,
    /// Ascending, so that neither shares nor sums depend on the way here.
    chosen: Vec<usize>,
    shares: Vec<Share>,
}

impl<E: Estimator, S: Scorer<E>, C: Constraints<E>> Contest<'_, E, S, C> {
    /// A rise that is no rounding error of the sums.
    fn least_rise(&self) -> f64 {
        1e-9 * (1.0 + self.worth().abs() + self.penalty.min(f64::MAX))
    }

    fn worth(&self) -> f64 {
        let gains: f64 = self.shares.iter().map(|share| share.gain).sum();
        if self.chosen.is_empty() {
            0.0
        } else {
            gains - self.penalty * self.chosen.len() as f64
        }
    }

    fn share_out(&mut self) {
        share_out(&self.claims, &self.chosen, &mut self.shares);
    }

    fn owned(&self, model: usize) -> Vec<usize> {
        let all = self.shares.iter().enumerate();
        all.filter(|(_, share)| share.owner == model)
            .map(|(datum, _)| datum)
            .collect()
    }

    /// Moves while a move raises the worth, and strikes off models that are left with too few data.
    fn choose(&mut self) {
        loop {
            self.share_out();
            let least = self.least_rise();
            let best = best_move(
                &self.claims,
                &self.chosen,
                &self.shares,
                self.penalty,
                least,
            );
            if let Some((step, _)) = best {
                self.chosen.retain(|&m| Some(m) != step.leaves);
                self.chosen.extend(step.enters);
                self.chosen.sort_unstable();
                continue;
            }
            let mut data = vec![0; self.models.len()];
            for share in self.shares.iter().filter(|share| share.owner != NOBODY) {
                data[share.owner] += 1;
            }
            let smallest = self.chosen.iter().copied().min_by_key(|&m| data[m]);
            match smallest.filter(|&m| data[m] < self.needed) {
                Some(small) => {
                    self.claims[small].clear();
                    self.chosen.retain(|&m| m != small);
                }
                None => return,
            }
        }
    }

    /// Refits the chosen models to their own data, one after the other; whether the worth has risen.
    fn refit(&mut self) -> bool {
        let mut risen = false;
        for model in self.chosen.clone() {
            let data = self.owned(model);
            if data.len() < self.needed {
                continue;
            }
            let refitted = self.estimator.refit(&data, &self.models[model]);
            let refitted = refitted.and_then(|refit| {
                allowed(self.constraints, self.estimator, &data, None, refit).ok()
            });
            let Some(refitted) = refitted else { continue };
            let (before, least) = (self.worth(), self.least_rise());
            let new = claim(self.estimator, self.scorer, &refitted);
            let old = std::mem::replace(&mut self.claims[model], new);
            self.share_out();
            if self.worth() > before + least {
                self.models[model] = refitted;
                risen = true;
            } else {
                self.claims[model] = old;
                self.share_out();
            }
        }
        risen
    }

    fn selection(self, rounds: usize) -> Selection<E::Model> {
        let mut buffer = Vec::new();
        let mut instances: Vec<Instance<E::Model>> = Vec::with_capacity(self.chosen.len());
        for &number in &self.chosen {
            let (data, model) = (self.owned(number), self.models[number].clone());
            let (sigma, covariance) = uncertainty(self.estimator, self.scorer, &model, &data);
            let own = self.shares.iter().filter(|share| share.owner == number);
            instances.push(Instance {
                score: own.map(|share| share.gain).sum(),
                residuals: residual_statistics(self.estimator, &model, &data, &mut buffer),
                sigma,
                covariance,
                model,
                data,
            });
        }
        instances.sort_by(|a, b| b.score.total_cmp(&a.score));
        Selection {
            instances,
            rest: self.owned(NOBODY),
            worth: self.worth(),
            rounds,
        }
    }
}
