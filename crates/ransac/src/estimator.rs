use crate::{Candidates, Linearization};
use std::ops::Range;

/// How many data one scoring call sees at most: a block.
///
/// A thousand points of three f32 coordinates are 12 kB, which stay in the first-level
/// cache, and between blocks the engine may abandon a model.
pub const BLOCK: usize = 1024;

/// A model to fit, and a view of the data to fit it to.
///
/// The three operations stay apart: a minimal [`fit`](Self::fit), a
/// [`refit`](Self::refit) to many data, and measuring one block of data against a model.
/// The data are numbered `0..len()`; how they are stored is the estimator's own affair.
///
/// Only [`residuals`](Self::residuals) has to be written for scoring. An
/// estimator with a faster way (compare squared distances, skip the square root,
/// use wide registers) overrides [`count_within`](Self::count_within),
/// [`truncated_gain`](Self::truncated_gain) and
/// [`select_within`](Self::select_within), and these must then agree with each
/// other to the last datum.
pub trait Estimator: Sync {
    /// What is fitted.
    type Model: Clone + Send + Sync;

    /// How many data a minimal sample has.
    const SAMPLE_SIZE: usize;

    /// How many models one minimal sample can give at most.
    const MAX_MODELS: usize = 1;

    /// How many free parameters [`linearize`](Self::linearize) gives derivatives by; 0, the
    /// default, for an estimator that gives none, and at most [`MAX_PARAMETERS`](crate::MAX_PARAMETERS).
    const PARAMETERS: usize = 0;

    /// How many data there are.
    fn len(&self) -> usize;

    /// Whether there are no data.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds to `candidates` every model through a sample of [`SAMPLE_SIZE`](Self::SAMPLE_SIZE)
    /// distinct data; none where the sample is degenerate or not finite.
    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Self::Model>);

    /// The model that fits all of `inliers` best, starting from `current`;
    /// `None` where they do not determine one.
    fn refit(&self, inliers: &[usize], current: &Self::Model) -> Option<Self::Model>;

    /// The same with a weight for each of `inliers`, none of them negative; by default the
    /// weights are ignored.
    ///
    /// [`Reweighted`](crate::Reweighted) calls it.
    fn refit_weighted(
        &self,
        inliers: &[usize],
        _weights: &[f64],
        current: &Self::Model,
    ) -> Option<Self::Model> {
        self.refit(inliers, current)
    }

    /// Writes the unsigned residuals of the data `block` into `out`, which is as long.
    ///
    /// NaN stands for a datum that no model explains; it is never an inlier.
    fn residuals(&self, model: &Self::Model, block: Range<usize>, out: &mut [f64]);

    /// Writes the unsigned residuals of the data of `data`, which ascend, into `out`, which is as long; by
    /// default from the [`residuals`](Self::residuals) of all blocks that hold one of them.
    ///
    /// What is written must be the same to the last bit.
    fn residuals_of(&self, model: &Self::Model, data: &[usize], out: &mut [f64]) {
        let mut rest = data.iter().zip(out).peekable();
        while let Some(&(&first, _)) = rest.peek() {
            let block = first..(first + BLOCK).min(self.len());
            self.fold_residuals(model, block, (), |(), datum, residual| {
                if let Some((_, r)) = rest.next_if(|&(&i, _)| i == datum) {
                    *r = residual;
                }
            });
            // A datum that does not ascend, or that is not there, has no residual.
            if let Some((_, r)) = rest.next_if(|&(&i, _)| i <= first) {
                *r = f64::NAN;
            }
        }
    }

    /// Whether two models are the same to the last bit, as far as the estimator can tell; `false` by default.
    ///
    /// The engine does not refit a model to its inliers again that it has just refitted.
    fn same_model(&self, _one: &Self::Model, _other: &Self::Model) -> bool {
        false
    }

    /// Pushes the signed residuals of one datum, with their derivatives by the
    /// [`PARAMETERS`](Self::PARAMETERS) at `model`; nothing by default, and nothing where the
    /// datum has none.
    ///
    /// One row for each component of a residual whose noise is independent: a point's offset from a
    /// sphere is one, from a line in space two, across it. The squares of a datum's rows add
    /// up to the square of its [`residual`](Self::residuals). The parameters are local ones, free of each other and
    /// 0 at `model`: two angles and two shifts for a line, not the six numbers
    /// that store it. From them come [`Report::sigma`](crate::Report::sigma) and
    /// [`Report::covariance`](crate::Report::covariance).
    fn linearize(&self, _model: &Self::Model, _datum: usize, _rows: &mut Linearization) {}

    /// How many data of `block`, at most [`BLOCK`], have a residual of at most `threshold`.
    fn count_within(&self, model: &Self::Model, block: Range<usize>, threshold: f64) -> usize {
        self.fold_residuals(model, block, 0, |count, _, r| {
            count + usize::from(r <= threshold)
        })
    }

    /// Σ max(0, 1 − (residual/threshold)²) over `block`, which has at most [`BLOCK`] data.
    ///
    /// For a threshold of zero this is the number of residuals that are zero.
    fn truncated_gain(&self, model: &Self::Model, block: Range<usize>, threshold: f64) -> f64 {
        if threshold == 0.0 {
            return self.count_within(model, block, threshold) as f64;
        }
        self.fold_residuals(model, block, 0.0, |gain, _, r| {
            if r <= threshold {
                // The lesser of NaN, an infinite residual's share of an infinite threshold, and 1 is 1.
                gain + (1.0 - (r / threshold).powi(2).min(1.0))
            } else {
                gain
            }
        })
    }

    /// Appends to `out` the data of `block`, at most [`BLOCK`], with a residual
    /// of at most `threshold`, in ascending order.
    fn select_within(
        &self,
        model: &Self::Model,
        block: Range<usize>,
        threshold: f64,
        out: &mut Vec<usize>,
    ) {
        self.fold_residuals(model, block, (), |(), i, r| {
            if r <= threshold {
                out.push(i);
            }
        });
    }

    /// Folds `f(state, datum, residual)` over the data of `block`, at most [`BLOCK`], in ascending order.
    fn fold_residuals<T>(
        &self,
        model: &Self::Model,
        block: Range<usize>,
        start: T,
        mut f: impl FnMut(T, usize, f64) -> T,
    ) -> T {
        let mut buffer = [f64::NAN; BLOCK];
        let residuals = &mut buffer[..block.len().min(BLOCK)];
        self.residuals(model, block.clone(), residuals);
        residuals
            .iter()
            .zip(block)
            .fold(start, |state, (&r, i)| f(state, i, r))
    }
}

/// How many data the first block has: few, so that a hopeless model is abandoned early.
pub(crate) const FIRST_BLOCK: usize = 128;

/// The data `0..len` in blocks that end at 128, 256, 512, 1024, 2048, 3072, ...
///
/// Gains are summed in this partition and no other, whatever the rule for giving up
/// and however the work is shared, so that a score has the same bits everywhere.
pub(crate) fn blocks(len: usize) -> impl Iterator<Item = Range<usize>> {
    let mut start = 0;
    std::iter::from_fn(move || {
        let end = (start + start.clamp(FIRST_BLOCK, BLOCK)).min(len);
        let block = start..end;
        start = end;
        (!block.is_empty()).then_some(block)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_everything_once() {
        for len in [0, 1, 128, 129, BLOCK - 1, BLOCK, BLOCK + 1, 3 * BLOCK + 7] {
            let all: Vec<usize> = blocks(len).flatten().collect();
            assert_eq!(all, (0..len).collect::<Vec<_>>());
            assert!(blocks(len).all(|b| b.len() <= BLOCK));
        }
        let ends: Vec<usize> = blocks(2500).map(|b| b.end).collect();
        assert_eq!(ends, [128, 256, 512, 1024, 2048, 2500]);
    }
}
