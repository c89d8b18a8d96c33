use crate::{Estimator, Scorer, estimator::blocks};

/// The data that a model could have, ascending, and what each would gain with it.
pub(super) type Claim = Vec<(usize, f64)>;

/// What `model` gains with each of its inliers.
pub(super) fn claim<E: Estimator, S: Scorer<E>>(
    estimator: &E,
    scorer: &S,
    model: &E::Model,
) -> Claim {
    let mut inliers = Vec::new();
    scorer.select(estimator, model, &mut inliers);
    let mut claim = Vec::with_capacity(inliers.len());
    let mut next = inliers.iter().copied().peekable();
    for block in blocks(estimator.len()) {
        estimator.fold_residuals(model, block, (), |(), datum, residual| {
            if next.next_if_eq(&datum).is_some() {
                let fraction = scorer.fraction_of(model, datum, residual);
                let gain = scorer.weight_of(datum) * scorer.gain_at(fraction);
                if gain >= 0.0 {
                    claim.push((datum, gain));
                }
            }
        });
    }
    claim
}

/// No model.
pub(super) const NOBODY: usize = usize::MAX;

/// What a datum gains with the best and with the second best of the chosen models.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    pub(super) owner: usize,
    pub(super) gain: f64,
    pub(super) second: f64,
}

/// Shares out the data among `chosen` models: each goes where it gains most, to the first where it gains
/// as much with several.
pub(super) fn share_out(claims: &[Claim], chosen: &[usize], shares: &mut [Share]) {
    shares.fill(Share {
        owner: NOBODY,
        gain: 0.0,
        second: 0.0,
    });
    for &model in chosen {
        for &(datum, gain) in &claims[model] {
            let share = &mut shares[datum];
            if share.owner == NOBODY || gain > share.gain {
                share.second = share.gain;
                share.gain = gain;
                share.owner = model;
            } else {
                share.second = share.second.max(gain);
            }
        }
    }
}

/// A change of the set of chosen models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Move {
    pub(super) leaves: Option<usize>,
    pub(super) enters: Option<usize>,
}

/// The move that raises Σ gain − penalty · models most, and by how much; the first of equal ones, `None` where
/// none raises it by more than `least`.
pub(super) fn best_move(
    claims: &[Claim],
    chosen: &[usize],
    shares: &[Share],
    penalty: f64,
    least: f64,
) -> Option<(Move, f64)> {
    // What is lost with each of the chosen.
    let mut lost = vec![0.0; claims.len()];
    for share in shares.iter().filter(|share| share.owner != NOBODY) {
        lost[share.owner] += share.gain - share.second;
    }
    let leaving = || std::iter::once(None).chain(chosen.iter().copied().map(Some));
    let entering = |leaves: Option<usize>| {
        let idle = (0..claims.len()).filter(|m| !claims[*m].is_empty() && !chosen.contains(m));
        std::iter::once(None)
            .chain(idle.map(Some))
            .filter(move |enters| leaves.is_some() || enters.is_some())
    };
    let mut best = None;
    let mut most = least;
    for leaves in leaving() {
        let kept = leaves.map_or(0.0, |model| penalty - lost[model]);
        for enters in entering(leaves) {
            let gained = enters.map_or(0.0, |model| {
                let more = claims[model].iter().map(|&(datum, gain)| {
                    let share = &shares[datum];
                    let without = if leaves == Some(share.owner) {
                        share.second
                    } else {
                        share.gain
                    };
                    (gain - without).max(0.0)
                });
                more.sum::<f64>() - penalty
            });
            if kept + gained > most {
                most = kept + gained;
                best = Some((Move { leaves, enters }, most));
            }
        }
    }
    best
}
