//! Radii and centres of frames whose apples are known.

use nalgebra::Isometry3;
use pomona::{CheckedFrame, Config, FrameAnswer, Method, PickError, Picker};
use pomona_cloud::Frame;
use pomona_evaluate::{Caliper, PickMethod, caliper_page, measure_calipers, read_calipers};
use pomona_scenes::Suite;
use pomona_transforms::Position;
use std::path::Path;

/// Sees the frame `second` from another place, its first apple wrongly.
struct Moved(Picker);

impl PickMethod for Moved {
    fn name(&self) -> &'static str {
        "moved"
    }

    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError> {
        let mut answer = self.0.answer(frame, seed)?;
        if answer.id == "second" {
            let motion = Isometry3::new([0.2, 0.0, 0.1].into(), [0.0, 0.3, 0.0].into());
            let apples = answer.apples.iter_mut().filter_map(|a| a.apple.as_mut());
            for (i, apple) in apples.enumerate() {
                let mut center = motion * apple.center.point();
                center.y += if i == 0 { 0.2 } else { 0.0 };
                apple.center = Position::new(center);
            }
        }
        Ok(answer)
    }
}

#[test]
fn two_sights_of_one_tree_are_aligned_and_radii_compared() {
    let scene = Suite::named("demo").unwrap().scenes().next().unwrap();
    let [mut first, mut second] = [scene.frame.clone(), scene.frame];
    (first.id, second.id) = ("first".to_owned(), "second".to_owned());
    // Another id draws other numbers, so that the two sights differ a little.
    let method = Moved(Picker::new(Config::default().with(|c| c.method = Method::Paper)).unwrap());
    let calipers: Vec<Caliper> = scene
        .truth
        .apples
        .iter()
        .map(|apple| Caliper::new(&apple.bounds.name, 2.0 * apple.radius))
        .collect();
    let report = measure_calipers(&[first, second], &calipers, &[&method], 0).unwrap();
    let result = &report.results[0];
    assert_eq!(result.apples.len(), 2 * calipers.len());
    let alignment = &result.alignments[0];
    assert!(alignment.shared >= 4, "{alignment:?}");
    assert_eq!(alignment.fitted, alignment.shared - 1, "{alignment:?}");
    assert!((alignment.rotation_angle.unwrap() - 0.3).abs() < 0.1);
    let page = caliper_page(&report).unwrap();
    assert!(page.contains("rigid motion") && page.contains("<svg"));
}

/// The two real frames, where they are at hand; they are not ours to ship.
#[test]
fn real_frames_within_the_target() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/frames");
    if !folder.is_dir() {
        eprintln!("skipped: no real frames beside the checkout");
        return;
    }
    let calipers = read_calipers(folder.join("calipers.csv")).unwrap();
    let frames =
        ["orchard-1218", "orchard-1235"].map(|name| Frame::read(folder.join(name)).unwrap());
    let picker = Picker::new(Config::default().with(|c| c.method = Method::Paper)).unwrap();
    let report = measure_calipers(&frames, &calipers, &[&picker], 0).unwrap();
    let result = &report.results[0];
    assert_eq!(result.apples.len(), 34, "17 apples in each of 2 frames");
    let error = result.radius_error_absolute.as_ref().unwrap();
    assert!(error.mean <= 0.008, "{error:?}");
}
