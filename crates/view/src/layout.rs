use crate::occupancy::Occupancy;

/// A rectangle of whole pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) width: i32,
    pub(crate) height: i32,
}

impl Rectangle {
    pub(crate) fn right(self) -> i32 {
        self.left + self.width
    }

    pub(crate) fn bottom(self) -> i32 {
        self.top + self.height
    }

    pub(crate) fn edges(self) -> [f32; 4] {
        [self.left, self.top, self.right(), self.bottom()].map(|edge| edge as f32)
    }

    /// Whether both share a pixel.
    pub(crate) fn overlaps(self, other: Self) -> bool {
        self.left < other.right()
            && other.left < self.right()
            && self.top < other.bottom()
            && other.top < self.bottom()
    }

    /// The straight gap between both, pixels; 0 where they touch.
    pub(crate) fn gap(self, other: Self) -> f32 {
        let dx = (other.left - self.right())
            .max(self.left - other.right())
            .max(0);
        let dy = (other.top - self.bottom())
            .max(self.top - other.bottom())
            .max(0);
        (dx as f32).hypot(dy as f32)
    }
}

/// A label to be placed: its size, the object it names, and the preferred position of its centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LabelRequest {
    pub(crate) width: i32,
    pub(crate) height: i32,
    pub(crate) anchor: Rectangle,
    pub(crate) center: Option<(i32, i32)>,
}

/// Places labels one after the other, each where it overlaps none before it,
/// hides little and is near the object it names.
pub(crate) struct Layout<'a> {
    width: i32,
    height: i32,
    occupancy: &'a Occupancy,
    /// Placed rectangles, by the squares of the picture that they touch.
    squares: Vec<Vec<Rectangle>>,
    columns: i32,
    /// The smallest sizes for which there was no room; with more labels there is never more.
    unplaceable: Vec<(i32, i32)>,
}

/// Side of the squares by which placed rectangles are found again, pixels.
const SQUARE: i32 = 64;
/// Rings of candidate positions around the anchor; each is half a label's height further out.
const RINGS: i32 = 12;
/// Cost of hiding something entirely, in rings of distance.
const HIDING_COST: f64 = 14.0;

impl<'a> Layout<'a> {
    pub(crate) fn new(width: usize, height: usize, occupancy: &'a Occupancy) -> Self {
        let (width, height) = (width as i32, height as i32);
        let columns = width / SQUARE + 1;
        let squares = vec![Vec::new(); (columns * (height / SQUARE + 1)) as usize];
        Self {
            width,
            height,
            occupancy,
            squares,
            columns,
            unplaceable: Vec::new(),
        }
    }

    /// Reserves a rectangle in which something is drawn already.
    pub(crate) fn reserve(&mut self, rectangle: Rectangle) {
        for square in self.squares_of(rectangle) {
            self.squares[square].push(rectangle);
        }
    }

    /// Finds room for a label and takes it; `None` where there is none.
    ///
    /// Candidates are positions in rings around the anchor, then a raster over the whole picture.
    pub(crate) fn place(&mut self, request: &LabelRequest) -> Option<Rectangle> {
        let rectangle = self.near(request).or_else(|| self.anywhere(request))?;
        self.reserve(rectangle);
        Some(rectangle)
    }

    fn near(&self, request: &LabelRequest) -> Option<Rectangle> {
        let mut best: Option<(f64, Rectangle)> = None;
        let mut consider = |left: i32, top: i32, distance: f64| {
            let Some(rectangle) = self.inside(left, top, request) else {
                return;
            };
            let shift = f64::from((rectangle.left - left).abs() + (rectangle.top - top).abs());
            let hidden = self.occupancy.mean(rectangle.edges());
            let cost = HIDING_COST * hidden + distance + shift / f64::from(request.height.max(1));
            if best.is_none_or(|(least, _)| cost < least) && self.is_free(rectangle) {
                best = Some((cost, rectangle));
            }
        };
        if let Some((x, y)) = request.center {
            consider(x - request.width / 2, y - request.height / 2, 0.0);
        }
        for ring in 0..RINGS {
            let out = ring * request.height / 2;
            for (order, (left, top)) in around(request, out).into_iter().enumerate() {
                consider(left, top, 0.5 + f64::from(ring) + 0.01 * order as f64);
            }
        }
        best.map(|(_, rectangle)| rectangle)
    }

    fn anywhere(&mut self, request: &LabelRequest) -> Option<Rectangle> {
        let (w, h) = (request.width, request.height);
        let too_large = w > self.width || h > self.height;
        if too_large
            || w < 1
            || h < 1
            || self.unplaceable.iter().any(|(fw, fh)| w >= *fw && h >= *fh)
        {
            return None;
        }
        let rows = (0..=self.height - h).step_by(h.unsigned_abs() as usize);
        let places = rows.flat_map(|top| {
            let columns = (0..=self.width - w).step_by(h.unsigned_abs() as usize);
            columns.map(move |left| Rectangle {
                left,
                top,
                width: w,
                height: h,
            })
        });
        let free = places.filter(|rectangle| self.is_free(*rectangle));
        let nearest = free.min_by(|a, b| a.gap(request.anchor).total_cmp(&b.gap(request.anchor)));
        if nearest.is_none() {
            self.unplaceable.push((w, h));
        }
        nearest
    }

    /// The label at this corner, moved into the picture; `None` where it is larger than that.
    fn inside(&self, left: i32, top: i32, request: &LabelRequest) -> Option<Rectangle> {
        let (room_x, room_y) = (self.width - request.width, self.height - request.height);
        (room_x >= 0 && room_y >= 0).then(|| Rectangle {
            left: left.clamp(0, room_x),
            top: top.clamp(0, room_y),
            width: request.width,
            height: request.height,
        })
    }

    fn is_free(&self, rectangle: Rectangle) -> bool {
        // A gap of one pixel between labels.
        let Rectangle {
            left,
            top,
            width,
            height,
        } = rectangle;
        let aired = Rectangle {
            left: left - 1,
            top: top - 1,
            width: width + 2,
            height: height + 2,
        };
        self.squares_of(rectangle)
            .all(|square| self.squares[square].iter().all(|p| !p.overlaps(aired)))
    }

    fn squares_of(&self, rectangle: Rectangle) -> impl Iterator<Item = usize> + use<> {
        // One pixel more, so that a neighbour across a square's border is seen.
        let range = |from: i32, to: i32, size: i32| {
            let last = size / SQUARE;
            ((from - 1) / SQUARE).clamp(0, last)..=((to + 1) / SQUARE).clamp(0, last)
        };
        let columns = self.columns;
        let across = range(rectangle.left, rectangle.right(), self.width);
        range(rectangle.top, rectangle.bottom(), self.height).flat_map(move |row| {
            across
                .clone()
                .map(move |column| (row * columns + column) as usize)
        })
    }
}

/// Top-left corners of the label around its anchor, `out` px further away than touching.
fn around(request: &LabelRequest, out: i32) -> [(i32, i32); 12] {
    let a = request.anchor;
    let gap = out + 3;
    let (above, below) = (a.top - gap - request.height, a.bottom() + gap);
    let (before, after) = (a.left - gap - request.width, a.right() + gap);
    let (middle_x, middle_y) = (
        a.left + (a.width - request.width) / 2,
        a.top + (a.height - request.height) / 2,
    );
    let (flush_right, flush_bottom) = (a.right() - request.width, a.bottom() - request.height);
    [
        (a.left, above),
        (middle_x, above),
        (flush_right, above),
        (a.left, below),
        (middle_x, below),
        (flush_right, below),
        (after, a.top),
        (after, middle_y),
        (after, flush_bottom),
        (before, a.top),
        (before, middle_y),
        (before, flush_bottom),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn request(x: i32, y: i32, width: i32, height: i32) -> LabelRequest {
        LabelRequest {
            width,
            height,
            anchor: Rectangle {
                left: x,
                top: y,
                width: 20,
                height: 20,
            },
            center: None,
        }
    }

    fn lies_inside(p: Rectangle, width: i32, height: i32) -> bool {
        p.left >= 0 && p.top >= 0 && p.right() <= width && p.bottom() <= height
    }

    #[test]
    fn a_lone_label_stands_beside_its_thing() {
        let mut occupancy = Occupancy::new(200, 100);
        occupancy.add_rectangle([90.0, 40.0, 110.0, 60.0], 1.0);
        let occupancy = occupancy.integrated();
        let rectangle = Layout::new(200, 100, &occupancy)
            .place(&request(90, 40, 40, 12))
            .unwrap();
        assert!(rectangle.gap(request(90, 40, 0, 0).anchor) <= 5.0);
        assert_eq!(occupancy.mean(rectangle.edges()), 0.0);
    }

    #[test]
    fn what_does_not_fit_is_left_out() {
        let occupancy = Occupancy::new(50, 50).integrated();
        let mut layout = Layout::new(50, 50, &occupancy);
        assert!(layout.place(&request(0, 0, 51, 5)).is_none());
        assert!(layout.place(&request(0, 0, 50, 50)).is_some());
        assert!(layout.place(&request(0, 0, 1, 1)).is_none());
    }

    proptest! {
        // 40 labels take at most a quarter of this picture, so all find room.
        #[test]
        fn labels_neither_overlap_nor_leave_the_picture(
            things in prop::collection::vec((-50..700i32, -50..500i32, 10..80i32), 0..40),
        ) {
            let occupancy = Occupancy::new(640, 480).integrated();
            let mut layout = Layout::new(640, 480, &occupancy);
            let mut placed: Vec<Rectangle> = Vec::new();
            for (x, y, width) in &things {
                let rectangle = layout.place(&request(*x, *y, *width, 18));
                prop_assert!(rectangle.is_some());
                placed.extend(rectangle);
            }
            for (i, a) in placed.iter().enumerate() {
                prop_assert!(lies_inside(*a, 640, 480));
                prop_assert!(placed[..i].iter().all(|b| !a.overlaps(*b)));
            }
        }

        #[test]
        fn crowds_stay_apart_too(
            things in prop::collection::vec((0..200i32, 0..100i32, 1..90i32), 0..200),
        ) {
            let occupancy = Occupancy::new(200, 100).integrated();
            let mut layout = Layout::new(200, 100, &occupancy);
            let placed: Vec<Rectangle> =
                things.iter().filter_map(|(x, y, width)| layout.place(&request(*x, *y, *width, 18))).collect();
            for (i, a) in placed.iter().enumerate() {
                prop_assert!(lies_inside(*a, 200, 100));
                prop_assert!(placed[..i].iter().all(|b| !a.overlaps(*b)));
            }
        }
    }
}
