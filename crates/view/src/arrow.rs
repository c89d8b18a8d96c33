use crate::canvas::{Canvas, Point};
use crate::palette;
use crate::projection::ArrowShape;

/// Radius of the ⊙ and ⊗ markers at scale 1, pixels.
pub(crate) const MARKER_RADIUS: f32 = 10.0;

/// Draws an arrow in red with a white rim, which sets it off from a red apple.
pub(crate) fn draw_arrow(canvas: &mut Canvas, shape: &ArrowShape, scale: f32) {
    match *shape {
        ArrowShape::Across { start, tip } => draw_across(canvas, start, tip, scale),
        ArrowShape::Towards { at } => {
            draw_ring(canvas, at, scale);
            canvas.disc(at, 3.4 * scale, palette::DIRECTION, 1.0);
        }
        ArrowShape::Away { at } => {
            draw_ring(canvas, at, scale);
            let d = MARKER_RADIUS * scale * std::f32::consts::FRAC_1_SQRT_2;
            for (dx, dy) in [(d, d), (d, -d)] {
                let (from, to) = (
                    Point::from_xy(at.x - dx, at.y - dy),
                    Point::from_xy(at.x + dx, at.y + dy),
                );
                canvas.line(from, to, palette::DIRECTION, 1.0, 2.6 * scale);
            }
        }
    }
}

fn draw_ring(canvas: &mut Canvas, at: Point, scale: f32) {
    canvas.disc(at, (MARKER_RADIUS + 2.5) * scale, palette::TEXT, 0.9);
    canvas.circle(
        at,
        MARKER_RADIUS * scale,
        palette::DIRECTION,
        1.0,
        2.6 * scale,
    );
}

fn draw_across(canvas: &mut Canvas, start: Point, tip: Point, scale: f32) {
    let (dx, dy) = (tip.x - start.x, tip.y - start.y);
    let length = dx.hypot(dy);
    // Written so that NaN is refused.
    if !(length > 0.0) {
        return;
    }
    let (dx, dy) = (dx / length, dy / length);
    let head = (13.0 * scale).min(0.7 * length);
    let half = 0.5 * head;
    let at = |along: f32, aside: f32| {
        Point::from_xy(
            start.x + along * dx - aside * dy,
            start.y + along * dy + aside * dx,
        )
    };
    let neck = length - head;
    let triangle = [at(length, 0.0), at(neck, half), at(neck, -half)];
    canvas.line(start, at(neck, 0.0), palette::TEXT, 0.9, 5.4 * scale);
    canvas.polyline(&triangle, true, palette::TEXT, 0.9, 2.8 * scale);
    canvas.line(start, at(neck, 0.0), palette::DIRECTION, 1.0, 3.0 * scale);
    canvas.polygon(&triangle, palette::DIRECTION, 1.0);
}
