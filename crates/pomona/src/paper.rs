//! The published method: Gao et al. 2022, Agriculture 12(8), 1170, sections 2.2.3–2.2.5,
//! doi 10.3390/agriculture12081170.

use crate::config::{Config, PaperConfig, Radii};
use crate::frame::CheckedFrame;
use crate::optics::{window_of_box, window_of_sphere};
use crate::outcome::{AppleAnswer, FittedApple, FittedBranch, PickDirection, Status};
use nalgebra::Point3;
use pomona_cloud::{DepthPoints, PixelBox};
use pomona_fit::{
    DistanceWindow, LineEstimator, Points, RadiusWindow, Refusing, SphereEstimator, SphereRefit,
    sphere_least_squares,
};
use pomona_geometry::{Line, Sphere};
use pomona_ransac::{FixedCount, InlierCount, Ransac, RansacError, RefitOnce, Report};
use pomona_transforms::{Direction, Position};
use rand_chacha::ChaCha8Rng;
use std::time::Instant;

/// Answers one box, stage by stage. `points` is memory that serves one apple after another.
pub(crate) fn pick_apple(
    frame: &CheckedFrame<'_>,
    config: &Config,
    id: usize,
    bounds: PixelBox,
    rng: &mut ChaCha8Rng,
    points: &mut DepthPoints,
) -> AppleAnswer {
    let mut answer = AppleAnswer::new(id, bounds, Status::Picked);
    let found = find_apple(frame, config, rng, points, &mut answer)
        .and_then(|sphere| find_branch(frame, &config.paper, &sphere, rng, points, &mut answer))
        .and_then(|line| find_direction(&line, &mut answer));
    if let Err(status) = found {
        answer.status = status;
    }
    answer
}

/// Fits the sphere of the box, and adds it to the answer.
fn find_apple(
    frame: &CheckedFrame<'_>,
    config: &Config,
    rng: &mut ChaCha8Rng,
    points: &mut DepthPoints,
    answer: &mut AppleAnswer,
) -> Result<Sphere, Status> {
    let start = Instant::now();
    let (width, height) = frame.size();
    frame.copy_points(window_of_box(&answer.bounds, width, height), points);
    answer.times.crop = start.elapsed();

    let start = Instant::now();
    let sphere = fit_sphere(points, &config.paper, config.fruit.radii(), rng);
    answer.times.sphere = start.elapsed();
    let sphere = sphere?;
    answer.evidence.surface = sphere.inliers.iter().map(|&i| points.pixel[i]).collect();
    answer.apple = Some(FittedApple::new(
        Position::new(sphere.model.center),
        sphere.model.radius,
        sphere.inliers.len(),
        sphere.residuals.rms,
    ));
    Ok(sphere.model)
}

/// Fits the line of the branch in the shell about the apple, and adds it to the answer.
fn find_branch(
    frame: &CheckedFrame<'_>,
    config: &PaperConfig,
    apple: &Sphere,
    rng: &mut ChaCha8Rng,
    points: &mut DepthPoints,
    answer: &mut AppleAnswer,
) -> Result<Line, Status> {
    let start = Instant::now();
    let (width, height) = frame.size();
    let reach = Sphere {
        radius: apple.radius * config.shell_outer,
        ..*apple
    };
    let window = window_of_sphere(&reach, &frame.frame().camera, width, height);
    frame.copy_points(window, points);
    keep_shell(points, apple, config);
    let branch = fit_branch(points, apple, config, rng);
    answer.times.branch = start.elapsed();
    let branch = branch?;
    answer.evidence.branch = branch.inliers.iter().map(|&i| points.pixel[i]).collect();
    answer.branch = Some(FittedBranch::new(
        Position::new(branch.model.point),
        Direction::from_unit(branch.model.direction),
        branch.inliers.len(),
        branch.residuals.rms,
    ));
    Ok(branch.model)
}

/// Section 2.2.5: C is the foot of the perpendicular from O, and OC the direction.
fn find_direction(branch: &Line, answer: &mut AppleAnswer) -> Result<(), Status> {
    // The distance window keeps C off O unless its lower bound is 0.
    let center = answer.apple.ok_or(Status::NoSphere)?.center;
    let foot = Position::new(branch.foot(&center.point()));
    answer.pick = Some(PickDirection::new(&center, foot).ok_or(Status::NoBranch)?);
    Ok(())
}

fn points(cloud: &DepthPoints) -> Option<Points<'_, f32>> {
    Points::new(&cloud.x, &cloud.y, &cloud.z).ok()
}

/// The sphere of the points in an apple's box (section 2.2.3).
///
/// Spheres through four random points compete for the most points within r/5 of their
/// surface, r being each sphere's own radius (Eq. 2); the winner's inliers are fitted by linear
/// least squares (Eqs. 3–7). The radius window is ours: the text has none.
fn fit_sphere(
    cloud: &DepthPoints,
    config: &PaperConfig,
    radii: Radii,
    rng: &mut ChaCha8Rng,
) -> Result<Report<Sphere>, Status> {
    if cloud.is_empty() {
        return Err(Status::NoDepth);
    }
    if cloud.len() < config.sphere_min_points {
        return Err(Status::TooFewPoints);
    }
    let points = points(cloud).ok_or(Status::NoSphere)?;
    let window = RadiusWindow::new(radii.least, radii.most).map_err(|_| Status::NoSphere)?;
    let band = config.sphere_band;
    let report = Ransac::new(InlierCount::within(move |sphere: &Sphere| {
        band * sphere.radius
    }))
    .constraint(Refusing(window))
    .local_optimization(RefitOnce)
    .stopping(FixedCount::new(config.sphere_iterations))
    .min_inliers(config.sphere_min_points)
    .run(&SphereEstimator::new(points, SphereRefit::Algebraic), rng)
    .map_err(|error| match error {
        RansacError::TooFewData { .. } => Status::TooFewPoints,
        _ => Status::NoSphere,
    })?;
    // The engine kept the sphere before the refit where the refit left the radius window.
    // The paper would go on with the refit, which is no apple: better to say so.
    let refused: u64 = report.counts.rejections().iter().map(|r| r.refits).sum();
    let refittable = sphere_least_squares(points.select(&report.inliers)).is_some();
    if refused > 0 || !refittable {
        Err(Status::ImplausibleRadius)
    } else {
        Ok(report)
    }
}

/// Keeps of `cloud` what lies between the shell's radii about the apple: the paper's `M_inter`
/// (section 2.2.4), which leaves the apple's own surface out.
fn keep_shell(cloud: &mut DepthPoints, sphere: &Sphere, config: &PaperConfig) {
    let inner = (config.shell_inner * sphere.radius).powi(2);
    let outer = (config.shell_outer * sphere.radius).powi(2);
    cloud.retain(|p: Point3<f64>| (inner..=outer).contains(&(p - sphere.center).norm_squared()));
}

/// The line of the nearest branch among the points of the shell (section 2.2.4).
///
/// Lines through two random points that pass the centre at 0.5 to 1.5 radii compete for the most
/// points within 5 mm (Eq. 9); the winner's inliers are fitted by total least squares.
fn fit_branch(
    shell: &DepthPoints,
    sphere: &Sphere,
    config: &PaperConfig,
    rng: &mut ChaCha8Rng,
) -> Result<Report<Line>, Status> {
    let points = points(shell).ok_or(Status::NoBranch)?;
    let r = sphere.radius;
    let window = DistanceWindow::new(
        sphere.center,
        config.line_distance_min * r,
        config.line_distance_max * r,
    )
    .map_err(|_| Status::NoBranch)?;
    Ransac::new(InlierCount::within(config.line_band_m))
        .constraint(Refusing(window))
        .local_optimization(RefitOnce)
        .stopping(FixedCount::new(config.line_iterations))
        .min_inliers(config.line_min_points)
        .run(&LineEstimator::new(points), rng)
        .map_err(|_| Status::NoBranch)
}
