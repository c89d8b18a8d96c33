//! The scenes of the fits.

use nalgebra::Point3;
use pomona::{AppleAnswer, CheckedFrame, Config, Picker};
use pomona_evaluate::Subject;
use pomona_scenes::{AppleTruth, Branch, Orchard, Shot};
use rayon::prelude::*;

/// Suites, first seed, and number of scenes: none of those that the suites are evaluated on. More of `rivals`, where
/// what is nearer and what is surer differ most often.
const SCENES: [(&str, u64, usize); 5] = [
    ("rivals", 200, 1500),
    ("orchard", 200, 1500),
    ("harsh", 200, 500),
    ("harsh-kinect", 200, 500),
    ("repeat474-dense", 1000, 400),
];

/// An apple of a scene, and what the method makes of it.
pub(crate) struct Apple<'a> {
    /// Number of the scene among all.
    pub(crate) scene: usize,
    pub(crate) suite: &'static str,
    pub(crate) truth: &'a AppleTruth,
    pub(crate) answer: &'a AppleAnswer,
    /// Ways from its centre to the feet of the scene's branches, metres.
    pub(crate) feet: &'a [nalgebra::Vector3<f64>],
}

type Failure = Box<dyn std::error::Error>;

/// What `of_apple` takes from every apple.
pub(crate) fn observe<T: Send>(
    of_apple: &(dyn Fn(&Apple<'_>) -> Vec<T> + Sync),
) -> Result<Vec<T>, Failure> {
    let mut config = Config::default();
    // Below it an answer is refused: the fit needs those as well.
    config.robust.least_confidence = 0.0;
    let picker = Picker::new(config)?;
    let mut observations = Vec::new();
    let mut before = 0;
    for (suite, first, count) in SCENES {
        let subjects = Subject::named(&format!("{suite}@{first}"), Some(count))?;
        let scenes: Vec<_> = subjects
            .par_iter()
            .enumerate()
            .map(|(i, subject)| {
                let seed = first + i as u64;
                let of_scene = of_scene(&picker, subject, (suite, seed), before + i, of_apple);
                of_scene.map_err(|e| e.to_string())
            })
            .collect();
        before += subjects.len();
        for scene in scenes {
            observations.extend(scene?);
        }
    }
    Ok(observations)
}

fn of_scene<T>(
    picker: &Picker,
    subject: &Subject,
    (suite, seed): (&'static str, u64),
    scene: usize,
    of_apple: &(dyn Fn(&Apple<'_>) -> Vec<T> + Sync),
) -> Result<Vec<T>, Failure> {
    let made = subject.load()?;
    let frame = CheckedFrame::new(&made.frame)?;
    let answers = picker.pick(&frame, 0, None)?;
    let branches = branches(suite, seed);
    let mut observations = Vec::new();
    for answer in &answers.apples {
        let mut truths = made.truth.apples.iter();
        let Some(truth) = truths.find(|truth| truth.bounds.name == answer.bounds.name) else {
            continue;
        };
        let center = Point3::from(truth.center);
        let foot = |branch: &Branch| branch.curve.point(branch.curve.nearest(&center)) - center;
        let mut feet: Vec<_> = branches.iter().map(foot).collect();
        if let (true, Some(branch)) = (feet.is_empty(), &truth.branch) {
            feet.push(Point3::from(branch.point) - center);
        }
        observations.extend(of_apple(&Apple {
            scene,
            suite,
            truth,
            answer,
            feet: &feet,
        }));
    }
    Ok(observations)
}

/// The branches of a scene with several; the truth of its frame holds only the nearest of each apple.
fn branches(suite: &str, seed: u64) -> Vec<Branch> {
    let orchard = match suite {
        "rivals" => Orchard::with_rivals(),
        "orchard" | "harsh" | "harsh-kinect" => Orchard::default(),
        _ => return Vec::new(),
    };
    orchard
        .world(&Shot::paper_camera(), seed)
        .branches()
        .to_vec()
}
