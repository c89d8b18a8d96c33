use crate::arrow::{MARKER_RADIUS, draw_arrow};
use crate::boxes::{draw_box, draw_refused_box, visible_part};
use crate::canvas::{Canvas, Point};
use crate::gripper::{capsule_outline, draw_gripper, draw_path, path_runs};
use crate::label::Label;
use crate::layout::{LabelRequest, Layout, Rectangle};
use crate::legend::{Entry, Legend};
use crate::occupancy::Occupancy;
use crate::points::draw_points;
use crate::projection::{ArrowShape, arrow_shape, image_of, sphere_outline};
use crate::text::Font;
use crate::{AppleMark, ViewError, palette};
use pomona_cloud::{Camera, ColorImage};

/// Draws picks over the colour image in which they were found.
///
/// Apples' numbers, captions and reasons of refusal are written on labels that
/// overlap neither each other nor the picture's edge. A label for which there is no
/// room is left out, and the legend says how many were. Line widths and text
/// follow the picture's height.
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    image: &'a ColorImage,
    camera: &'a Camera,
    legend: bool,
}

/// What one mark becomes in the picture.
struct Sketch {
    part: Option<[f32; 4]>,
    outline: Option<Vec<Point>>,
    arrow: Option<ArrowShape>,
    path: Vec<Vec<Point>>,
    gripper: Vec<Vec<Point>>,
    label: Label,
    request: Option<LabelRequest>,
}

impl<'a> Overlay<'a> {
    /// An overlay with a legend on `image`, which `camera` took.
    pub fn new(image: &'a ColorImage, camera: &'a Camera) -> Self {
        Self {
            image,
            camera,
            legend: true,
        }
    }

    /// Whether to draw a legend (by default it is drawn). A picture that is too small for it
    /// has none.
    #[must_use]
    pub fn legend(mut self, shown: bool) -> Self {
        self.legend = shown;
        self
    }

    /// The image with the marks drawn over it; later marks cover earlier ones.
    ///
    /// What cannot be shown (a box outside the image, a point behind the
    /// camera, a number that is not finite) is left out.
    ///
    /// # Errors
    ///
    /// [`ViewError::Size`] for an image without pixels or beyond 2²⁹ in width
    /// or height, [`ViewError::PixelCount`] where its pixels do not match its size.
    pub fn draw(&self, marks: &[AppleMark<'_>]) -> Result<ColorImage, ViewError> {
        let mut canvas = Canvas::new(self.image)?;
        let (width, height) = (canvas.width(), canvas.height());
        let scale = (height as f32 / 1080.0).clamp(0.5, 8.0);
        let font = Font::for_height(height);
        let sketches: Vec<Sketch> = marks
            .iter()
            .map(|mark| self.sketch(mark, font, scale))
            .collect();

        let dot_side = (height / 400).clamp(2, 8);
        draw_points(&mut canvas, marks, dot_side);
        for (mark, sketch) in marks.iter().zip(&sketches) {
            if let Some(outline) = &sketch.outline {
                canvas.polyline(outline, true, palette::SPHERE, 0.75, 1.4 * scale);
            }
            match sketch.part {
                Some(part) if mark.refused.is_some() => draw_refused_box(&mut canvas, part, scale),
                Some(part) => draw_box(&mut canvas, part, scale),
                None => {}
            }
        }
        for outline in sketches.iter().flat_map(|s| &s.gripper) {
            draw_gripper(&mut canvas, outline, scale);
        }
        for run in sketches.iter().flat_map(|s| &s.path) {
            draw_path(&mut canvas, run, scale);
        }
        for arrow in sketches.iter().filter_map(|s| s.arrow.as_ref()) {
            draw_arrow(&mut canvas, arrow, scale);
        }

        let occupancy = occupancy_of(&sketches, width, height, scale);
        let entries = if self.legend {
            entries_of(marks, &sketches)
        } else {
            Vec::new()
        };
        let mut legend = Legend::new(entries.clone(), font, scale);
        let mut corner = legend.place(width, height, &occupancy);
        let mut rectangles = place_labels(&sketches, corner, width, height, &occupancy);
        let left_out =
            |rectangles: &[Option<Rectangle>]| rectangles.iter().filter(|p| p.is_none()).count();
        if self.legend && left_out(&rectangles) > 0 {
            // The legend grows by a line, so the labels are placed once more around it.
            let more = |count| [entries.clone(), vec![Entry::LeftOut(count)]].concat();
            corner = Legend::new(more(marks.len()), font, scale).place(width, height, &occupancy);
            rectangles = place_labels(&sketches, corner, width, height, &occupancy);
            legend = Legend::new(more(left_out(&rectangles)), font, scale);
        }

        for (sketch, rectangle) in sketches.iter().zip(&rectangles) {
            if let (Some(request), Some(rectangle)) = (&sketch.request, rectangle) {
                Label::draw_leader(&mut canvas, *rectangle, request.anchor, font, scale);
            }
        }
        if let Some(corner) = corner {
            legend.draw(&mut canvas, corner);
        }
        for (sketch, rectangle) in sketches.iter().zip(&rectangles) {
            if let Some(rectangle) = rectangle {
                sketch.label.draw(&mut canvas, *rectangle, font);
            }
        }
        Ok(canvas.into_image())
    }

    fn sketch(&self, mark: &AppleMark<'_>, font: Font, scale: f32) -> Sketch {
        let (width, height) = (self.image.width, self.image.height);
        let part = visible_part(&mark.bounds, width, height);
        let shortest = f64::from(1.4 * MARKER_RADIUS * scale);
        let longest = (width as f64).hypot(height as f64);
        let arrow = mark
            .arrow
            .and_then(|arrow| arrow_shape(self.camera, arrow, shortest, longest));
        let outline = mark
            .sphere
            .and_then(|sphere| sphere_outline(self.camera, &sphere));
        let label = Label::new(mark, font, width);
        let size = label.size(font);
        let seen =
            |p: &Point| p.x >= 0.0 && p.y >= 0.0 && p.x < width as f32 && p.y < height as f32;
        let point = mark
            .arrow
            .map(|(start, _)| start)
            .or(mark.sphere.map(|sphere| sphere.center));
        let anchor = part.or_else(|| {
            let p = point.and_then(|p| image_of(self.camera, &p)).filter(seen)?;
            Some([p.x, p.y, p.x, p.y])
        });
        let request = anchor.map(|[left, top, right, bottom]| {
            let (l, t) = (left.floor() as i32, top.floor() as i32);
            let anchor = Rectangle {
                left: l,
                top: t,
                width: right.ceil() as i32 - l,
                height: bottom.ceil() as i32 - t,
            };
            let center = arrow.as_ref().and_then(|arrow| beyond_tip(arrow, size));
            LabelRequest {
                width: size.0,
                height: size.1,
                anchor,
                center,
            }
        });
        Sketch {
            part,
            outline,
            arrow,
            path: path_runs(self.camera, &mark.path, width, height),
            gripper: mark
                .gripper
                .iter()
                .filter_map(|part| capsule_outline(self.camera, part))
                .collect(),
            label,
            request,
        }
    }
}

/// Centre of a label of this size that stands just beyond an arrow's tip.
fn beyond_tip(arrow: &ArrowShape, (width, height): (i32, i32)) -> Option<(i32, i32)> {
    let ArrowShape::Across { start, tip } = *arrow else {
        return None;
    };
    let (dx, dy) = (tip.x - start.x, tip.y - start.y);
    let length = dx.hypot(dy);
    if length <= 0.0 || !length.is_finite() {
        return None;
    }
    let (dx, dy) = (dx / length, dy / length);
    // From the centre of a rectangle to its edge along (dx, dy), and a little air.
    let to_side = width as f32 / 2.0 / dx.abs().max(1e-3);
    let to_edge = height as f32 / 2.0 / dy.abs().max(1e-3);
    let out = to_side.min(to_edge) + 4.0;
    Some(((tip.x + out * dx) as i32, (tip.y + out * dy) as i32))
}

/// What labels should not hide: boxes, and above all arrows.
fn occupancy_of(sketches: &[Sketch], width: usize, height: usize, scale: f32) -> Occupancy {
    let mut occupancy = Occupancy::new(width, height);
    for sketch in sketches {
        if let Some(part) = sketch.part {
            occupancy.add_rectangle(part, 1.0);
        }
        match sketch.arrow {
            Some(ArrowShape::Across { start, tip }) => occupancy.add_line(start, tip, 2.0),
            Some(ArrowShape::Towards { at } | ArrowShape::Away { at }) => {
                let r = MARKER_RADIUS * scale;
                occupancy.add_rectangle([at.x - r, at.y - r, at.x + r, at.y + r], 2.0);
            }
            None => {}
        }
    }
    occupancy.integrated()
}

fn place_labels(
    sketches: &[Sketch],
    corner: Option<Rectangle>,
    width: usize,
    height: usize,
    occupancy: &Occupancy,
) -> Vec<Option<Rectangle>> {
    let mut layout = Layout::new(width, height, occupancy);
    if let Some(corner) = corner {
        layout.reserve(corner);
    }
    sketches
        .iter()
        .map(|sketch| layout.place(sketch.request.as_ref()?))
        .collect()
}

/// The kinds of things that these marks bring into the picture.
fn entries_of(marks: &[AppleMark<'_>], sketches: &[Sketch]) -> Vec<Entry> {
    let mut entries = Vec::new();
    for (mark, sketch) in marks.iter().zip(sketches) {
        if sketch.part.is_some() {
            entries.push(if mark.refused.is_some() {
                Entry::Refused
            } else {
                Entry::Box
            });
        }
        if sketch.outline.is_some() {
            entries.push(Entry::Sphere);
        }
        if !mark.surface_pixels.is_empty() {
            entries.push(Entry::Surface);
        }
        if !mark.branch_pixels.is_empty() {
            entries.push(Entry::Branch);
        }
        match sketch.arrow {
            Some(ArrowShape::Across { .. }) => entries.push(Entry::Direction),
            Some(ArrowShape::Towards { .. }) => entries.push(Entry::Towards),
            Some(ArrowShape::Away { .. }) => entries.push(Entry::Away),
            None => {}
        }
        if !sketch.path.is_empty() {
            entries.push(Entry::Path);
        }
        if !sketch.gripper.is_empty() {
            entries.push(Entry::Gripper);
        }
    }
    entries.sort();
    entries.dedup();
    entries
}
