//! The doubt that everything in a frame is too large or too small by one factor.

use crate::config::FruitConfig;
use crate::frame::CheckedFrame;
use pomona_cloud::PixelBox;
use pomona_files::{Warning, WarningCode};

/// Boxes that must agree before they say more about the frame than about themselves.
const LEAST_BOXES: usize = 3;
/// Share of the boxes that must agree; some hold leaves, or a neighbour's depth.
const AGREEING: f64 = 0.9;
/// By how much what a box holds must leave the window of radii: boxes are drawn with a margin, and hidden fruit shows in
/// part.
const OUTSIDE: f64 = 1.5;

/// Compares the radii that boxes and depth tell with those of fruit. A depth unit or a focal length that is wrong changes
/// all of them by the same factor.
pub(crate) fn doubt<'a>(
    frame: &CheckedFrame<'_>,
    boxes: impl Iterator<Item = &'a PixelBox>,
    fruit: &FruitConfig,
) -> Option<Warning> {
    let mut radii: Vec<f64> = boxes.filter_map(|b| radius_m(frame, b)).collect();
    if radii.len() < LEAST_BOXES {
        return None;
    }
    let needed = AGREEING * radii.len() as f64;
    let share = |of: &dyn Fn(f64) -> bool| radii.iter().filter(|r| of(**r)).count() as f64;
    let too_large = share(&|r| r > OUTSIDE * fruit.radius_max_m) >= needed;
    let too_small = share(&|r| r < fruit.radius_min_m / OUTSIDE) >= needed;
    if !too_large && !too_small {
        return None;
    }
    let median = middle(&mut radii)?;
    // A fruit in the middle of the window, in the sense of a factor.
    let typical = (fruit.radius_min_m * fruit.radius_max_m).sqrt();
    let (factor, size) = if too_large {
        (median / typical, "large")
    } else {
        (typical / median, "small")
    };
    let scale = frame.frame().camera.depth_scale;
    let fitting = scale * typical / median;
    let message = format!(
        "everything is about {factor:.1} times too {size}: what the boxes hold has a radius of {:.0} mm, and fruit {:.0} to \
         {:.0} mm; is depth_scale ({scale}) right? About {fitting:.1e} would fit; or correct the focal lengths, or the \
         window [fruit]",
        median * 1e3,
        fruit.radius_min_m * 1e3,
        fruit.radius_max_m * 1e3
    );
    Some(Warning::new(WarningCode::SizesImplausible, message))
}

/// Half of a box's shorter side at the depth of its middle, metres; `None` without depth there.
fn radius_m(frame: &CheckedFrame<'_>, bounds: &PixelBox) -> Option<f64> {
    let (depth, camera) = (&frame.frame().depth, &frame.frame().camera);
    let (width, height) = (bounds.x_max - bounds.x_min, bounds.y_max - bounds.y_min);
    let inner = PixelBox {
        x_min: bounds.x_min + width / 4.0,
        x_max: bounds.x_max - width / 4.0,
        y_min: bounds.y_min + height / 4.0,
        y_max: bounds.y_max - height / 4.0,
        ..bounds.clone()
    };
    let window = inner.window(depth.width, depth.height).ok()?;
    let mut readings: Vec<f64> = (window.y0..window.y1)
        .flat_map(|v| &depth.readings[v * depth.width..][window.x0..window.x1])
        .filter(|&&reading| reading != 0)
        .map(|&reading| f64::from(reading))
        .collect();
    let z = middle(&mut readings)? * camera.depth_scale;
    Some(0.5 * (width / camera.fx).min(height / camera.fy) * z)
}

/// The median, the upper of two.
fn middle(values: &mut [f64]) -> Option<f64> {
    let at = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_cloud::Frame;

    fn orchard() -> Frame {
        let folder = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fixtures/frames/orchard-demo"
        );
        Frame::read(folder).unwrap()
    }

    fn said(frame: &Frame) -> Option<Warning> {
        let checked = CheckedFrame::new(frame).unwrap();
        let boxes = frame.boxes.iter().flatten();
        doubt(&checked, boxes, &FruitConfig::default())
    }

    #[test]
    fn a_wrong_depth_unit_is_suspected_with_its_factor() {
        let frame = orchard();
        assert_eq!(said(&frame), None);
        for (factor, words) in [(5.0, "times too large"), (0.1, "times too small")] {
            let mut wrong = frame.clone();
            wrong.camera.depth_scale *= factor;
            let warning = said(&wrong).unwrap();
            assert_eq!(warning.code, WarningCode::SizesImplausible);
            assert!(warning.message.contains(words), "{}", warning.message);
            let number = warning.message.split("about ").nth(1).unwrap();
            let number: f64 = number.split(' ').next().unwrap().parse().unwrap();
            let expected = f64::max(factor, 1.0 / factor);
            assert!(
                (0.6..1.6).contains(&(number / expected)),
                "{}",
                warning.message
            );
        }
    }

    #[test]
    fn a_few_boxes_say_nothing_about_the_frame() {
        let mut frame = orchard();
        frame.camera.depth_scale *= 5.0;
        frame.boxes.as_mut().unwrap().truncate(2);
        assert_eq!(said(&frame), None);
    }
}
