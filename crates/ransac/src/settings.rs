/// The scalar settings of a search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    pub(crate) min_inliers: usize,
    /// Iterations that one thread computes in a round at most.
    pub(crate) round: usize,
    /// Threads that share a round.
    pub(crate) threads: usize,
    /// Whether the report has the noise and the covariance.
    pub(crate) covariance: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            min_inliers: 0,
            round: 32,
            threads: 1,
            covariance: true,
        }
    }
}
