//! Directions on frames whose wood is drawn: here synthetic ones, whose strokes are made from the ground truth.

use nalgebra::{Isometry3, Point3, Vector3};
use pomona::{
    AppleAnswer, CheckedFrame, Config, FrameAnswer, Method, PickDirection, PickError, Picker,
};
use pomona_cloud::Frame;
use pomona_evaluate::{
    AppleWoodTable, PickMethod, RealFrame, RealOptions, RealReport, Verdict, WoodSeen,
    measure_real, read_real_frames, real_csv, real_page,
};
use pomona_labels::{ImageStrokes, Stroke, StrokeClass, StrokePoint};
use pomona_scenes::{AppleTruth, Scene, Suite, Truth};
use pomona_transforms::Position;
use std::path::{Path, PathBuf};

/// Half of the length of branch that is drawn, metres.
const REACH_M: f64 = 0.08;

fn scene() -> Scene {
    Suite::named("demo").unwrap().scenes().next().unwrap()
}

/// The branch of an apple as a person would draw it.
fn stroke(frame: &Frame, apple: &AppleTruth) -> Option<Stroke> {
    let branch = apple.branch.as_ref()?;
    let (point, tangent) = (Point3::from(branch.point), Vector3::from(branch.direction));
    let camera = &frame.camera;
    let points = [-1.0, 0.0, 1.0].map(|share| {
        let (u, v) = camera
            .project(&(point + share * REACH_M * tangent))
            .unwrap();
        StrokePoint {
            x: u + 0.5,
            y: v + 0.5,
            half_width: branch.radius * camera.fx / point.z,
        }
    });
    Some(Stroke::new(StrokeClass::Wood, points.to_vec()))
}

fn drawn(scene: &Scene) -> RealFrame {
    let apples = scene.truth.apples.iter();
    let strokes = apples
        .filter_map(|apple| stroke(&scene.frame, apple))
        .collect();
    let name = scene.frame.id.clone();
    RealFrame::new(scene.frame.clone(), ImageStrokes::new(name, strokes))
}

/// Answers each box with the ground truth, the foot moved to the other side of the apple or not.
struct Known {
    truth: Truth,
    picker: Picker,
    mirrored: bool,
}

impl PickMethod for Known {
    fn name(&self) -> &'static str {
        if self.mirrored { "mirrored" } else { "known" }
    }

    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError> {
        let mut answer = self.picker.answer(frame, seed)?;
        for (answer, truth) in answer.apples.iter_mut().zip(&self.truth.apples) {
            self.replace(answer, truth);
        }
        Ok(answer)
    }
}

impl Known {
    fn replace(&self, answer: &mut AppleAnswer, truth: &AppleTruth) {
        let center = Point3::from(truth.center);
        let (Some(apple), Some(branch)) = (&mut answer.apple, &truth.branch) else {
            return;
        };
        apple.center = Position::new(center);
        let way = Point3::from(branch.point) - center;
        let foot = if self.mirrored {
            center - way
        } else {
            center + way
        };
        if answer.pick.is_some() {
            answer.pick = PickDirection::new(&apple.center, Position::new(foot));
        }
    }
}

fn measured(scene: &Scene, options: &RealOptions) -> RealReport {
    let picker = || Picker::new(Config::default().with(|c| c.method = Method::Robust)).unwrap();
    let method = |mirrored| Known {
        truth: scene.truth.clone(),
        picker: picker(),
        mirrored,
    };
    measure_real(
        &[drawn(scene)],
        &[&picker(), &method(false), &method(true)],
        options,
        &|| {},
    )
    .unwrap()
}

#[test]
fn true_directions_point_at_the_wood_and_opposite_ones_elsewhere() {
    let scene = scene();
    let report = measured(&scene, &RealOptions::default());
    let seen = |method: usize| &report.results[method].all.seen;
    assert!(seen(0).answered.of >= 3, "{:?}", report.frames);
    // The method itself is right on a scene as it is on real frames.
    assert!(seen(0).right.share >= 0.9, "{:?}", seen(0));
    assert_eq!(seen(1).right.share, 1.0, "{:?}", report.results[1].apples);
    assert!(
        seen(2).right.share <= 0.25,
        "{:?}",
        report.results[2].apples
    );
    assert_eq!(
        seen(2).elsewhere + seen(2).right.count,
        seen(2).answered.count
    );
    let text = real_csv(&report).unwrap();
    assert_eq!(text.lines().count(), 1 + 3 * scene.truth.apples.len());
    let page = real_page(&report, &[]);
    assert!(page.contains("mirrored") && page.contains("Brier"));
    let json = serde_json::to_string(&report).unwrap();
    assert_eq!(serde_json::from_str::<RealReport>(&json).unwrap(), report);
}

#[test]
fn a_table_says_whose_wood_is_seen() {
    let scene = scene();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("apples.csv");
    let [first, second] = [0, 1].map(|i| scene.truth.apples[i].bounds.name.clone());
    let id = &scene.frame.id;
    let text =
        format!("frame,box_name,wood\n{id},{first},doubtful\n{id},{second},seen\nother,9,seen\n");
    std::fs::write(&path, text).unwrap();
    let mut options = RealOptions::default();
    options.apples = Some(AppleWoodTable::read(&path).unwrap());
    let report = measured(&scene, &options);
    assert_eq!(report.apple_radii, None);
    let woods: Vec<WoodSeen> = report.results[0]
        .apples
        .iter()
        .map(|row| row.wood)
        .collect();
    assert_eq!(
        woods[..3],
        [WoodSeen::Doubtful, WoodSeen::Seen, WoodSeen::Unlisted]
    );
    assert_eq!(report.results[1].all.seen.answered.of, 1);
    assert_eq!(report.results[1].apples[0].verdict, Verdict::Answered);

    std::fs::write(&path, format!("frame,box_name,wood\n{id},nobody,seen\n")).unwrap();
    let refused = |table: AppleWoodTable| table.check(&[drawn(&scene)]).unwrap_err().to_string();
    let message = refused(AppleWoodTable::read(&path).unwrap());
    assert!(
        message.contains("apples.csv") && message.contains("0 boxes named nobody"),
        "{message}"
    );
    std::fs::write(&path, "frame,box_name,wood\nother,1,seen\n").unwrap();
    let message = refused(AppleWoodTable::read(&path).unwrap());
    assert!(message.contains("no line is about"), "{message}");
}

/// Sees the frame `second` from a camera that is turned and moved, and one apple of it from the other side.
struct Turned(Known);

impl PickMethod for Turned {
    fn name(&self) -> &'static str {
        "turned"
    }

    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError> {
        let mut answer = self.0.answer(frame, seed)?;
        if answer.id == "second" {
            let motion = Isometry3::new([0.2, 0.0, 0.1].into(), [0.0, 0.8, 0.0].into());
            let picked = answer.apples.iter_mut().filter(|apple| apple.is_picked());
            for (i, answer) in picked.enumerate() {
                let (Some(apple), Some(pick)) = (&mut answer.apple, answer.pick) else {
                    continue;
                };
                let center = apple.center.point();
                let way = pick.foot.point() - center;
                let foot = if i == 0 { center - way } else { center + way };
                apple.center = Position::new(motion * center);
                answer.pick = PickDirection::new(&apple.center, Position::new(motion * foot));
            }
        }
        Ok(answer)
    }
}

#[test]
fn directions_of_two_frames_are_compared_in_one_frame() {
    let scene = scene();
    let [mut first, mut second] = [drawn(&scene), drawn(&scene)];
    (first.frame.id, second.frame.id) = ("first".to_owned(), "second".to_owned());
    let method = Turned(Known {
        truth: scene.truth.clone(),
        picker: Picker::new(Config::default()).unwrap(),
        mirrored: false,
    });
    let mut options = RealOptions::default();
    options.repeats = 2;
    let report = measure_real(&[first, second], &[&method], &options, &|| {}).unwrap();
    let result = &report.results[0];
    assert_eq!(result.pairs.len(), 1);
    let agreement = result.between_frames.as_ref().unwrap();
    assert_eq!(result.pairs[0].directions.as_ref(), Some(agreement));
    let answered = agreement.answered_in_both.count;
    assert!(answered >= 3, "{agreement:?}");
    assert_eq!(agreement.within_20_deg.count, answered - 1, "{agreement:?}");
    assert_eq!(agreement.beyond_50_deg.count, 1);
    // The known answer does not follow what is done to the copies.
    let perturbed = result.all.perturbed.as_ref().unwrap();
    assert_eq!(perturbed.copies, 2);
    assert_eq!(perturbed.flipped.of, 2 * 2 * scene.truth.apples.len());
    assert_eq!(perturbed.directions.beyond_50_deg.count, 0, "{perturbed:?}");
    assert!(real_page(&report, &[]).contains("perturbed copies"));
}

/// Writes a frame.
fn written(folder: &Path, frame: &Frame) -> PathBuf {
    let path = folder.join(&frame.id);
    frame.write(&path).unwrap();
    path
}

#[test]
fn what_does_not_fit_is_refused_with_its_file_and_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let mut frame = scene().frame;
    let path = written(folder.path(), &frame);
    let read = |paths: &[PathBuf], strokes: Option<&Path>| {
        read_real_frames(paths, strokes).map_err(|e| e.to_string())
    };
    let message = read(std::slice::from_ref(&path), None).unwrap_err();
    assert!(
        message.contains("no wood.txt") && message.contains("--strokes"),
        "{message}"
    );

    let strokes = folder.path().join("strokes.txt");
    std::fs::write(&strokes, "image other\nwood 1,1,1 5,5,1\n").unwrap();
    let message = read(std::slice::from_ref(&path), Some(&strokes)).unwrap_err();
    assert!(
        message.contains("strokes.txt") && message.contains(&frame.id),
        "{message}"
    );

    // A file in the frame's folder serves without any option.
    std::fs::write(
        path.join("wood.txt"),
        format!("image {}\nwood 1,1,1 5,5,1\n", frame.id),
    )
    .unwrap();
    let frames = read(std::slice::from_ref(&path), None).unwrap();
    assert_eq!(frames[0].strokes.strokes.len(), 1);
    let message = read(&[path.clone(), path], None).unwrap_err();
    assert!(message.contains("stands twice"), "{message}");

    (frame.id, frame.boxes) = ("bare".to_owned(), None);
    let bare = written(folder.path(), &frame);
    let message = read(&[bare], None).unwrap_err();
    assert!(
        message.contains("bare") && message.contains("boxes.xml"),
        "{message}"
    );
}
