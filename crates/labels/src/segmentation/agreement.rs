use crate::strokes::{ImageStrokes, Stroke, StrokeClass};
use pomona_statistics::Proportion;
use serde::Serialize;

/// How well two people's centre lines of wood agree.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct Agreement {
    /// Images that both have drawn.
    pub images: usize,
    /// Length of the first one's centre lines, pixels.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub first_length_px: f64,
    /// Length of the second one's, pixels.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub second_length_px: f64,
    /// Of the first one's length, the share within the tolerance of a centre line of the second's: what a method would
    /// find that drew as the second did.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub recall: Proportion,
    /// Of the second one's length, the share within the tolerance of a centre line of the first's.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub precision: Proportion,
    /// The recall of wood at least 4 pixels wide.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub recall_wide: Proportion,
    /// The precision of wood at least 4 pixels wide.
    #[cfg_attr(test, schemars(with = "pomona_schema::Proportion"))]
    pub precision_wide: Proportion,
}

/// Width in pixels from which on wood is wide.
const WIDE_PX: f64 = 4.0;

/// Compares the wood that two people drew in the same images, at a tolerance in pixels between centre lines; images
/// that only one has drawn do not count. `None` where there is no common one.
///
/// Wood that one took for far does not count against the other.
pub fn agreement(
    first: &[ImageStrokes],
    second: &[ImageStrokes],
    tolerance: f64,
) -> Option<Agreement> {
    let pairs: Vec<(&ImageStrokes, &ImageStrokes)> = first
        .iter()
        .filter_map(|a| Some((a, second.iter().find(|b| b.name == a.name)?)))
        .collect();
    if pairs.is_empty() {
        return None;
    }
    let length = |of: &dyn Fn(&(&ImageStrokes, &ImageStrokes)) -> f64| pairs.iter().map(of).sum();
    let share = |least_width: f64, swapped: bool| {
        let (mut hit, mut of) = (0, 0);
        for (a, b) in &pairs {
            let (of_interest, other) = if swapped { (b, a) } else { (a, b) };
            let others: Vec<&Stroke> = other
                .of(StrokeClass::Wood)
                .chain(other.of(StrokeClass::Far))
                .collect();
            for sample in of_interest.of(StrokeClass::Wood).flat_map(Stroke::samples) {
                if 2.0 * sample.point.half_width < least_width {
                    continue;
                }
                let place = [sample.point.x, sample.point.y];
                of += 1;
                hit += usize::from(
                    others
                        .iter()
                        .any(|stroke| stroke.nearest(place).0 <= tolerance),
                );
            }
        }
        Proportion::new(hit, of)
    };
    let drawn = |image: &ImageStrokes| image.of(StrokeClass::Wood).map(Stroke::length).sum::<f64>();
    Some(Agreement {
        images: pairs.len(),
        first_length_px: length(&|(a, _)| drawn(a)),
        second_length_px: length(&|(_, b)| drawn(b)),
        recall: share(0.0, false),
        precision: share(0.0, true),
        recall_wide: share(WIDE_PX, false),
        precision_wide: share(WIDE_PX, true),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strokes::parse_strokes;

    fn read(text: &str) -> Vec<ImageStrokes> {
        parse_strokes(text, "s.txt".as_ref()).unwrap()
    }

    #[test]
    fn half_of_the_line_and_all_of_the_other() {
        let first = read("image a\nwood 0,0,3 100,0,3\nimage b\nwood 0,0,3 9,9,3");
        let second = read("image a\nwood 0,2,1 50,2,1\nimage c");
        let found = agreement(&first, &second, 3.0).unwrap();
        assert_eq!(
            (found.images, found.recall.of, found.precision.of),
            (1, 100, 50)
        );
        assert!((found.recall.share - 0.52).abs() < 0.02, "{found:?}");
        assert_eq!(found.precision.share, 1.0);
        assert_eq!((found.recall_wide.of, found.precision_wide.of), (100, 0));
        assert!(agreement(&first, &read("image d"), 3.0).is_none());
    }
}
