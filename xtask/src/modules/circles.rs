//! Circles among the arrows.

use super::arrows::Arrow;
use std::collections::VecDeque;

/// The shortest circle of each knot of modules that depend on one another, or all circles of two where it has such.
pub(crate) fn circles(arrows: &[Arrow]) -> Vec<Vec<&Arrow>> {
    let mut found: Vec<Vec<&Arrow>> = Vec::new();
    let mut seen: Vec<usize> = Vec::new();
    for arrow in on_circles(arrows) {
        let Some(back) = way(arrows, arrow.to, arrow.from) else {
            continue;
        };
        let is_pair = back.len() == 1;
        let known = seen.contains(&arrow.from) && seen.contains(&arrow.to);
        let counted_from_the_other_end = is_pair && arrow.from > arrow.to;
        if counted_from_the_other_end || known && !is_pair {
            continue;
        }
        let circle: Vec<&Arrow> = std::iter::once(arrow).chain(back).collect();
        seen.extend(circle.iter().map(|arrow| arrow.from));
        found.push(circle);
    }
    found
}

/// The arrows whose target depends, by whatever way, on their source.
pub(crate) fn on_circles(arrows: &[Arrow]) -> Vec<&Arrow> {
    let back = |arrow: &&Arrow| way(arrows, arrow.to, arrow.from).is_some();
    arrows.iter().filter(back).collect()
}

/// The shortest way along the arrows, if there is one.
fn way(arrows: &[Arrow], start: usize, goal: usize) -> Option<Vec<&Arrow>> {
    let mut queue = VecDeque::from([(start, Vec::new())]);
    let mut visited = vec![start];
    while let Some((at, path)) = queue.pop_front() {
        if at == goal {
            return Some(path);
        }
        for arrow in arrows.iter().filter(|arrow| arrow.from == at) {
            if !visited.contains(&arrow.to) {
                visited.push(arrow.to);
                let mut longer = path.clone();
                longer.push(arrow);
                queue.push_back((arrow.to, longer));
            }
        }
    }
    None
}
