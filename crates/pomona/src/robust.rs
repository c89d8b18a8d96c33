//! The method `robust`: a flattened body with priors, branches seen as strips with two ends, and answers that
//! know how sure they are.

mod apple;
mod axis;
mod blocks;
mod body;
mod branch;
mod confidence;
mod contour;
mod lines;
mod ray;
mod shell;
mod sphere;
mod strips;
mod view;
mod walk;

use crate::config::{Config, RobustConfig};
use crate::frame::CheckedFrame;
use crate::optics::{DepthNoise, window_of_box};
use crate::outcome::{
    AppleAnswer, BranchCandidate, FittedApple, FittedBranch, PickDirection, Status,
};
use apple::{AppleBuffers, AppleSearch, MARGIN_PX, SeenApple};
use branch::{Candidate, Search};
use pomona_cloud::{PixelBox, PixelWindow};
use pomona_transforms::{Direction, Position, PositionCovariance};
use rand_chacha::ChaCha8Rng;
use shell::{APPLE, Shell};
use std::time::Instant;
use walk::Slice;

/// Radii about the centre within which branches are looked for, beside the length along them.
const SHELL_MARGIN: f64 = 0.4;

/// Buffers that serve one apple after another.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    apple: AppleBuffers,
    shell: Shell,
    slices: Vec<(f64, Slice)>,
}

/// Answers one box, stage by stage. `scratch` is memory that serves one apple after another.
pub(crate) fn pick_apple(
    frame: &CheckedFrame<'_>,
    config: &Config,
    id: usize,
    bounds: PixelBox,
    rng: &mut ChaCha8Rng,
    scratch: &mut Scratch,
) -> AppleAnswer {
    let mut answer = AppleAnswer::new(id, bounds, Status::Picked);
    let (width, height) = frame.size();
    let window = window_of_box(&answer.bounds, width, height);
    let found = find_apple(frame, config, window, rng, &mut scratch.apple, &mut answer)
        .and_then(|apple| find_branch(frame, &config.robust, window, &apple, scratch, &mut answer));
    if let Err(status) = found {
        answer.status = status;
    }
    answer
}

/// Fits the body of the apple whose box is `window`.
fn find_apple(
    frame: &CheckedFrame<'_>,
    config: &Config,
    window: PixelWindow,
    rng: &mut ChaCha8Rng,
    buffers: &mut AppleBuffers,
    answer: &mut AppleAnswer,
) -> Result<SeenApple, Status> {
    let start = Instant::now();
    let (width, height) = frame.size();
    let around = window.grown(MARGIN_PX, width, height);
    let projection = frame.projection();
    buffers.patch.fill(&frame.frame().depth, projection, around);
    answer.times.crop = start.elapsed();

    let start = Instant::now();
    let search = AppleSearch {
        config: &config.robust,
        fruit: &config.fruit,
        projection,
        noise: DepthNoise::of(&config.robust),
        bounds: &answer.bounds,
        window,
    };
    let found = search.fit(rng, buffers);
    answer.times.sphere = start.elapsed();
    found
}

/// Adds the apple to the answer, and its branch and direction where one is sure enough.
fn find_branch(
    frame: &CheckedFrame<'_>,
    config: &RobustConfig,
    window: PixelWindow,
    found: &SeenApple,
    scratch: &mut Scratch,
    answer: &mut AppleAnswer,
) -> Result<(), Status> {
    let start = Instant::now();
    let noise = DepthNoise::of(config);
    let body = found.fit.body;
    let apple = body.sphere();
    let reach = (config.branch_reach + SHELL_MARGIN) * apple.radius;
    let shell = &mut scratch.shell;
    let projection = frame.projection();
    shell.fill(&frame.frame().depth, projection, &body, reach, noise);
    let inliers = shell.surface_count(&body, window, noise);
    answer.apple = Some(fitted_apple(found, inliers));
    answer.evidence.surface = shell.pixels_of(APPLE);
    let search = Search {
        shell,
        projection,
        apple,
        sigma: noise.sigma(apple.center.z),
        config,
    };
    let ranked = search.candidates(&mut scratch.slices);
    answer.candidates = ranked.iter().map(branch_candidate).collect();
    let decided = decide(found, &ranked, config, answer);
    match (&decided, ranked.first()) {
        (Ok(()), Some(best)) => {
            search.pixels(best, &mut scratch.slices, &mut answer.evidence.branch);
        }
        _ => answer.view_from = view::clearest(shell, &apple),
    }
    answer.times.branch = start.elapsed();
    decided
}

/// Adds the branch and, where it is sure enough, the direction.
fn decide(
    found: &SeenApple,
    ranked: &[Candidate],
    config: &RobustConfig,
    answer: &mut AppleAnswer,
) -> Result<(), Status> {
    let Some(best) = ranked.first() else {
        return Err(confidence::without_candidate(found));
    };
    let center = Position::new(found.fit.body.center);
    let sd = (found.fit.covariance.trace() / 3.0)
        .sqrt()
        .hypot(best.foot_sd)
        / best.distance.max(1e-3);
    let confidence = confidence::confidence(found, ranked);
    answer.confidence = Some(confidence);
    let foot = Position::new(best.foot);
    answer.branch = Some(FittedBranch::new(
        foot,
        Direction::from_unit(best.tangent),
        best.tally.pixels,
        best.rms,
    ));
    if confidence < config.least_confidence {
        return Err(confidence::refusal(found, ranked));
    }
    let pick = PickDirection::new(&center, foot).ok_or(Status::NoBranch)?;
    answer.pick = Some(PickDirection {
        sd_rad: Some(sd),
        ..pick
    });
    Ok(())
}

fn fitted_apple(found: &SeenApple, inliers: usize) -> FittedApple {
    let fit = &found.fit;
    let center = Position::new(fit.body.center);
    FittedApple {
        center_covariance: Some(PositionCovariance::new(fit.covariance)),
        radius_sd_m: Some(fit.radius_sd),
        visible_share: Some(found.visible_share),
        agreement: Some(found.agreement),
        ..FittedApple::new(center, fit.body.radius, inliers, fit.rms)
    }
}

fn branch_candidate(c: &Candidate) -> BranchCandidate {
    let (foot, tangent) = (Position::new(c.foot), Direction::from_unit(c.tangent));
    BranchCandidate {
        shown_m: c.tally.shown,
        shown_lesser_side_m: c.tally.shown_lesser_side,
        odd_m: c.tally.odd,
        empty_m: c.tally.empty,
        hidden_m: c.tally.hidden,
        ..BranchCandidate::new(foot, tangent, c.axis.radius, c.distance, c.score)
    }
}
