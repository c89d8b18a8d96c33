//! A search in a reused workspace allocates nothing.

use pomona_ransac::{Estimator, FixedCount, LeastSquares, Msac, Ransac, Statistical, Workspace};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

mod numbers;
use numbers::Numbers;

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

#[test]
fn nothing_is_allocated_after_the_first_search() {
    let data = Numbers::noisy(1, 5000);
    let smaller = Numbers::noisy(2, 3000);
    let search = Ransac::new(Msac::within(0.7))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(500))
        .preemption(Statistical::with_error(0.01));
    let fresh = search
        .run(&data, &mut ChaCha8Rng::seed_from_u64(3))
        .unwrap();

    let mut workspace = Workspace::new();
    let warm_up = search.run_with(&mut workspace, &data, &mut ChaCha8Rng::seed_from_u64(2));
    assert!(warm_up.is_ok());
    for _ in 0..3 {
        let before = ALLOCATIONS.get();
        let small = search.run_with(&mut workspace, &smaller, &mut ChaCha8Rng::seed_from_u64(3));
        assert!(small.unwrap().inliers.len() < smaller.len());
        let report = search.run_with(&mut workspace, &data, &mut ChaCha8Rng::seed_from_u64(3));
        assert_eq!(report.unwrap(), &fresh);
        assert_eq!(ALLOCATIONS.get(), before);
    }
}
