use crate::canvas::{Canvas, Point};
use crate::palette;
use pomona_cloud::PixelBox;

/// The part of a box inside the image as left, top, right, bottom; `None`
/// where there is none or the box is inverted or not finite.
pub(crate) fn visible_part(bounds: &PixelBox, width: usize, height: usize) -> Option<[f32; 4]> {
    let edges = [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max];
    let valid = edges.iter().all(|e| e.is_finite()) && edges[0] <= edges[2] && edges[1] <= edges[3];
    let part = [
        edges[0].max(0.0) as f32,
        edges[1].max(0.0) as f32,
        edges[2].min(width as f64) as f32,
        edges[3].min(height as f64) as f32,
    ];
    (valid && part[0] < part[2] && part[1] < part[3]).then_some(part)
}

/// The outline of a visible part, in blue.
pub(crate) fn draw_box(canvas: &mut Canvas, part: [f32; 4], scale: f32) {
    outline(canvas, part, palette::BOX, scale);
}

/// The outline of a visible part, in orange, with diagonal lines across it.
pub(crate) fn draw_refused_box(canvas: &mut Canvas, part: [f32; 4], scale: f32) {
    let [left, top, right, bottom] = part;
    let spacing = 9.0 * scale;
    // Counted, since a running sum of floats stops growing where the picture is very wide.
    let count = ((right - left + bottom - top) / spacing) as u32;
    // One line for each x + y = sum, from the top or right edge to the left or bottom one.
    for i in 1..=count {
        let sum = left + top + i as f32 * spacing;
        let (from_x, to_x) = ((sum - top).min(right), (sum - bottom).max(left));
        let (from, to) = (
            Point::from_xy(from_x, sum - from_x),
            Point::from_xy(to_x, sum - to_x),
        );
        canvas.line(from, to, palette::REFUSED, 0.75, 1.5 * scale);
    }
    outline(canvas, part, palette::REFUSED, scale);
}

pub(crate) fn outline(
    canvas: &mut Canvas,
    [left, top, right, bottom]: [f32; 4],
    color: [u8; 3],
    scale: f32,
) {
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
    let corners = corners.map(|(x, y)| Point::from_xy(x, y));
    canvas.polyline(&corners, true, palette::BACKGROUND, 0.55, 4.0 * scale);
    canvas.polyline(&corners, true, color, 1.0, 2.2 * scale);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(x_min: f64, y_min: f64, x_max: f64, y_max: f64) -> Option<[f32; 4]> {
        visible_part(
            &PixelBox {
                name: String::new(),
                x_min,
                y_min,
                x_max,
                y_max,
                score: 1.0,
            },
            40,
            30,
        )
    }

    #[test]
    fn only_what_lies_in_the_image_is_visible() {
        assert_eq!(part(-5.0, 3.0, 10.0, 1e300), Some([0.0, 3.0, 10.0, 30.0]));
        assert_eq!(part(50.0, 3.0, 60.0, 9.0), None);
        assert_eq!(part(9.0, 3.0, 5.0, 9.0), None);
        assert_eq!(part(f64::NAN, 3.0, 5.0, 9.0), None);
        assert_eq!(part(f64::NEG_INFINITY, 3.0, 5.0, 9.0), None);
    }
}
