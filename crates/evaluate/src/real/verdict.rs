use super::frame::RealFrame;
use super::record::Verdict;
use super::wood_near::{Place, WoodNear, middle_px, radius_px, wood_near};
use pomona::AppleAnswer;

/// Largest angle in the image between the direction of an answer and that to the wood of an answer that points at it.
/// The nearest point of a stroke moves by some degrees with the 1 to 2 pixels by which strokes and centres are off, and
/// a line that misses a branch of its own distance by this much is 0.4 of that distance beside it.
const LARGEST_ANGLE_DEG: f64 = 25.0;

/// Nearer to the centre than this, foot or wood have no direction in the image; radii of the apple.
const NO_DIRECTION_RADII: f64 = 0.3;

/// Distance from the wood within which the foot of an answer without a direction in the image is on it; radii.
const ON_WOOD_RADII: f64 = 0.5;

/// How an answer lies to the wood nearest to it, in the image.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sight<'a> {
    /// Where the method sees the apple's centre.
    pub(super) center_px: Option<[f64; 2]>,
    /// Where it sees the foot.
    pub(super) foot_px: Option<[f64; 2]>,
    /// The wood nearest to the centre.
    pub(super) wood: Option<WoodNear<'a>>,
    /// Angle between the directions to foot and wood, the smallest over the wood that is as near; radians.
    pub(super) angle: Option<f64>,
    /// Distance of the foot from the nearest point of that wood, pixels.
    pub(super) foot_from_wood_px: Option<f64>,
    /// Distance of the foot from that wood anywhere along it, pixels.
    pub(super) foot_off_wood_px: Option<f64>,
    /// Whether the answer points at wood.
    pub(super) right: Option<bool>,
}

impl<'a> Sight<'a> {
    pub(super) fn of(frame: &'a RealFrame, answer: &AppleAnswer) -> Self {
        let camera = &frame.frame.camera;
        let pixel = |point| camera.project(&point).map(|(u, v)| [u + 0.5, v + 0.5]);
        let Some(center) = answer.apple.map(|apple| apple.center.point()) else {
            return Self::default();
        };
        let Some(center_px) = pixel(center) else {
            return Self::default();
        };
        let radius_px = radius_px(&answer.bounds);
        let focal_px = f64::midpoint(camera.fx, camera.fy);
        let place = Place {
            center_px,
            box_px: middle_px(&answer.bounds),
            depth_m: center.z,
            radius_px,
            radius_m: radius_px * center.z / focal_px,
        };
        let mut sight = Self {
            center_px: Some(center_px),
            foot_px: answer.pick.and_then(|pick| pixel(pick.foot.point())),
            wood: wood_near(frame, &place),
            ..Self::default()
        };
        if let (Some(foot), Some(wood)) = (sight.foot_px, &sight.wood) {
            let to_foot = minus(foot, center_px);
            let smallest = |of: &dyn Fn([f64; 2]) -> f64| {
                let values = wood.feet.iter().map(|&wood| of(wood));
                values.min_by(f64::total_cmp)
            };
            sight.angle = smallest(&|wood| angle(to_foot, minus(wood, center_px)));
            sight.foot_from_wood_px = smallest(&|wood| length(minus(foot, wood)));
            sight.foot_off_wood_px = wood.distance_from(foot);
            sight.right = Some(
                wood.feet
                    .iter()
                    .any(|&wood| points_at(to_foot, minus(wood, center_px), radius_px)),
            );
        }
        sight
    }

    /// The verdict on an answer whose apple's wood is seen or not.
    pub(super) fn verdict(&self, answer: &AppleAnswer, wood_is_seen: bool) -> Verdict {
        match (answer.is_picked(), wood_is_seen, self.right) {
            (false, _, _) => Verdict::Refused,
            (true, false, _) => Verdict::Answered,
            (true, true, Some(true)) => Verdict::Right,
            (true, true, _) => Verdict::Elsewhere,
        }
    }
}

/// Whether a foot points at wood, both as seen from the centre, pixels.
fn points_at(foot: [f64; 2], wood: [f64; 2], radius_px: f64) -> bool {
    if length(foot).min(length(wood)) <= NO_DIRECTION_RADII * radius_px {
        return length(minus(foot, wood)) <= ON_WOOD_RADII * radius_px;
    }
    angle(foot, wood) <= LARGEST_ANGLE_DEG.to_radians()
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn length([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// The angle between two vectors, 0 to π.
fn angle(a: [f64; 2], b: [f64; 2]) -> f64 {
    let cross = a[0] * b[1] - a[1] * b[0];
    let dot = a[0] * b[0] + a[1] * b[1];
    cross.abs().atan2(dot)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_points_at_wood_within_25_degrees() {
        for (degrees, right) in [
            (0.0, true),
            (24.0_f64, true),
            (-24.0, true),
            (26.0, false),
            (180.0, false),
        ] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            assert_eq!(
                points_at([80.0 * cos, 80.0 * sin], [40.0, 0.0], 30.0),
                right,
                "{degrees}"
            );
        }
    }

    #[test]
    fn near_the_centre_the_distance_decides() {
        // Wood and foot within half a radius of each other, on two sides of the centre.
        assert!(points_at([-3.0, 0.0], [10.0, 0.0], 30.0));
        assert!(!points_at([-3.0, 0.0], [20.0, 0.0], 30.0));
        // The wood passes in front of the centre; an answer far beside it is elsewhere, whatever the angle.
        assert!(!points_at([40.0, 0.0], [8.0, 0.0], 30.0));
    }
}
