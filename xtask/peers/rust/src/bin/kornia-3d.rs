//! kornia-3d's RANSAC driver: hard threshold, refits of the best model so far.

use kornia_3d::ransac::{
    Consensus, ConsensusOutcome, Estimator, RansacConfig, Sampler, ThresholdConsensus, run_with_rng,
};
use rand_0_10::{RngExt, SeedableRng, rngs::StdRng};
use rust_peers::{Fitted, Job, Point, Primitive, serve};
use std::marker::PhantomData;

struct Fitter<'a, M> {
    job: &'a Job,
    model: PhantomData<M>,
}

impl<M: Primitive> Estimator for Fitter<'_, M> {
    type Model = M;
    type Sample = Point;
    const SAMPLE_SIZE: usize = M::SAMPLE;

    fn fit(&self, samples: &[Point], out: &mut Vec<M>) {
        out.extend(M::through(samples, self.job));
    }

    fn residual(&self, model: &M, sample: &Point) -> f64 {
        model.distance(sample)
    }

    fn refit(&self, inliers: &[Point], out: &mut Vec<M>) {
        let start = inliers
            .chunks_exact(M::SAMPLE)
            .find_map(|sample| M::through(sample, self.job));
        out.extend(start.and_then(|model| model.refitted(inliers)));
    }
}

/// Its hard threshold. The driver stops early by the inliers that it is told of, which for a fixed
/// number of hypotheses are none.
struct Threshold {
    inner: ThresholdConsensus,
    adaptive: bool,
}

impl Consensus for Threshold {
    fn consensus(&self, residuals: &[f64], inliers_out: &mut Vec<bool>) -> ConsensusOutcome {
        let outcome = self.inner.consensus(residuals, inliers_out);
        ConsensusOutcome {
            inlier_count: if self.adaptive {
                outcome.inlier_count
            } else {
                0
            },
            ..outcome
        }
    }
}

/// Its driver counts samples: this one draws until the bounds allow one, so that each is scored.
struct Allowed<'a, M> {
    points: &'a [Point],
    job: &'a Job,
    rng: StdRng,
    model: PhantomData<M>,
}

impl<M: Primitive> Sampler for Allowed<'_, M> {
    fn sample(&mut self, n: usize, out: &mut [usize]) {
        for _ in 0..1000 {
            for i in 0..out.len() {
                out[i] = self.rng.random_range(0..n);
                while out[..i].contains(&out[i]) {
                    out[i] = self.rng.random_range(0..n);
                }
            }
            let mut sample = [Point::zeros(); 4];
            sample
                .iter_mut()
                .zip(out.iter())
                .for_each(|(slot, &i)| *slot = self.points[i]);
            if M::through(&sample[..M::SAMPLE], self.job).is_some() {
                return;
            }
        }
    }
}

fn fit<M: Primitive>(points: &Vec<Point>, job: &Job) -> Option<Fitted<M>> {
    let config = RansacConfig {
        max_iters: job.hypotheses as u32,
        confidence: job.confidence,
        inlier_threshold: job.threshold,
        lo_every: 1,
        ..RansacConfig::default()
    };
    let mut rng = StdRng::seed_from_u64(job.seed);
    let mut sampler = Allowed::<M> {
        points,
        job,
        rng: StdRng::seed_from_u64(job.seed),
        model: PhantomData,
    };
    let result = run_with_rng(
        &Fitter {
            job,
            model: PhantomData,
        },
        &Threshold {
            inner: ThresholdConsensus {
                threshold: job.threshold,
            },
            adaptive: job.confidence > 0.0,
        },
        &mut sampler,
        points,
        &config,
        &mut rng,
    );
    let model: M = result.model?;
    Some(Fitted {
        model: model.settled(points, job),
        hypotheses: result.num_iters as usize,
    })
}

fn main() {
    serve(|points, _| points.to_vec(), fit, fit);
}
