use crate::arrow::draw_arrow;
use crate::boxes::{draw_box, draw_refused_box};
use crate::canvas::{Canvas, Point};
use crate::gripper::{draw_gripper, draw_path};
use crate::layout::Rectangle;
use crate::occupancy::Occupancy;
use crate::palette;
use crate::projection::ArrowShape;
use crate::text::{Font, shorten};

/// One line of the legend: a sample of what is drawn.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Entry {
    Box,
    Refused,
    Sphere,
    Surface,
    Branch,
    Direction,
    Towards,
    Away,
    Path,
    Gripper,
    /// Number of labels for which there was no room.
    LeftOut(usize),
}

impl Entry {
    fn words(&self) -> String {
        match self {
            Self::Box => "apple".into(),
            Self::Refused => "refused".into(),
            Self::Sphere => "fitted sphere".into(),
            Self::Surface => "apple surface".into(),
            Self::Branch => "branch".into(),
            Self::Direction => "picking direction".into(),
            Self::Towards => "towards the camera".into(),
            Self::Away => "away from the camera".into(),
            Self::Path => "path".into(),
            Self::Gripper => "gripper".into(),
            Self::LeftOut(count) => format!("{count} labels left out"),
        }
    }
}

/// The legend in a corner of the picture.
pub(crate) struct Legend {
    entries: Vec<Entry>,
    font: Font,
    scale: f32,
}

impl Legend {
    pub(crate) fn new(entries: Vec<Entry>, font: Font, scale: f32) -> Self {
        Self {
            entries,
            font,
            scale,
        }
    }

    fn row_height(&self) -> i32 {
        (self.font.line_height() as f32 * 1.25) as i32
    }

    fn padding(&self) -> i32 {
        self.font.line_height() / 2
    }

    /// Width of a sample, pixels.
    fn sample_width(&self) -> i32 {
        self.font.line_height() * 2
    }

    /// The corner where the legend hides least; `None` where it would take
    /// more than a third of the picture's width or height or is empty.
    pub(crate) fn place(
        &self,
        width: usize,
        height: usize,
        occupancy: &Occupancy,
    ) -> Option<Rectangle> {
        let longest = self
            .entries
            .iter()
            .map(|e| self.font.width(&e.words()))
            .max()?;
        let w = 3 * self.padding() + self.sample_width() + longest;
        let h = 2 * self.padding() + self.row_height() * self.entries.len() as i32;
        let (width, height) = (width as i32, height as i32);
        if 3 * w > width || 2 * h > height {
            return None;
        }
        let margin = self.padding();
        let (far_x, far_y) = (width - w - margin, height - h - margin);
        let corners = [
            (margin, far_y),
            (far_x, far_y),
            (margin, margin),
            (far_x, margin),
        ];
        let rectangles = corners.map(|(left, top)| Rectangle {
            left,
            top,
            width: w,
            height: h,
        });
        rectangles.into_iter().min_by(|a, b| {
            occupancy
                .mean(a.edges())
                .total_cmp(&occupancy.mean(b.edges()))
        })
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas, rectangle: Rectangle) {
        let edges = [
            rectangle.left,
            rectangle.top,
            rectangle.width,
            rectangle.height,
        ]
        .map(|v| v as f32);
        canvas.rounded_rectangle(
            edges,
            self.padding() as f32 / 2.0,
            palette::BACKGROUND,
            0.85,
        );
        let text_left = rectangle.left + 2 * self.padding() + self.sample_width();
        let columns = (rectangle.right() - text_left) / self.font.char_width();
        for (row, entry) in self.entries.iter().enumerate() {
            let top = rectangle.top + self.padding() + row as i32 * self.row_height();
            let words = shorten(&entry.words(), columns.max(0) as usize);
            let text_top = top + (self.row_height() - self.font.line_height()) / 2;
            self.font
                .write(canvas, &words, text_left, text_top, false, palette::TEXT);
            let left = (rectangle.left + self.padding()) as f32;
            let middle = top as f32 + self.row_height() as f32 / 2.0;
            self.draw_sample(canvas, entry, left, middle);
        }
    }

    fn draw_sample(&self, canvas: &mut Canvas, entry: &Entry, left: f32, middle: f32) {
        let (width, half) = (
            self.sample_width() as f32,
            self.font.line_height() as f32 * 0.42,
        );
        let area = [
            left + width / 2.0 - half,
            middle - half,
            left + width / 2.0 + half,
            middle + half,
        ];
        let at = Point::from_xy(left + width / 2.0, middle);
        match entry {
            Entry::Box => draw_box(canvas, area, self.scale),
            Entry::Refused => draw_refused_box(canvas, area, self.scale),
            Entry::Sphere => canvas.circle(at, half, palette::SPHERE, 0.9, 1.4 * self.scale),
            Entry::Surface => self.draw_dots(canvas, at, palette::SURFACE),
            Entry::Branch => self.draw_dots(canvas, at, palette::BRANCH),
            Entry::Direction => {
                let (start, tip) = (
                    Point::from_xy(left, middle),
                    Point::from_xy(left + width, middle),
                );
                draw_arrow(canvas, &ArrowShape::Across { start, tip }, self.scale);
            }
            Entry::Towards => draw_arrow(canvas, &ArrowShape::Towards { at }, 0.8 * self.scale),
            Entry::Away => draw_arrow(canvas, &ArrowShape::Away { at }, 0.8 * self.scale),
            Entry::Path => {
                let ends = [
                    Point::from_xy(left, middle),
                    Point::from_xy(left + width, middle),
                ];
                draw_path(canvas, &ends, self.scale);
            }
            Entry::Gripper => {
                let [l, t, r, b] = area;
                let corners = [(l, t), (r, t), (r, b), (l, b)].map(|(x, y)| Point::from_xy(x, y));
                draw_gripper(canvas, &corners, self.scale);
            }
            Entry::LeftOut(_) => {}
        }
    }

    fn draw_dots(&self, canvas: &mut Canvas, at: Point, color: [u8; 3]) {
        let step = self.sample_width() as f32 / 5.0;
        for i in -2..=2i8 {
            let shift = f32::from(i) * step;
            let rise = if i % 2 == 0 { 0.15 } else { -0.15 } * self.font.line_height() as f32;
            canvas.disc(
                Point::from_xy(at.x + shift, at.y + rise),
                2.6 * self.scale,
                color,
                1.0,
            );
        }
    }
}
