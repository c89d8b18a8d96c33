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
use crate::optics::{DepthNoise, Projection};
use crate::outcome::Evidence;
use crate::{AppleRecord, BranchRecord, CandidateRecord, Pick, Status};
use apple::{AppleBuffers, AppleSearch, Found, MARGIN_PX};
use branch::{Candidate, Search};
use pomona_cloud::{Frame, PixelWindow};
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

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

/// Fills in what the method finds for one apple, and says how it ended.
pub(crate) fn pick_apple(
    frame: &Frame,
    settings: &Config,
    rng: &mut ChaCha8Rng,
    scratch: &mut Scratch,
    pick: &mut Pick,
    evidence: &mut Evidence,
) -> Status {
    let Some(projection) = Projection::new(&frame.camera) else {
        return Status::NoDepth;
    };
    let config = &settings.robust;
    let noise = DepthNoise::of(config);
    let start = Instant::now();
    let (width, height) = (frame.depth.width, frame.depth.height);
    let b = &pick.pixel_box;
    let window = PixelWindow::clamped(b.x_min, b.y_min, b.x_max, b.y_max, width, height);
    let around = window.grown(MARGIN_PX, width, height);
    scratch.apple.patch.fill(&frame.depth, &projection, around);
    pick.timing_ms.crop = milliseconds(start);

    let start = Instant::now();
    let search = AppleSearch {
        config,
        fruit: &settings.fruit,
        projection: &projection,
        noise,
        bounds: b,
        window,
    };
    let found = search.fit(rng, &mut scratch.apple);
    pick.timing_ms.sphere = milliseconds(start);
    let found = match found {
        Ok(found) => found,
        Err(status) => return status,
    };
    pick.apple = Some(apple_record(&found));

    let start = Instant::now();
    let body = found.fit.body;
    let apple = body.sphere();
    let reach = (config.branch_reach + SHELL_MARGIN) * apple.radius;
    let shell = &mut scratch.shell;
    shell.fill(&frame.depth, &projection, &body, reach, noise);
    evidence.surface = shell.pixels_of(APPLE);
    let search = Search {
        shell,
        projection: &projection,
        apple,
        sigma: noise.sigma(apple.center.z),
        config,
    };
    let ranked = search.candidates(&mut scratch.slices);
    pick.candidates = ranked.iter().map(candidate_record).collect();
    let status = answer(&found, &ranked, config, pick);
    if status == Status::Picked
        && let Some(best) = ranked.first()
    {
        search.pixels(best, &mut scratch.slices, &mut evidence.branch);
    }
    if status != Status::Picked {
        pick.view_from = view::clearest(shell, &apple).map(Into::into);
    }
    pick.timing_ms.branch = milliseconds(start);
    status
}

/// Fills in the branch and, where it is sure enough, the direction.
fn answer(found: &Found, ranked: &[Candidate], config: &RobustConfig, pick: &mut Pick) -> Status {
    let Some(best) = ranked.first() else {
        return confidence::without_candidate(found);
    };
    let apple = found.fit.body.sphere();
    let sd = (found.fit.covariance.trace() / 3.0)
        .sqrt()
        .hypot(best.foot_sd)
        / best.distance.max(1e-3);
    let confidence = confidence::confidence(found, ranked);
    pick.confidence = Some(confidence);
    pick.branch = Some(BranchRecord {
        point: best.foot.into(),
        direction: best.tangent.into(),
        inliers: best.tally.pixels,
        rms: best.rms,
    });
    if confidence < config.least_confidence {
        return confidence::refusal(found, ranked);
    }
    let Some(direction) = (best.foot - apple.center).try_normalize(1e-9) else {
        return Status::NoBranch;
    };
    pick.direction_sd = Some(sd);
    pick.foot = Some(best.foot.into());
    pick.direction = Some(direction.into());
    Status::Picked
}

fn apple_record(found: &Found) -> AppleRecord {
    let fit = &found.fit;
    AppleRecord {
        center: fit.body.center.into(),
        radius: fit.body.radius,
        inliers: fit.weight as usize,
        rms: fit.rms,
        center_covariance: Some(fit.covariance.into()),
        radius_sd: Some(fit.radius_sd),
        visible_share: Some(found.visible_share),
        agreement: Some(found.agreement),
    }
}

fn candidate_record(c: &Candidate) -> CandidateRecord {
    CandidateRecord {
        foot: c.foot.into(),
        tangent: c.tangent.into(),
        radius: c.axis.radius,
        distance: c.distance,
        score: c.score,
        shown: c.tally.shown,
        shown_lesser_side: c.tally.shown_lesser_side,
        odd: c.tally.odd,
        empty: c.tally.empty,
        hidden: c.tally.hidden,
    }
}
