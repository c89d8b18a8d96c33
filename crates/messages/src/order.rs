//! The picking order.

use pomona::RobotPlan;
use pomona_approach::Approach;

/// The ids and approaches of the picks that have one, in the picking order.
pub fn ranked(plan: &RobotPlan) -> impl Iterator<Item = (usize, &Approach)> {
    plan.order.ranks.iter().filter_map(|rank| {
        let approach = plan.order.approaches.get(rank.target)?.as_ref().ok()?;
        Some((*plan.targets.get(rank.target)?, approach))
    })
}
