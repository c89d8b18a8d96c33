/// Models that are known before a search, with which it starts: the answer to the frame before, what a detector
/// suggests, the points of a coarse grid.
///
/// Given to [`Ransac::initial_models`](crate::Ransac::initial_models) as a slice or a vector. The models are compared in
/// their order before the first sample is drawn. They obey the constraints, are refitted, and are kept as runners-up, as if
/// samples had given them. Since they are no samples, a [`Stopping`](crate::Stopping) rule does not count
/// them among its draws and hypotheses, nor does the confidence; [`Counts::initial`](crate::Counts::initial) does.
///
/// A rule that holds before the first sample ends the search after the comparison of these models.
pub trait InitialModels<M>: Sync {
    /// The models, in the order in which they are compared.
    fn models(&self) -> &[M];
}

/// No model is known before the search.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoInitialModels;

impl<M> InitialModels<M> for NoInitialModels {
    fn models(&self) -> &[M] {
        &[]
    }
}

impl<M: Sync> InitialModels<M> for &[M] {
    fn models(&self) -> &[M] {
        self
    }
}

impl<M: Sync> InitialModels<M> for Vec<M> {
    fn models(&self) -> &[M] {
        self
    }
}
