//! inlier's SupeRANSAC pipeline: uniform samples, inlier count, its least-squares optimiser.

use inlier::core::{
    LeastSquaresOptimizer, NoopInlierSelector, RansacTerminationCriterion, SuperRansac,
};
use inlier::samplers::UniformRandomSampler;
use inlier::scoring::RansacInlierCountScoring;
use inlier::types::DataMatrix;
use inlier::{Estimator, RansacSettings};
use rust_peers::{Fitted, Job, Point, Primitive, serve};
use std::marker::PhantomData;

struct Fitter<M> {
    job: Job,
    model: PhantomData<M>,
}

fn point(data: &DataMatrix, row: usize) -> Point {
    Point::new(data[(row, 0)], data[(row, 1)], data[(row, 2)])
}

impl<M: Primitive> Estimator for Fitter<M> {
    type Model = M;

    fn sample_size(&self) -> usize {
        M::SAMPLE
    }

    fn is_valid_sample(&self, _: &DataMatrix, _: &[usize]) -> bool {
        true
    }

    fn estimate_model(&self, data: &DataMatrix, sample: &[usize]) -> Vec<M> {
        let mut points = [Point::zeros(); 4];
        points
            .iter_mut()
            .zip(sample)
            .for_each(|(slot, &row)| *slot = point(data, row));
        M::through(&points[..M::SAMPLE], &self.job)
            .into_iter()
            .collect()
    }

    fn estimate_model_nonminimal(
        &self,
        data: &DataMatrix,
        sample: &[usize],
        _: Option<&[f64]>,
    ) -> Vec<M> {
        let points: Vec<Point> = sample.iter().map(|&row| point(data, row)).collect();
        let start = self.estimate_model(data, &sample[..M::SAMPLE]);
        start
            .into_iter()
            .filter_map(|model| model.refitted(&points))
            .collect()
    }

    fn is_valid_model(&self, _: &M, _: &DataMatrix, _: &[usize], _: f64) -> bool {
        true
    }
}

struct Data {
    points: Vec<Point>,
    matrix: DataMatrix,
}

fn prepare(points: &[Point], _: &Job) -> Data {
    let matrix = DataMatrix::from_fn(points.len(), 3, |row, column| points[row][column]);
    Data {
        points: points.to_vec(),
        matrix,
    }
}

fn fit<M: Primitive>(data: &Data, job: &Job) -> Option<Fitted<M>> {
    let fitter = || Fitter {
        job: *job,
        model: PhantomData,
    };
    let adaptive = job.confidence > 0.0;
    let settings = RansacSettings {
        min_iterations: if adaptive { 1 } else { job.hypotheses },
        max_iterations: job.hypotheses,
        ..RansacSettings::default()
    };
    let scoring =
        RansacInlierCountScoring::new(job.threshold, |data: &DataMatrix, model: &M, row| {
            model.distance(&point(data, row))
        });
    // A confidence of 1 asks for an infinite number, which its rule leaves alone.
    let termination = RansacTerminationCriterion {
        confidence: if adaptive { job.confidence } else { 1.0 },
    };
    let mut ransac = SuperRansac::new(
        settings,
        fitter(),
        UniformRandomSampler::from_seed(job.seed),
        scoring,
        Some(LeastSquaresOptimizer::new(fitter())),
        Some(LeastSquaresOptimizer::new(fitter())),
        termination,
        Some(NoopInlierSelector),
    );
    ransac.run(&data.matrix);
    let model = ransac.best_model?;
    // Its optimisers hand back the old score, so that their models never win.
    Some(Fitted {
        model: model.settled(&data.points, job),
        hypotheses: ransac.iteration,
    })
}

fn main() {
    serve(prepare, fit, fit);
}
