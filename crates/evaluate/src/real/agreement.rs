use super::record::{FrameAgreement, PerturbedAgreement, RealAgreement};
use crate::calipers::SharedCenters;
use nalgebra::Vector3;
use pomona::{AppleAnswer, FrameAnswer};
use pomona_statistics::Proportion;

/// Two directions within this angle are the same to a gripper: the angle of a correct answer on scenes.
const SAME_DEG: f64 = 20.0;

/// Beyond this angle they are of two branches, or at random.
const OTHER_DEG: f64 = 50.0;

/// What became of one apple twice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pair {
    /// How often it was answered: 0, 1 or 2 times.
    pub(super) answers: usize,
    /// The angle of the two directions, radians.
    pub(super) angle: Option<f64>,
}

impl Pair {
    /// Two answers, the second one's direction turned by `turn` into the frame of the first.
    fn of(
        first: &AppleAnswer,
        second: &AppleAnswer,
        turn: impl Fn(Vector3<f64>) -> Vector3<f64>,
    ) -> Self {
        let direction = |answer: &AppleAnswer| answer.pick.map(|pick| pick.direction.vector());
        let (a, b) = (direction(first), direction(second).map(turn));
        Self {
            answers: [a, b].iter().flatten().count(),
            angle: a.zip(b).map(|(a, b)| a.angle(&b)),
        }
    }
}

/// A frame answered twice, box by box.
pub(super) fn repeated(first: &FrameAnswer, second: &FrameAnswer) -> Vec<Pair> {
    let pairs = first.apples.iter().zip(&second.apples);
    pairs
        .map(|(a, b)| Pair::of(a, b, |direction| direction))
        .collect()
}

/// Two frames of one tree: the pairs of answers to the same apple, as boxes' names say, and what is known of the
/// frames. No pairs where the frames cannot be aligned, as those of two trees cannot.
pub(super) fn between(first: &FrameAnswer, second: &FrameAnswer) -> (FrameAgreement, Vec<Pair>) {
    let shared = SharedCenters::of(first, second);
    let motion = shared.motion();
    let fitted = motion.as_ref().map_or(0, |motion| shared.fitted(motion));
    let is_one_tree = 2 * fitted >= shared.len();
    let pairs: Vec<Pair> = match motion.filter(|_| is_one_tree) {
        Some(motion) => named_pairs(first, second)
            .map(|(a, b)| Pair::of(a, b, |direction| motion.rotation.inverse() * direction))
            .collect(),
        None => Vec::new(),
    };
    let agreement = FrameAgreement {
        first: first.id.clone(),
        second: second.id.clone(),
        centers: shared.len(),
        aligned: fitted,
        rotation_angle: motion.map(|motion| motion.rotation.angle()),
        directions: RealAgreement::of(&pairs),
    };
    (agreement, pairs)
}

/// The answers of boxes of the same name; a name that a frame has twice names no apple.
fn named_pairs<'a>(
    first: &'a FrameAnswer,
    second: &'a FrameAnswer,
) -> impl Iterator<Item = (&'a AppleAnswer, &'a AppleAnswer)> {
    let once = |answer: &'a FrameAnswer, name: &str| {
        let mut own = answer.apples.iter().filter(|a| a.bounds.name == name);
        own.next().filter(|_| own.next().is_none())
    };
    first.apples.iter().filter_map(move |apple| {
        let name = &apple.bounds.name;
        Some((once(first, name)?, once(second, name)?))
    })
}

impl RealAgreement {
    /// `None` where there is no pair.
    pub(super) fn of(pairs: &[Pair]) -> Option<Self> {
        if pairs.is_empty() {
            return None;
        }
        let angles: Vec<f64> = pairs.iter().filter_map(|pair| pair.angle).collect();
        let share = |is: &dyn Fn(f64) -> bool| {
            Proportion::new(
                angles.iter().filter(|angle| is(**angle)).count(),
                angles.len(),
            )
        };
        Some(Self {
            answered_in_both: Proportion::new(angles.len(), pairs.len()),
            within_20_deg: share(&|angle| angle <= SAME_DEG.to_radians()),
            beyond_50_deg: share(&|angle| angle > OTHER_DEG.to_radians()),
        })
    }
}

impl PerturbedAgreement {
    /// `None` where there is no copy.
    pub(super) fn of(pairs: &[Pair], copies: usize) -> Option<Self> {
        let flipped = pairs.iter().filter(|pair| pair.answers == 1).count();
        Some(Self {
            copies,
            flipped: Proportion::new(flipped, pairs.len()),
            directions: RealAgreement::of(pairs)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_of_pairs_and_of_pairs_answered_twice() {
        let twice = |degrees: f64| Pair {
            answers: 2,
            angle: Some(degrees.to_radians()),
        };
        let pairs = [
            twice(0.0),
            twice(19.9),
            twice(21.0),
            twice(50.1),
            Pair {
                answers: 1,
                angle: None,
            },
            Pair::default(),
        ];
        let counts = |p: &Proportion| (p.count, p.of);
        let perturbed = PerturbedAgreement::of(&pairs, 3).unwrap();
        assert_eq!(counts(&perturbed.flipped), (1, 6));
        let directions = perturbed.directions;
        assert_eq!(counts(&directions.answered_in_both), (4, 6));
        assert_eq!(counts(&directions.within_20_deg), (2, 4));
        assert_eq!(counts(&directions.beyond_50_deg), (1, 4));
        assert_eq!(RealAgreement::of(&[]), None);
    }
}
