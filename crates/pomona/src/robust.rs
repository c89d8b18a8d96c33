//! The method `robust`: a flattened spheroid with priors, branches seen as strips with two ends, and answers that
//! know how sure they are.

mod apple;
mod axis;
mod axis_fit;
mod blocks;
mod branch;
mod confidence;
mod cross_section;
mod likeness;
mod line_hypothesis;
mod nearest;
mod ray;
mod section_set;
mod shell;
mod silhouette;
mod sphere;
mod spheroid;
mod strips;
mod trust;
mod viewpoint;
mod wood;

pub use confidence::CONFIDENCE_MODEL;
pub use likeness::WOOD_MODEL;

use crate::config::{Config, RobustConfig};
use crate::frame::CheckedFrame;
use crate::optics::{DepthNoise, window_of_box};
use crate::outcome::{
    AppleAnswer, BranchCandidate, FittedApple, FittedBranch, PickDirection, Status, Weighed,
};
use apple::{AppleBuffers, AppleSearch, MARGIN_PX, SeenApple};
use branch::{Candidate, Search};
use cross_section::CrossSection;
use nalgebra::Matrix3;
use nearest::Ranked;
use pomona_cloud::{PixelBox, PixelWindow};
use pomona_transforms::{Direction, Position, PositionCovariance};
use rand_chacha::ChaCha8Rng;
use shell::{APPLE, Shell};
use std::time::Instant;
use trust::Trust;
use wood::{WoodCandidate, WoodSearch};

/// Errors of centres and of feet over their standard deviations by the scatter of the readings, which takes readings
/// for independent and things for spheroids and tubes. These two and the next were chosen on the scenes of
/// `cargo xtask fit-spread`, which prints how well the result holds.
const CENTER_EXCESS: f64 = 2.0;
const FOOT_EXCESS: f64 = 1.6;

/// Standard deviation of a centre, metres, by what its readings do not tell: leaves that lie on the apple, neighbours
/// that touch it.
const CENTER_UNSEEN_SD_M: f64 = 0.0004;

/// Share of the confidence that is lost where depth is smeared and no colour tells what is wood. Without it the answers to
/// 32 apples of two time-of-flight frames whose wood a person sees have a mean confidence of 0.83, and 13 are right; of
/// those in 60 scenes of `dense` every third one points at wood in the image.
const SMEARED_LOSS: f64 = 0.45;

/// Radii about the centre within which branches are looked for, beside the length along them.
const SHELL_MARGIN: f64 = 0.4;

/// Buffers that serve one apple after another.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    apple: AppleBuffers,
    shell: Shell,
    sections: Vec<(f64, CrossSection)>,
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
    let found =
        find_apple(frame, config, window, rng, &mut scratch.apple, &mut answer).and_then(|apple| {
            find_branch(
                frame,
                &config.robust,
                window,
                &apple,
                rng,
                scratch,
                &mut answer,
            )
        });
    if let Err(status) = found {
        answer.status = status;
    }
    answer
}

/// Fits the spheroid of the apple whose box is `window`.
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
        noise: DepthNoise::of(&config.robust, frame.depth_quality()),
        trust: Trust::of(&config.robust, frame.depth_quality()),
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
    rng: &mut ChaCha8Rng,
    scratch: &mut Scratch,
    answer: &mut AppleAnswer,
) -> Result<(), Status> {
    let start = Instant::now();
    let noise = DepthNoise::of(config, frame.depth_quality());
    let spheroid = found.fit.spheroid;
    let apple = spheroid.sphere();
    let reach = (config.branch_reach + SHELL_MARGIN) * apple.radius;
    let shell = &mut scratch.shell;
    let projection = frame.projection();
    shell.fill(&frame.frame().depth, projection, &spheroid, reach, noise);
    let inliers = shell.surface_count(&spheroid, window, noise);
    answer.apple = Some(fitted_apple(found, inliers));
    answer.evidence.surface = shell.pixels_of(APPLE);
    let search = Search {
        shell,
        projection,
        apple,
        sigma: noise.sigma(apple.center.z),
        config,
    };
    let candidates = search.candidates(&mut scratch.sections);
    let weighed = |candidate: &Candidate| {
        let features = likeness::features(candidate, &apple, search.sigma);
        Weighed::new(Position::new(candidate.foot), &features)
    };
    let weighed: Vec<Weighed> = candidates.iter().map(weighed).collect();
    let smear = frame.depth_quality().smear();
    let by_wood: Vec<f64> = weighed
        .iter()
        .zip(&candidates)
        .map(|(weighed, c)| likeness::probability(&weighed.features, c.score, smear))
        .collect();
    answer.evidence.weighed = weighed;
    // Leaves' edges in smeared depth look like twigs.
    let believed = 1.0 - SMEARED_LOSS * smear;
    let by_depth = nearest::ranked(&candidates, &by_wood, &apple, config.nearest_first);
    let distinct: Vec<Candidate> = by_depth.iter().map(|c| c.candidate).collect();
    let (ranked, decided) = match frame.wood() {
        None => {
            answer.candidates = distinct.iter().map(branch_candidate).collect();
            let decided = decide(found, &by_depth, config, believed, answer);
            (distinct, decided)
        }
        Some(wood) => {
            let search = WoodSearch {
                wood,
                depth: &frame.frame().depth,
                projection,
                apple,
                bounds: &answer.bounds,
                sigma: search.sigma,
                smear: frame.depth_quality().smear(),
                config,
            };
            let ranked = search.candidates(&by_depth, rng);
            answer.candidates = ranked.iter().map(wood_candidate).collect();
            let decided = decide_by_wood(found, &ranked, config, answer);
            (ranked.iter().map(|c| c.candidate).collect(), decided)
        }
    };
    match (&decided, ranked.first()) {
        (Ok(()), Some(best)) => {
            search.pixels(best, &mut scratch.sections, &mut answer.evidence.branch);
        }
        _ => answer.view_from = viewpoint::least_occluded_direction(shell, &apple),
    }
    answer.times.branch = start.elapsed();
    decided
}

/// Adds the branch and, where it is sure enough, the direction. `believed` is the share of the confidence that the
/// frame's depth deserves.
fn decide(
    found: &SeenApple,
    ranked: &[Ranked],
    config: &RobustConfig,
    believed: f64,
    answer: &mut AppleAnswer,
) -> Result<(), Status> {
    let Some(best) = ranked.first().map(|best| &best.candidate) else {
        return Err(confidence::without_candidate(found));
    };
    let center = Position::new(found.fit.spheroid.center);
    let scatter = (found.fit.covariance.trace() / 3.0)
        .sqrt()
        .hypot(best.foot_sd)
        / best.distance.max(1e-3);
    let features = confidence::features(found, ranked, scatter);
    let confidence = features.as_ref().map_or(0.0, confidence::probability) * believed;
    answer.evidence.confidence_features = features;
    answer.confidence = Some(confidence);
    let foot = Position::new(best.foot);
    answer.branch = Some(FittedBranch::new(
        foot,
        Direction::from_unit(best.tangent),
        best.support.pixels,
        best.rms,
    ));
    if confidence < config.least_confidence {
        return Err(confidence::refusal(found, ranked));
    }
    let pick = PickDirection::new(&center, foot).ok_or(Status::NoBranch)?;
    answer.pick = Some(PickDirection {
        sd_rad: Some(direction_sd(found, best)),
        ..pick
    });
    Ok(())
}

/// The same where the colour image tells what is wood.
fn decide_by_wood(
    found: &SeenApple,
    ranked: &[WoodCandidate],
    config: &RobustConfig,
    answer: &mut AppleAnswer,
) -> Result<(), Status> {
    let Some(best) = ranked.first() else {
        return Err(confidence::without_candidate(found));
    };
    let center = Position::new(found.fit.spheroid.center);
    let candidate = &best.candidate;
    answer.confidence = Some(best.nearest);
    let foot = Position::new(candidate.foot);
    answer.branch = Some(FittedBranch::new(
        foot,
        Direction::from_unit(candidate.tangent),
        candidate.support.pixels,
        candidate.rms,
    ));
    if best.nearest < config.least_confidence {
        return Err(wood::refusal(found, ranked));
    }
    let pick = PickDirection::new(&center, foot).ok_or(Status::NoBranch)?;
    answer.pick = Some(PickDirection {
        sd_rad: Some(direction_sd(found, candidate)),
        ..pick
    });
    Ok(())
}

/// Standard deviation of the direction to a candidate's foot, radians.
fn direction_sd(found: &SeenApple, candidate: &Candidate) -> f64 {
    let center = CENTER_EXCESS * (found.fit.covariance.trace() / 3.0).sqrt();
    let foot = FOOT_EXCESS * candidate.foot_sd;
    center.hypot(foot) / candidate.distance.max(1e-3)
}

fn wood_candidate(c: &WoodCandidate) -> BranchCandidate {
    BranchCandidate {
        wood: Some(c.wood),
        contrast: Some(c.contrast),
        ..branch_candidate(&c.candidate)
    }
}

fn fitted_apple(found: &SeenApple, inliers: usize) -> FittedApple {
    let fit = &found.fit;
    let center = Position::new(fit.spheroid.center);
    let center_covariance =
        fit.covariance * CENTER_EXCESS.powi(2) + Matrix3::identity() * CENTER_UNSEEN_SD_M.powi(2);
    FittedApple {
        center_covariance: Some(PositionCovariance::new(center_covariance)),
        radius_sd_m: Some(fit.radius_sd),
        visible_share: Some(found.visible_share),
        agreement: Some(found.agreement),
        ..FittedApple::new(center, fit.spheroid.radius, inliers, fit.rms)
    }
}

fn branch_candidate(c: &Candidate) -> BranchCandidate {
    let (foot, tangent) = (Position::new(c.foot), Direction::from_unit(c.tangent));
    BranchCandidate {
        shown_m: c.support.visible,
        shown_lesser_side_m: c.support.visible_shorter_side,
        odd_m: c.support.atypical,
        empty_m: c.support.empty,
        hidden_m: c.support.occluded,
        ..BranchCandidate::new(foot, tangent, c.axis.radius, c.distance, c.score)
    }
}
