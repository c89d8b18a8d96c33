//! A search in a reused workspace allocates nothing.

use pomona_ransac::{
    Constraints, Draws, Estimator, FixedCount, LeastSquares, Local, LocalOptimization, Marginal,
    MarginalScore, Msac, NearBest, Pairs, Partners, PerDatum, Preemption, Prosac, Ransac,
    Reweighted, Sampler, Scorer, Statistical, Stopping, Tukey, Workspace,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use crate::lines::{Line, Points};
use crate::numbers::Numbers;

struct Counting;

thread_local! {
    /// Of this thread alone: the test harness allocates on its own.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    ALLOCATIONS.set(ALLOCATIONS.get() + 1);
}

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of this same function.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// After one search to warm up, others on the same data and on fewer allocate nothing.
fn check<E, S, P, C, L, T, B>(search: &Ransac<S, P, C, L, T, B>, data: &E, smaller: &E)
where
    E: Estimator<Model: PartialEq + std::fmt::Debug>,
    S: Scorer<E>,
    P: Sampler<E>,
    C: Constraints<E>,
    L: LocalOptimization<E>,
    T: Stopping,
    B: Preemption,
{
    let rng = ChaCha8Rng::seed_from_u64;
    let fresh = search.run(data, &mut rng(3)).expect("a model");
    let mut workspace = Workspace::new();
    let warm_up = search.run_with(&mut workspace, data, &mut rng(2));
    assert!(warm_up.is_ok());
    for _ in 0..3 {
        let before = ALLOCATIONS.get();
        let small = search.run_with(&mut workspace, smaller, &mut rng(3));
        assert!(small.is_ok_and(|report| report.inliers.len() < smaller.len()));
        let report = search.run_with(&mut workspace, data, &mut rng(3));
        assert_eq!(report.expect("a model"), &fresh);
        assert_eq!(ALLOCATIONS.get(), before);
    }
}

#[test]
fn nothing_is_allocated_after_the_first_search() {
    let (data, smaller) = (Numbers::noisy(1, 5000), Numbers::noisy(2, 3000));
    let search = Ransac::new(Msac::within(0.7))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(500))
        .preemption(Statistical::with_error(0.01));
    check(&search, &data, &smaller);
    let near = NearBest::new(Reweighted::by(Marginal::weight));
    check(&search.local_optimization(near), &data, &smaller);
}

fn scene(seed: u64, len: usize) -> Points {
    let mut draws = Draws::new(seed, 0);
    let mut points = Points::default();
    let (slope, intercept) = (0.4, 0.1);
    points.add_line(&mut draws, Line { slope, intercept }, len / 3, 0.03);
    points.add_outliers(&mut draws, len - len / 3, 1.0);
    points
}

/// The data that a sampler of neighbours, or of pairs, may join.
#[derive(Clone)]
struct Near;

impl Partners for Near {
    fn count(&self, _: usize) -> usize {
        9
    }
    fn get(&self, datum: usize, k: usize) -> usize {
        if datum < 10 {
            datum + 1 + k
        } else {
            datum - 1 - k
        }
    }
}

#[test]
fn nor_with_other_samplers_and_scorers_and_with_a_covariance() {
    let (data, smaller) = (scene(1, 3000), scene(2, 1500));
    let about = |datum: usize, out: &mut Vec<usize>| out.extend(datum.saturating_sub(9)..datum + 9);
    let plain = Ransac::new(MarginalScore::within(0.1))
        .local_optimization(NearBest::new(LeastSquares::default()))
        .stopping(FixedCount::new(300));
    check(&plain, &data, &smaller);
    check(&plain.sampler(Local::new(about)), &data, &smaller);
    // Samplers and scores that know their data by number serve data of one size alone.
    let other = scene(2, 3000);
    let quality: Vec<f64> = (0..3000).map(f64::from).collect();
    let prosac = Prosac::by_quality(&quality, 2, 100);
    check(&plain.sampler(prosac), &data, &other);
    check(&plain.sampler(Pairs::new(3000, Near)), &data, &other);
    let each = PerDatum::new(Tukey, vec![0.1; 3000]).expect("thresholds");
    let each = each.weights(vec![0.5; 3000]).expect("weights");
    let each = Ransac::new(each)
        .local_optimization(Reweighted::by(Tukey::weight))
        .preemption(Statistical::with_error(0.1));
    check(&each, &data, &other);
}
