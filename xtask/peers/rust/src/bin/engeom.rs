//! engeom's sphere by MAGSAC++; it has no line in space.

use engeom::common::Magsac;
use engeom::{Point3, Sphere3};
use rust_peers::{Fitted, Job, Point, Sphere, serve};

fn fit(points: &Vec<Point3>, job: &Job) -> Option<Fitted<Sphere>> {
    let magsac = Magsac {
        max_iterations: Some(job.hypotheses),
        confidence: job.confidence,
        seed: Some(job.seed),
        ..Magsac::new(job.threshold)
    };
    let sphere = Sphere3::from_consensus(
        points,
        job.threshold,
        Some(job.min),
        Some(job.max),
        Some(magsac),
    )
    .ok()?;
    let center = sphere.center;
    let model = Sphere {
        center: Point::new(center.x, center.y, center.z),
        radius: sphere.r(),
    };
    Some(Fitted {
        model,
        hypotheses: 0,
    })
}

fn main() {
    let prepare =
        |points: &[Point], _: &Job| points.iter().map(|p| Point3::new(p.x, p.y, p.z)).collect();
    serve(prepare, fit, |_, _| None);
}
