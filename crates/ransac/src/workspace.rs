use crate::{Estimator, Report, lane::Lane, runners_up::RunnersUp, settings::Settings};

/// The memory of a search, to be used again by the next one.
///
/// [`Ransac::run_with`](crate::Ransac::run_with) allocates nothing on the heap once a workspace has
/// served a search of the same shape (number of data, of threads, size of a round), as far as the
/// engine goes: an estimator that allocates in its own refit still does, and so does
/// `rayon` when threads share the work.
#[derive(Debug)]
pub struct Workspace<M> {
    pub(crate) lanes: Vec<Lane<M>>,
    pub(crate) buffers: Buffers,
    pub(crate) runners_up: RunnersUp<M>,
    pub(crate) report: Option<Report<M>>,
}

/// Lists over the data that refits and reports need.
#[derive(Debug, Default)]
pub(crate) struct Buffers {
    pub(crate) inliers: Vec<usize>,
    /// One number for each inlier: its weight in a refit, its residual in a report.
    pub(crate) numbers: Vec<f64>,
}

impl<M> Workspace<M> {
    /// An empty workspace; it grows in its first search.
    pub fn new() -> Self {
        Self {
            lanes: Vec::new(),
            buffers: Buffers::default(),
            runners_up: RunnersUp::default(),
            report: None,
        }
    }

    /// The report of the last search, if it found a model; leaves none.
    pub fn take_report(&mut self) -> Option<Report<M>> {
        self.report.take()
    }

    /// Readies the memory for a search.
    pub(crate) fn prepare<E: Estimator<Model = M>>(
        &mut self,
        data: usize,
        runners_up: usize,
        settings: Settings,
    ) {
        self.runners_up.prepare(runners_up, data);
        // The last report's list of inliers serves again.
        if let Some(report) = self.report.take() {
            self.buffers.inliers = report.inliers;
        }
        self.buffers.inliers.clear();
        self.buffers.inliers.reserve(data);
        self.buffers.numbers.clear();
        self.buffers.numbers.reserve(data);
        self.lanes.resize_with(settings.threads, Lane::new);
        for lane in &mut self.lanes {
            lane.prepare(E::SAMPLE_SIZE, E::MAX_MODELS, settings.round);
        }
    }
}

impl<M> Default for Workspace<M> {
    fn default() -> Self {
        Self::new()
    }
}
