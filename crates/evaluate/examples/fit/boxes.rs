//! Observations for the model of presence: boxes about apples and on nothing.

use crate::logistic::Observation;
use pomona::{CheckedFrame, Config, PRESENCE_FEATURES, Picker};
use pomona_cloud::{Frame, PixelBox};
use pomona_evaluate::{Subject, boxes_about, boxes_on_nothing};
use rayon::prelude::*;

/// Number of features.
const N: usize = PRESENCE_FEATURES.len();

/// Suites, first seed, and number of scenes: none of those that the suites are evaluated on, nor the check of boxes.
const SCENES: [(&str, u64, usize); 9] = [
    ("orchard", 200, 60),
    ("rivals", 800, 20),
    ("harsh", 300, 25),
    ("harsh-kinect", 300, 25),
    ("harsh-azure-kinect", 300, 25),
    ("harsh-d400", 300, 25),
    ("dense", 200, 60),
    ("row", 200, 4),
    ("repeat474-dense", 1000, 20),
];

/// Share of the boxes in which something round is fitted that are taken to hold an apple: box files name apples, and what
/// else is in them is the exception.
pub(crate) const APPLES_SHARE: f64 = 0.75;

/// Boxes on nothing in a scene, …
const EMPTY_BOXES: usize = 10;

/// … and more of them for each of its apples.
const EMPTY_BOXES_PER_APPLE: usize = 2;

/// The only feature that colour decides.
const REDNESS: &str = "redness of the surface";

/// The boxes of all scenes in which something was fitted, each as it is and as in a grey image, so that depth alone decides
/// where apples are green or colours are missing.
pub(crate) fn observe() -> Result<Vec<Observation<N>>, Box<dyn std::error::Error>> {
    let redness = PRESENCE_FEATURES.iter().position(|name| *name == REDNESS);
    let redness = redness.ok_or("no feature for colour")?;
    let picker = Picker::new(Config::default())?;
    let mut observations = Vec::new();
    let mut before = 0;
    for (suite, first, count) in SCENES {
        let subjects = Subject::named(&format!("{suite}@{first}"), Some(count))?;
        let scenes: Vec<_> = subjects
            .par_iter()
            .enumerate()
            .map(|(i, subject)| {
                let seed = first + i as u64;
                of_scene(&picker, subject, (suite, seed), before + i).map_err(|e| e.to_string())
            })
            .collect();
        before += subjects.len();
        for scene in scenes {
            observations.extend(scene?);
        }
    }
    let grey = |observation: &Observation<N>| {
        let mut features = observation.features;
        features[redness] = 0.0;
        Observation {
            features,
            ..*observation
        }
    };
    let both = observations.into_iter().flat_map(|o| [grey(&o), o]);
    Ok(both.collect())
}

fn of_scene(
    picker: &Picker,
    subject: &Subject,
    (suite, seed): (&'static str, u64),
    scene: usize,
) -> Result<Vec<Observation<N>>, Box<dyn std::error::Error>> {
    let made = subject.load()?;
    let (frame, apples) = (&made.frame, &made.truth.apples);
    let own = apples.iter().map(|apple| apple.bounds.clone()).collect();
    let count = EMPTY_BOXES + EMPTY_BOXES_PER_APPLE * apples.len();
    let mut observations = Vec::new();
    for (boxes, right) in [
        (own, true),
        (boxes_about(apples, frame, seed), true),
        (boxes_on_nothing(apples, frame, count, seed), false),
    ] {
        let features = of_boxes(picker, frame, boxes)?;
        observations.extend(features.into_iter().map(|features| Observation {
            scene,
            suite,
            features: features.into(),
            right,
        }));
    }
    Ok(observations)
}

/// The features of those boxes in which something was fitted.
fn of_boxes(
    picker: &Picker,
    frame: &Frame,
    boxes: Vec<PixelBox>,
) -> Result<Vec<[f64; N]>, Box<dyn std::error::Error>> {
    let mut frame = frame.clone();
    frame.boxes = Some(boxes);
    let answer = picker.pick(&CheckedFrame::new(&frame)?, 0, None)?;
    let apples = answer.apples.iter();
    Ok(apples
        .filter_map(|apple| apple.evidence.presence_features)
        .collect())
}
