//! Settings that matter only where something stands between the start and the apple; the others are seen to matter on
//! frames, by the tests of `pomona`.

use crate::world::{Simple, config};
use nalgebra::Point3;
use pomona_approach::{ApproachConfig, Planner};
use pomona_settings::readers::{Situation, unread};

/// A simple scene with a wall across the way, from `low` upwards, `x` before the base.
fn behind_a_wall(x: f64, low: f64) -> impl Fn(&ApproachConfig) -> String {
    let mut simple = Simple::new();
    let grid = (0..60).flat_map(|i| (0..40).map(move |j| (f64::from(i), f64::from(j))));
    let points = grid.map(|(i, j)| Point3::new(x, 0.01 * i - 0.3, low + 0.01 * j));
    simple.cloud.extend(points);
    move |config| {
        let planner = Planner::new(config.clone()).unwrap();
        let approach = planner.plan(&simple.scene(config), &simple.target, &simple.start);
        format!("{approach:?}")
    }
}

#[test]
fn settings_of_the_way_there_have_a_reader() {
    // One that is passed beneath by a detour alone, for some of these edges; and one in the way of both.
    let mut situations: Vec<_> = (28..40)
        .map(|low| Situation::new(config(), behind_a_wall(0.65, 0.01 * f64::from(low))))
        .collect();
    situations.push(Situation::new(config(), behind_a_wall(0.5, 0.1)));
    let asked = ["clearance.region_m", "search.detour_m"];
    let unread = unread(&situations, &[], |path| asked.contains(&path));
    assert!(unread.is_empty(), "{unread:?} change nothing");
}
