//! Data are read once for many hypotheses, and few hypotheses are computed in vain.

use pomona_ransac::{
    BLOCK, Candidates, Confidence, Estimator, Exhaustive, FixedCount, InlierCount, Ransac, Stopping,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Numbers of which half agree, and a count of how they were read.
struct Reads {
    data: usize,
    /// Blocks read, and how often it was another block than the one before.
    blocks: AtomicUsize,
    changes: AtomicUsize,
    latest: AtomicUsize,
    fits: AtomicUsize,
}

impl Reads {
    fn of(data: usize) -> Self {
        Self {
            data,
            blocks: AtomicUsize::new(0),
            changes: AtomicUsize::new(0),
            latest: AtomicUsize::new(usize::MAX),
            fits: AtomicUsize::new(0),
        }
    }
}

impl Estimator for Reads {
    type Model = bool;
    const SAMPLE_SIZE: usize = 2;

    fn len(&self) -> usize {
        self.data
    }
    fn fit(&self, sample: &[usize], candidates: &mut Candidates<bool>) {
        self.fits.fetch_add(1, Relaxed);
        candidates.push(sample.iter().all(|i| i % 2 == 0));
    }
    fn refit(&self, _: &[usize], _: &bool) -> Option<bool> {
        None
    }
    fn residuals(&self, model: &bool, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = if *model && i % 2 == 0 { 0.0 } else { 9.0 };
        }
    }
    fn count_within(&self, model: &bool, block: Range<usize>, _: f64) -> usize {
        assert!(block.len() <= BLOCK);
        self.blocks.fetch_add(1, Relaxed);
        let latest = self.latest.swap(block.start, Relaxed);
        self.changes
            .fetch_add(usize::from(latest != block.start), Relaxed);
        if *model { block.len().div_ceil(2) } else { 0 }
    }
}

fn run<T: Stopping>(data: &Reads, stopping: T, seed: u64) -> u64 {
    let search = Ransac::new(InlierCount::within(1.0))
        .stopping(stopping)
        .preemption(Exhaustive);
    let report = search.run(data, &mut ChaCha8Rng::seed_from_u64(seed));
    report.expect("a model").counts.draws
}

#[test]
fn a_block_is_read_once_for_many_hypotheses() {
    let data = Reads::of(1_000_000);
    run(&data, FixedCount::new(1000), 1);
    let (blocks, changes) = (data.blocks.load(Relaxed), data.changes.load(Relaxed));
    let passes = 1_000_000_usize.div_ceil(BLOCK) + 3;
    assert!(blocks >= 1000 * (passes - 3));
    // Six rounds grow to 32, and 31 more make up the thousand.
    let shared = blocks as f64 / changes as f64;
    assert!(shared > 25.0, "{shared} hypotheses for each block read");
}

#[test]
fn few_samples_are_computed_in_vain() {
    let data = Reads::of(1000);
    for count in [1, 2, 3, 10, 50, 333, 5000] {
        data.fits.store(0, Relaxed);
        assert_eq!(run(&data, FixedCount::new(count), 1), count);
        assert_eq!(data.fits.load(Relaxed) as u64, count);
    }
    // A rule that knows its end only once it has a good model.
    let (mut drawn, mut computed) = (0, 0);
    for seed in 0..200 {
        data.fits.store(0, Relaxed);
        let draws = run(&data, Confidence::new(0.999, 100_000), seed);
        let fits = data.fits.load(Relaxed) as u64;
        assert!(fits <= 2 * draws + 1, "{fits} for {draws}");
        (drawn, computed) = (drawn + draws, computed + fits);
    }
    assert!(computed * 10 <= drawn * 11, "{computed} for {drawn}");
}
