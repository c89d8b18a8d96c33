use super::rigid::align;
use nalgebra::{Isometry3, Point3};
use pomona::FrameAnswer;
use pomona_statistics::Summary;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Two centres further apart than this after the alignment are not of one apple, or one is wrong; metres.
const SAME_CENTER_M: f64 = 0.03;

/// Fewest shared apples that an alignment can be judged by: three fix it, the fourth tests it.
const LEAST_SHARED: usize = 4;

/// Triples that are tried at most.
const MOST_TRIPLES: usize = 20_000;

/// How well the centres of two frames of one tree agree after the best rigid motion between them.
///
/// Apples are joined by the names of their boxes. It is a measure of consistency, not of accuracy: an error that
/// both frames share does not show.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Alignment {
    /// One frame.
    pub first: String,
    /// The other.
    pub second: String,
    /// Apples that both frames name and that have a centre in both.
    pub shared: usize,
    /// Those of them that the motion fits.
    pub fitted: usize,
    /// Distance of the centres after the motion, over the fitted apples; absent where fewer than four
    /// apples are shared, or where they lie on a line.
    pub distance: Option<Summary>,
    /// Angle of the motion, radians.
    pub rotation_angle: Option<f64>,
    /// Way of the first camera's origin, metres.
    pub translation: Option<[f64; 3]>,
    /// Each shared apple.
    pub apples: Vec<AlignedApple>,
}

/// One apple of two frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct AlignedApple {
    /// Name of its box.
    pub box_name: String,
    /// Distance of its two centres after the motion.
    pub distance: f64,
    /// Whether the motion was fitted to it.
    pub fitted: bool,
}

/// The apples that have a centre in two frames, by the names of their boxes.
pub(crate) struct SharedCenters<'a> {
    names: Vec<&'a str>,
    from: Vec<Point3<f64>>,
    to: Vec<Point3<f64>>,
}

impl<'a> SharedCenters<'a> {
    /// Of a frame and another.
    pub(crate) fn of(first: &'a FrameAnswer, second: &'a FrameAnswer) -> Self {
        let (a, b) = (centers(first), centers(second));
        let names: Vec<&str> = a
            .keys()
            .filter(|name| b.contains_key(*name))
            .copied()
            .collect();
        Self {
            from: names.iter().map(|name| a[name]).collect(),
            to: names.iter().map(|name| b[name]).collect(),
            names,
        }
    }

    /// Their number.
    pub(crate) fn len(&self) -> usize {
        self.names.len()
    }

    /// The motion from the first frame to the second that most of them agree to; `None` where there are too few.
    pub(crate) fn motion(&self) -> Option<Isometry3<f64>> {
        robust(&self.from, &self.to)
    }

    /// The distance of each one's two centres after the motion, and whether it is that of one apple.
    fn distances(&self, motion: &Isometry3<f64>) -> impl Iterator<Item = (f64, bool)> {
        let pairs = self.from.iter().zip(&self.to);
        pairs.map(move |(p, q)| {
            let distance = (motion * p - q).norm();
            (distance, distance <= SAME_CENTER_M)
        })
    }

    /// The number of those that the motion fits.
    pub(crate) fn fitted(&self, motion: &Isometry3<f64>) -> usize {
        self.distances(motion).filter(|(_, fits)| *fits).count()
    }
}

impl Alignment {
    pub(super) fn of(first: &FrameAnswer, second: &FrameAnswer) -> Self {
        let shared = SharedCenters::of(first, second);
        let mut alignment = Self {
            first: first.id.clone(),
            second: second.id.clone(),
            shared: shared.len(),
            fitted: 0,
            distance: None,
            rotation_angle: None,
            translation: None,
            apples: Vec::new(),
        };
        let Some(motion) = shared.motion() else {
            return alignment;
        };
        for (name, (distance, fitted)) in shared.names.iter().zip(shared.distances(&motion)) {
            alignment.apples.push(AlignedApple {
                box_name: (*name).to_owned(),
                distance,
                fitted,
            });
        }
        let fitted: Vec<(usize, f64)> = alignment
            .apples
            .iter()
            .enumerate()
            .filter_map(|(i, apple)| apple.fitted.then_some((i, apple.distance)))
            .collect();
        alignment.fitted = fitted.len();
        alignment.distance = Summary::of(&fitted);
        alignment.rotation_angle = Some(motion.rotation.angle());
        alignment.translation = Some(motion.translation.vector.into());
        alignment
    }
}

/// The centres by box name; a name that a frame bears twice says nothing.
fn centers(answer: &FrameAnswer) -> BTreeMap<&str, Point3<f64>> {
    let mut centers = BTreeMap::new();
    let mut twice = Vec::new();
    for answer in &answer.apples {
        let name = answer.bounds.name.as_str();
        if let Some(apple) = &answer.apple
            && centers.insert(name, apple.center.point()).is_some()
        {
            twice.push(name);
        }
    }
    centers.retain(|name, _| !twice.contains(name));
    centers
}

/// The motion that most pairs agree to: every triple is tried (an even choice of them where there are
/// very many), the best one is fitted to the pairs it agrees with until they stay the same.
fn robust(from: &[Point3<f64>], to: &[Point3<f64>]) -> Option<Isometry3<f64>> {
    let n = from.len();
    if n < LEAST_SHARED {
        return None;
    }
    let stride = (n * (n - 1) * (n - 2) / 6).div_ceil(MOST_TRIPLES).max(1);
    let triples = (0..n)
        .flat_map(|i| (i + 1..n).flat_map(move |j| (j + 1..n).map(move |k| [i, j, k])))
        .step_by(stride);
    // What is beyond the bound costs the same however far.
    let cost = |motion: &Isometry3<f64>| -> f64 {
        let pairs = from.iter().zip(to);
        pairs
            .map(|(p, q)| (motion * p - q).norm_squared().min(SAME_CENTER_M.powi(2)))
            .sum()
    };
    let mut motion = triples
        .filter_map(|triple| align(&triple.map(|i| from[i]), &triple.map(|i| to[i])))
        .map(|motion| (cost(&motion), motion))
        .min_by(|a, b| a.0.total_cmp(&b.0))?
        .1;
    let mut inliers = Vec::new();
    for _ in 0..20 {
        let agree: Vec<usize> = (0..n)
            .filter(|&i| (motion * from[i] - to[i]).norm() <= SAME_CENTER_M)
            .collect();
        if agree == inliers {
            break;
        }
        let of = |points: &[Point3<f64>]| agree.iter().map(|&i| points[i]).collect::<Vec<_>>();
        match align(&of(from), &of(to)) {
            Some(better) => motion = better,
            None => break,
        }
        inliers = agree;
    }
    Some(motion)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn wrong_pairs_do_not_move_the_answer() {
        let from: Vec<_> = (0..12)
            .map(|i| {
                let t = f64::from(i);
                Point3::new(
                    (t * 1.3).sin(),
                    (t * 0.7).cos(),
                    1.0 + 0.1 * (t * 2.1).sin(),
                )
            })
            .collect();
        let motion = Isometry3::new(Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.1, 0.4, -0.2));
        let mut to: Vec<_> = from.iter().map(|p| motion * p).collect();
        for i in [1, 4, 7, 10] {
            to[i] += Vector3::new(0.2, 0.1 * i as f64, -0.3);
        }
        let found = robust(&from, &to).unwrap();
        assert!((found.translation.vector - motion.translation.vector).norm() < 1e-9);
        assert!(found.rotation.angle_to(&motion.rotation) < 1e-9);
    }

    #[test]
    fn three_shared_apples_prove_nothing() {
        let from = [
            Point3::origin(),
            Point3::new(1.0, 0.0, 0.0),
            Point3::new(0.0, 1.0, 0.0),
        ];
        assert!(robust(&from, &from).is_none());
    }
}
