//! Layouts are drawn until one shows what its scene is about.

use crate::orchard::{Layout, Orchard};
use crate::raycast::{Raycast, raycast};
use crate::rivals::Handicap;
use crate::visibility::look_at;
use crate::world::World;
use pomona_cloud::Camera;

/// Layouts tried before one is taken whose target shows too little.
const ATTEMPTS: u64 = 40;

impl Orchard {
    /// The world of `seed` before `camera`.
    pub fn world(&self, camera: &Camera, seed: u64) -> World {
        self.layout(camera, seed).0
    }

    /// The world and what the rays meet in it.
    pub(crate) fn layout(&self, camera: &Camera, seed: u64) -> (World, Raycast) {
        let mut attempt = 0;
        loop {
            let rivals = self.rivals.1 > 0;
            let world = if rivals {
                Layout::of_rivals(*self, seed, attempt).world_with_rivals(seed)
            } else {
                Layout::new(*self, seed, attempt).world()
            };
            let cast = raycast(&world, camera);
            let seen = look_at(&world, camera, &cast, 0, 0.0, 1);
            let share = seen.and_then(|apple| apple.visible_share).unwrap_or(0.0);
            attempt += 1;
            let good = share >= self.least_visible
                && (!rivals || Handicap::of(seed).holds(&world, camera, &cast));
            if good || attempt == ATTEMPTS {
                return (world, cast);
            }
        }
    }
}
