//! From where another view of an apple would help.

use super::shell::{Shell, THING};
use nalgebra::{Unit, Vector3};
use pomona_geometry::Sphere;
use pomona_transforms::{CameraFrame, Direction};

/// By how much the view turns, radians.
const TURN_RAD: f64 = 1.0;

/// Half of the opening of the cone that is looked through, radians.
const CONE_RAD: f64 = 0.6;

/// Directions that are compared.
const DIRECTIONS: usize = 8;

/// One pixel in this many is counted, along rows.
const STRIDE: usize = 5;

/// Unit vector from the apple's centre towards where a camera would look past the fewest of the things that are seen
/// about it: one of eight directions a turn of 57 degrees away from the present one, as many to the sides as
/// up and down.
///
/// `None` for an apple at the camera.
pub(crate) fn least_occluded_direction(
    shell: &Shell,
    apple: &Sphere,
) -> Option<Direction<CameraFrame>> {
    let back = (-apple.center.coords).try_normalize(1e-9)?;
    let right = Vector3::y().cross(&back).try_normalize(1e-9)?;
    let down = back.cross(&right);
    let mut directions = [Vector3::zeros(); DIRECTIONS];
    for (k, direction) in directions.iter_mut().enumerate() {
        let (sin, cos) = (k as f64 * std::f64::consts::TAU / DIRECTIONS as f64).sin_cos();
        *direction = back * TURN_RAD.cos() + (right * cos + down * sin) * TURN_RAD.sin();
    }
    let mut things = [0usize; DIRECTIONS];
    let patch = &shell.patch;
    for i in (0..shell.seen.len()).step_by(STRIDE) {
        if shell.seen[i] != THING {
            continue;
        }
        let p = patch.point_at(i % patch.width, i / patch.width, patch.z[i]);
        let Some(direction_to) = (p - apple.center).try_normalize(1e-9) else {
            continue;
        };
        for (count, direction) in things.iter_mut().zip(&directions) {
            *count += usize::from(direction_to.dot(direction) > CONE_RAD.cos());
        }
    }
    let least = (0..DIRECTIONS).min_by_key(|&k| things[k])?;
    Some(Direction::from_unit(Unit::new_unchecked(directions[least])))
}
