use crate::AppleMark;
use crate::canvas::Canvas;
use crate::palette;

const SURFACE_OPACITY: f32 = 0.42;
const BRANCH_OPACITY: f32 = 0.65;

/// What a pixel shows.
#[derive(Clone, Copy)]
enum Part {
    Surface,
    Branch,
}

/// Lays the marks' pixels over the picture, each as a square of `side` px;
/// where squares overlap the picture is tinted once, and a branch hides a surface.
pub(crate) fn draw_points(canvas: &mut Canvas, marks: &[AppleMark<'_>], side: usize) {
    let (width, height) = (canvas.width(), canvas.height());
    let mut parts = vec![None; width * height];
    let mut stamp = |pixels: &[u32], part: Part| {
        for pixel in pixels
            .iter()
            .map(|p| *p as usize)
            .filter(|p| *p < width * height)
        {
            let (left, top) = (
                (pixel % width).saturating_sub((side - 1) / 2),
                (pixel / width).saturating_sub((side - 1) / 2),
            );
            for row in top..(top + side).min(height) {
                parts[row * width + left..row * width + (left + side).min(width)].fill(Some(part));
            }
        }
    };
    for mark in marks {
        stamp(mark.surface_pixels, Part::Surface);
    }
    for mark in marks {
        stamp(mark.branch_pixels, Part::Branch);
    }
    for (pixel, part) in parts.into_iter().enumerate() {
        let (x, y) = ((pixel % width) as i32, (pixel / width) as i32);
        match part {
            Some(Part::Surface) => canvas.blend(x, y, palette::SURFACE, SURFACE_OPACITY),
            Some(Part::Branch) => canvas.blend(x, y, palette::BRANCH, BRANCH_OPACITY),
            None => {}
        }
    }
}
