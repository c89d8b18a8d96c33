use super::frame::RealFrame;
use pomona_cloud::{DepthImage, PixelBox};
use pomona_labels::{Stroke, StrokePoint};
use pomona_statistics::median;

/// Strokes that are further than the nearest one by no more than this count equally as nearest; radii of the apple. The
/// strokes lie within 1 to 2 pixels of the middle of the wood, and the apples of the orchard frames have 25 to 40
/// pixels of radius.
const AS_NEAR_RADII: f64 = 0.15;

/// Wood further in front of the apple's centre or behind it than this is no wood of its own; radii of the apple.
const OWN_DEPTH_RADII: f64 = 4.0;

/// Least radius in pixels of the disc on a stroke in which depth is read: on a thinner stroke there is hardly a reading.
const LEAST_DISC_PX: f64 = 2.0;

/// Fewest readings in that disc that say how far a stroke is.
const LEAST_READINGS: usize = 5;

/// An apple as it is judged: where a method sees its centre, and how large its box is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// Its centre in the coordinates of strokes: pixels, (0.5, 0.5) the middle of the first pixel.
    pub(super) center_px: [f64; 2],
    /// The middle of its box, likewise.
    pub(super) box_px: [f64; 2],
    /// Depth of the centre, metres.
    pub(super) depth_m: f64,
    /// Radius of the box.
    pub(super) radius_px: f64,
    /// That radius at the centre's depth.
    pub(super) radius_m: f64,
}

/// The wood nearest to a place.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct WoodNear<'a> {
    /// The strokes that are as near as the nearest one, the nearest first.
    pub(super) strokes: Vec<&'a Stroke>,
    /// The nearest point of each.
    pub(super) feet: Vec<[f64; 2]>,
    /// Distance of the first, pixels.
    pub(super) distance_px: f64,
    /// Strokes nearer than it that depth shows far in front of the apple or behind it.
    pub(super) passed_over: usize,
}

impl WoodNear<'_> {
    /// Distance in pixels of a place from the edge of that wood anywhere along it; 0 on it.
    pub(super) fn distance_from(&self, place: [f64; 2]) -> Option<f64> {
        let from_edge = |stroke: &&Stroke| {
            let (distance, half_width) = stroke.nearest(place);
            (distance - half_width).max(0.0)
        };
        self.strokes.iter().map(from_edge).min_by(f64::total_cmp)
    }
}

/// Radius in pixels of an apple by its box: half the mean of its sides.
pub(super) fn radius_px(bounds: &PixelBox) -> f64 {
    f64::midpoint(bounds.width(), bounds.height()) / 2.0
}

/// The middle of a box, pixels.
pub(super) fn middle_px(bounds: &PixelBox) -> [f64; 2] {
    [
        f64::midpoint(bounds.x_min, bounds.x_max),
        f64::midpoint(bounds.y_min, bounds.y_max),
    ]
}

/// Distance in pixels of the nearest stroke of wood from the middle of a box.
pub(super) fn distance_from_box(frame: &RealFrame, bounds: &PixelBox) -> Option<f64> {
    let middle = middle_px(bounds);
    let distances = frame.wood_strokes().map(|stroke| stroke.nearest(middle).0);
    distances.min_by(f64::total_cmp)
}

/// The wood nearest to a place; `None` where no stroke of wood is near in depth.
///
/// Strokes count that are nearest as seen from the centre, or as seen from the middle of the box: which branch is the
/// nearest does not depend on how well a method has placed the centre.
pub(super) fn wood_near<'a>(frame: &'a RealFrame, place: &Place) -> Option<WoodNear<'a>> {
    let slack = AS_NEAR_RADII * place.radius_px;
    // Distance from the centre, from the middle of the box, the point nearest to the centre.
    let mut seen: Vec<(f64, f64, StrokePoint, &Stroke)> = frame
        .wood_strokes()
        .filter_map(|stroke| {
            let (distance, foot) = stroke.nearest_point(place.center_px)?;
            Some((distance, stroke.nearest(place.box_px).0, foot, stroke))
        })
        .collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let is_own = |foot: &StrokePoint| {
        depth_at(&frame.frame.depth, foot).is_none_or(|reading| {
            let depth_m = reading * frame.frame.camera.depth_scale;
            (depth_m - place.depth_m).abs() <= OWN_DEPTH_RADII * place.radius_m
        })
    };
    let own: Vec<_> = seen.iter().filter(|(_, _, foot, _)| is_own(foot)).collect();
    let distance_px = own.first()?.0;
    let from_box_px = own.iter().map(|o| o.1).min_by(f64::total_cmp)?;
    let as_near: Vec<_> = own
        .into_iter()
        .filter(|(center, middle, _, _)| {
            *center <= distance_px + slack || *middle <= from_box_px + slack
        })
        .collect();
    Some(WoodNear {
        strokes: as_near.iter().map(|near| near.3).collect(),
        feet: as_near.iter().map(|near| [near.2.x, near.2.y]).collect(),
        distance_px,
        passed_over: seen.iter().take_while(|near| !is_own(&near.2)).count(),
    })
}

/// The median of the depth readings on a stroke at a point of it, in units of the image; `None` where there are few.
fn depth_at(depth: &DepthImage, foot: &StrokePoint) -> Option<f64> {
    let radius = foot.half_width.max(LEAST_DISC_PX);
    let range = |middle: f64| {
        let first = (middle - radius).floor().max(0.0) as usize;
        let last = (middle + radius).ceil().max(0.0) as usize;
        first..last
    };
    let mut readings = Vec::new();
    for v in range(foot.y) {
        for u in range(foot.x) {
            let (x, y) = (u as f64 + 0.5 - foot.x, v as f64 + 0.5 - foot.y);
            if x.hypot(y) <= radius {
                readings.extend(depth.get(u, v).map(f64::from));
            }
        }
    }
    if readings.len() < LEAST_READINGS {
        return None;
    }
    median(&mut readings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_labels::parse_strokes;
    use pomona_scenes::Suite;

    /// A frame without readings and with these strokes.
    fn frame(strokes: &str) -> RealFrame {
        let mut frame = Suite::Lab15.cases().next().unwrap().scene().frame;
        frame.depth = DepthImage::empty(frame.depth.width, frame.depth.height);
        let text = format!("image a\n{strokes}");
        RealFrame::new(frame, parse_strokes(&text, "s".as_ref()).unwrap().remove(0))
    }

    const PLACE: Place = Place {
        center_px: [100.0, 100.0],
        box_px: [100.0, 100.0],
        depth_m: 1.0,
        radius_px: 40.0,
        radius_m: 0.04,
    };

    #[test]
    fn strokes_almost_as_near_count_and_far_wood_and_stalks_do_not() {
        let frame = frame(
            "far 110,0,2 110,200,2\npeduncle 105,0,2 105,200,2\nwood 0,160,2 200,160,2\nwood 0,45,2 200,45,2\nwood 0,170,2 200,170,2",
        );
        let near = wood_near(&frame, &PLACE).unwrap();
        assert_eq!(near.feet, [[100.0, 45.0], [100.0, 160.0]]);
        assert_eq!((near.distance_px, near.passed_over), (55.0, 0));
        assert_eq!(near.distance_from([0.0, 46.0]), Some(0.0));
        assert_eq!(near.distance_from([30.0, 150.0]), Some(8.0));
    }

    #[test]
    fn wood_nearest_to_the_box_counts_too() {
        // The centre is placed 20 pixels low, and the lower branch seems nearer.
        let frame = frame("wood 0,30,2 200,30,2\nwood 0,150,2 200,150,2");
        let mut place = PLACE;
        place.box_px = [100.0, 80.0];
        let near = wood_near(&frame, &place).unwrap();
        assert_eq!(near.feet, [[100.0, 150.0], [100.0, 30.0]]);
        assert_eq!(near.distance_px, 50.0);
        assert_eq!(wood_near(&frame, &PLACE).unwrap().feet.len(), 1);
    }

    #[test]
    fn wood_far_in_front_or_behind_is_passed_over_where_depth_says_so() {
        let mut frame = frame("wood 0,60,3 200,60,3\nwood 0,170,3 200,170,3");
        let width = frame.frame.depth.width;
        let mut read = |v: usize, metres: f64| {
            let reading = (metres / frame.frame.camera.depth_scale).round() as u16;
            for v in v - 3..v + 3 {
                frame.frame.depth.readings[v * width + 90..v * width + 110].fill(reading);
            }
            wood_near(&frame, &PLACE).map(|near| (near.feet, near.passed_over))
        };
        let (upper, lower) = (vec![[100.0, 60.0]], vec![[100.0, 170.0]]);
        assert_eq!(read(60, 1.0), Some((upper.clone(), 0)));
        assert_eq!(read(60, 1.15), Some((upper, 0)));
        assert_eq!(read(60, 1.17), Some((lower, 1)));
        assert_eq!(read(170, 0.5), None);
    }
}
