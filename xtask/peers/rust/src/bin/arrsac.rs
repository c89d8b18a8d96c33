//! arrsac with its default schedule, which has no setting for the number of hypotheses or a confidence.

use arrsac::Arrsac;
use rand_0_9::{SeedableRng, rngs::SmallRng, seq::SliceRandom};
use rust_peers::{Fitted, Job, Point, Primitive, serve};
use sample_consensus::{Consensus, Estimator, Model};
use std::cell::Cell;
use std::marker::PhantomData;

struct Fitter<'a, M> {
    job: &'a Job,
    hypotheses: Cell<usize>,
    model: PhantomData<M>,
}

/// A model of arrsac's own trait.
struct Candidate<M>(M);

impl<M: Primitive> Model<Point> for Candidate<M> {
    fn residual(&self, point: &Point) -> f64 {
        self.0.distance(point)
    }
}

impl<M: Primitive> Estimator<Point> for Fitter<'_, M> {
    type Model = Candidate<M>;
    type ModelIter = Option<Candidate<M>>;
    const MIN_SAMPLES: usize = M::SAMPLE;

    fn estimate<I: Iterator<Item = Point> + Clone>(&self, data: I) -> Self::ModelIter {
        let mut sample = [Point::zeros(); 4];
        sample
            .iter_mut()
            .zip(data)
            .for_each(|(slot, point)| *slot = point);
        let model = M::through(&sample[..M::SAMPLE], self.job)?;
        self.hypotheses.set(self.hypotheses.get() + 1);
        Some(Candidate(model))
    }
}

/// It wants its data in random order.
fn prepare(points: &[Point], job: &Job) -> Vec<Point> {
    let mut points = points.to_vec();
    points.shuffle(&mut SmallRng::seed_from_u64(job.seed));
    points
}

fn fit<M: Primitive>(points: &Vec<Point>, job: &Job) -> Option<Fitted<M>> {
    let fitter = Fitter::<M> {
        job,
        hypotheses: Cell::new(0),
        model: PhantomData,
    };
    let mut arrsac = Arrsac::new(job.threshold, SmallRng::seed_from_u64(job.seed));
    let Candidate(model) = arrsac.model(&fitter, points.iter().copied())?;
    Some(Fitted {
        model: model.settled(points, job),
        hypotheses: fitter.hypotheses.get(),
    })
}

fn main() {
    serve(prepare, fit, fit);
}
