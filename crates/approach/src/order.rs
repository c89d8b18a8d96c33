use crate::{Approach, ObstacleMap, Planner, Refusal, StartPose, Target};

/// Why a target has its rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// Its approach is free with every apple in place. Among these the one with the higher confidence goes first, then
    /// the one with the larger clearance.
    Unobstructed,
    /// Its approach is free once the apples before it are gone.
    AfterBlockers,
    /// It is part of a cycle of apples that block one another: of such a cycle, the one that violates its margins least
    /// goes first. Its approach is *not* free; its clearance says by how much.
    CycleBroken,
}

impl Reason {
    /// Its name in `picks.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Unobstructed => "unobstructed",
            Self::AfterBlockers => "after_blockers",
            Self::CycleBroken => "cycle_broken",
        }
    }
}

/// The place of one target in the order.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Rank {
    /// Index of the target among those given.
    pub target: usize,
    /// Why it has this rank.
    pub reason: Reason,
    /// Indices of the targets that block it, in ascending order.
    pub blockers: Vec<usize>,
}

/// The picking order of a frame's targets, and the approach to each.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Order {
    /// The targets that can be picked, in picking order.
    pub ranks: Vec<Rank>,
    /// How each target is approached, or why it is not; in the targets' order.
    ///
    /// That of a blocked target holds once its blockers are gone.
    pub approaches: Vec<Result<Approach, Refusal>>,
}

/// The picking order: reachable, unobstructed and confident targets first; blockers before what they block.
///
/// Each target is planned with everything in place. One that collides is planned again without the
/// other targets that can be picked themselves; where that succeeds, those that its approach touches are
/// its blockers. A target is ranked when all its blockers are; of those ready, the unobstructed one,
/// then the one with the higher confidence, then the larger slack, then the lower index goes first.
/// Where none is ready, blockers form cycles, and the target with the greatest slack from its
/// blockers goes next as [`Reason::CycleBroken`].
pub fn pick_order(
    planner: &Planner,
    scene: &ObstacleMap,
    targets: &[Target],
    start: &StartPose,
) -> Order {
    let mut approaches: Vec<_> = targets
        .iter()
        .map(|target| planner.plan(scene, target, start))
        .collect();
    let blocked: Vec<usize> = (0..targets.len())
        .filter(|&i| matches!(approaches[i], Err(Refusal::Collision(_))))
        .collect();
    plan_without_blockers(planner, scene, targets, start, &blocked, &mut approaches);
    let blockers = blockers(planner, scene, &blocked, &approaches);
    let ranks = rank(planner, scene, targets, &mut approaches, &blockers);
    Order { ranks, approaches }
}

/// Plans the blocked targets without the others that can be picked, until nothing changes: a target that stays refused
/// remains an obstacle to the others.
fn plan_without_blockers(
    planner: &Planner,
    scene: &ObstacleMap,
    targets: &[Target],
    start: &StartPose,
    blocked: &[usize],
    approaches: &mut [Result<Approach, Refusal>],
) {
    let refusals: Vec<_> = approaches.to_vec();
    let mut hopeful = blocked.to_vec();
    loop {
        let mut gone = vec![false; scene.apples().len()];
        for (i, target) in targets.iter().enumerate() {
            let pickable = refusals[i].is_ok() || hopeful.contains(&i);
            if let Some(gone) = gone.get_mut(target.apple) {
                *gone = pickable;
            }
        }
        for &i in &hopeful {
            approaches[i] = planner.plan_without(scene, &targets[i], start, &gone);
        }
        let before = hopeful.len();
        hopeful.retain(|&i| approaches[i].is_ok());
        if hopeful.len() == before {
            break;
        }
    }
    for &i in blocked {
        if approaches[i].is_err() {
            // What is in its way as the frame is says more than what is left without neighbours.
            approaches[i].clone_from(&refusals[i]);
        }
    }
}

/// For each target, the indices of those that its approach touches.
fn blockers(
    planner: &Planner,
    scene: &ObstacleMap,
    blocked: &[usize],
    approaches: &[Result<Approach, Refusal>],
) -> Vec<Vec<usize>> {
    let mut blockers = vec![Vec::new(); approaches.len()];
    for &i in blocked {
        let Ok(approach) = &approaches[i] else {
            continue;
        };
        for (j, other) in approaches.iter().enumerate() {
            if let Ok(other) = other
                && j != i
                && planner.touches(scene, approach, other.apple).is_some()
            {
                blockers[i].push(j);
            }
        }
    }
    blockers
}

fn rank(
    planner: &Planner,
    scene: &ObstacleMap,
    targets: &[Target],
    approaches: &mut [Result<Approach, Refusal>],
    blockers: &[Vec<usize>],
) -> Vec<Rank> {
    let mut waiting: Vec<usize> = (0..targets.len())
        .filter(|&i| approaches[i].is_ok())
        .collect();
    let mut ranks = Vec::with_capacity(waiting.len());
    while !waiting.is_empty() {
        let ready = |&&i: &&usize| blockers[i].iter().all(|j| !waiting.contains(j));
        let slack = |i: usize| {
            approaches[i]
                .as_ref()
                .map_or(f64::NEG_INFINITY, |a| a.clearance.slack_m())
        };
        let sooner = |a: &&usize, b: &&usize| {
            let (a, b) = (**a, **b);
            let by_blockers = blockers[a]
                .is_empty()
                .cmp(&blockers[b].is_empty())
                .reverse();
            by_blockers
                .then(targets[b].confidence.total_cmp(&targets[a].confidence))
                .then(slack(b).total_cmp(&slack(a)))
                .then(a.cmp(&b))
        };
        let next = waiting.iter().filter(ready).min_by(sooner).copied();
        let (next, reason) = match next {
            Some(next) if blockers[next].is_empty() => (next, Reason::Unobstructed),
            Some(next) => (next, Reason::AfterBlockers),
            None => {
                let Some(next) = least_blocked(planner, scene, approaches, blockers, &waiting)
                else {
                    break;
                };
                (next, Reason::CycleBroken)
            }
        };
        waiting.retain(|&i| i != next);
        ranks.push(Rank {
            target: next,
            reason,
            blockers: blockers[next].clone(),
        });
    }
    ranks
}

/// Of the targets waiting for each other, the one with the greatest slack from its waiting blockers;
/// that slack becomes its clearance.
fn least_blocked(
    planner: &Planner,
    scene: &ObstacleMap,
    approaches: &mut [Result<Approach, Refusal>],
    blockers: &[Vec<usize>],
    waiting: &[usize],
) -> Option<usize> {
    let mut best = None;
    for &i in waiting {
        let approach = approaches[i].as_ref().ok()?;
        let worst = blockers[i]
            .iter()
            .filter(|j| waiting.contains(j))
            .filter_map(|&j| planner.touches(scene, approach, approaches[j].as_ref().ok()?.apple))
            .min_by(|a, b| a.slack_m().total_cmp(&b.slack_m()));
        if let Some(worst) = worst
            && best.is_none_or(|(_, b): (usize, crate::Clearance)| worst.slack_m() > b.slack_m())
        {
            best = Some((i, worst));
        }
    }
    let (i, clearance) = best?;
    if let Ok(approach) = &mut approaches[i] {
        approach.clearance = clearance;
    }
    Some(i)
}
