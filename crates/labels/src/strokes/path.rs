use super::class::StrokeClass;

/// A point of a stroke, pixels; the image's upper left corner is (0, 0), the first pixel's centre (0.5, 0.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokePoint {
    /// To the right.
    pub x: f64,
    /// Down.
    pub y: f64,
    /// Half of the width there.
    pub half_width: f64,
}

impl StrokePoint {
    /// The point a share `t` of the way to `other`.
    fn towards(&self, other: &Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a + t * (b - a);
        Self {
            x: mix(self.x, other.x),
            y: mix(self.y, other.y),
            half_width: mix(self.half_width, other.half_width),
        }
    }

    fn distance(&self, other: &Self) -> f64 {
        (self.x - other.x).hypot(self.y - other.y)
    }
}

/// A centre line, straight between its points; half widths change linearly.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Stroke {
    /// What it lies on.
    pub class: StrokeClass,
    /// At least two points.
    pub points: Vec<StrokePoint>,
}

/// A point on a centre line that stands for some of its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSample {
    /// The point.
    pub point: StrokePoint,
    /// Length in pixels that it stands for.
    pub length: f64,
}

impl Stroke {
    /// A stroke of this class through these points.
    pub fn new(class: StrokeClass, points: Vec<StrokePoint>) -> Self {
        Self { class, points }
    }

    /// Its length in pixels.
    pub fn length(&self) -> f64 {
        self.points
            .windows(2)
            .map(|pair| pair[0].distance(&pair[1]))
            .sum()
    }

    /// Points along it, at most a pixel apart, each in the middle of the piece that it stands for.
    pub fn samples(&self) -> impl Iterator<Item = PathSample> {
        self.points.windows(2).flat_map(|pair| {
            let (a, b) = (pair[0], pair[1]);
            let length = a.distance(&b);
            let count = (length.ceil() as usize).max(1);
            (0..count).map(move |i| PathSample {
                point: a.towards(&b, (i as f64 + 0.5) / count as f64),
                length: length / count as f64,
            })
        })
    }

    /// Distance of a place from the centre line, and the half width at the nearest point of it.
    pub fn nearest(&self, place: [f64; 2]) -> (f64, f64) {
        self.nearest_point(place)
            .map_or((f64::INFINITY, 0.0), |(distance, foot)| {
                (distance, foot.half_width)
            })
    }

    /// Distance of a place from the centre line, and the point of the line that is nearest to it; `None` for a stroke
    /// of fewer than two points.
    pub fn nearest_point(&self, [x, y]: [f64; 2]) -> Option<(f64, StrokePoint)> {
        let to_piece = |pair: &[StrokePoint]| {
            let (a, b) = (pair[0], pair[1]);
            let (dx, dy) = (b.x - a.x, b.y - a.y);
            let squared = dx * dx + dy * dy;
            let along = (x - a.x) * dx + (y - a.y) * dy;
            let t = if squared > 0.0 {
                (along / squared).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let foot = a.towards(&b, t);
            ((foot.x - x).hypot(foot.y - y), foot)
        };
        let pieces = self.points.windows(2).map(to_piece);
        pieces.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Calls `visit` with the pixel index and the distance from the stroke's edge, negative inside, for each pixel of a
    /// `width` × `height` image whose centre is within `margin` of the edge, once or more.
    pub(crate) fn for_pixels_near(
        &self,
        [width, height]: [usize; 2],
        margin: f64,
        mut visit: impl FnMut(usize, f64),
    ) {
        for pair in self.points.windows(2) {
            let piece = Self::new(self.class, pair.to_vec());
            let (a, b) = (pair[0], pair[1]);
            let reach = a.half_width.max(b.half_width) + margin + 1.0;
            let range = |p: f64, q: f64, size: usize| {
                let low = (p.min(q) - reach).floor().max(0.0) as usize;
                let high = (p.max(q) + reach).ceil().clamp(0.0, size as f64) as usize;
                low..high
            };
            for v in range(a.y, b.y, height) {
                for u in range(a.x, b.x, width) {
                    let (distance, half_width) = piece.nearest([u as f64 + 0.5, v as f64 + 0.5]);
                    if distance - half_width <= margin {
                        visit(v * width + u, distance - half_width);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = StrokePoint> {
        (-20.0..60.0, -20.0..60.0, 0.5..6.0).prop_map(|(x, y, half_width)| StrokePoint {
            x,
            y,
            half_width,
        })
    }

    proptest! {
        #[test]
        fn samples_stand_for_the_whole_length(points in proptest::collection::vec(point(), 2..6)) {
            let stroke = Stroke::new(StrokeClass::Wood, points);
            let sum: f64 = stroke.samples().map(|sample| sample.length).sum();
            prop_assert!((sum - stroke.length()).abs() < 1e-9);
            for sample in stroke.samples() {
                let (distance, _) = stroke.nearest([sample.point.x, sample.point.y]);
                prop_assert!(distance < 1e-9 && sample.length <= 1.0 + 1e-9);
            }
        }

        #[test]
        fn the_nearest_point_is_on_the_line_and_no_sample_is_nearer(
            points in proptest::collection::vec(point(), 2..6),
            place in (-30.0..70.0, -30.0..70.0),
        ) {
            let (stroke, place) = (Stroke::new(StrokeClass::Wood, points), [place.0, place.1]);
            let (distance, foot) = stroke.nearest_point(place).unwrap();
            prop_assert!(stroke.nearest([foot.x, foot.y]).0 < 1e-9);
            for sample in stroke.samples() {
                let (x, y) = (sample.point.x - place[0], sample.point.y - place[1]);
                prop_assert!(x.hypot(y) >= distance - 1e-9);
            }
        }

        #[test]
        fn the_pixels_near_are_those_within_the_margin(points in proptest::collection::vec(point(), 2..4)) {
            let stroke = Stroke::new(StrokeClass::Wood, points);
            let mut near = vec![false; 40 * 30];
            stroke.for_pixels_near([40, 30], 2.0, |k, _| near[k] = true);
            for (k, near) in near.iter().enumerate() {
                let centre = [(k % 40) as f64 + 0.5, (k / 40) as f64 + 0.5];
                // Of two pieces the nearer one need not be the one whose edge is nearer.
                let edge = stroke.points.windows(2).map(|pair| {
                    let (d, h) = Stroke::new(StrokeClass::Wood, pair.to_vec()).nearest(centre);
                    d - h
                }).fold(f64::INFINITY, f64::min);
                prop_assert_eq!(*near, edge <= 2.0, "{}: {}", k, edge);
            }
        }
    }
}
