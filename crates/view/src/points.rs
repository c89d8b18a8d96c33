use crate::AppleMark;
use crate::canvas::Canvas;
use crate::palette;

const SURFACE: u8 = 1;
const BRANCH: u8 = 2;
const SURFACE_OPACITY: f32 = 0.42;
const BRANCH_OPACITY: f32 = 0.65;

/// Lays the marks' pixels over the picture, each as a square of `side` px;
/// where squares overlap the picture is tinted once, and branch beats surface.
pub(crate) fn draw_points(canvas: &mut Canvas, marks: &[AppleMark<'_>], side: usize) {
    let (width, height) = (canvas.width(), canvas.height());
    let mut kinds = vec![0u8; width * height];
    let mut stamp = |pixels: &[u32], kind: u8| {
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
                kinds[row * width + left..row * width + (left + side).min(width)].fill(kind);
            }
        }
    };
    for mark in marks {
        stamp(mark.surface_pixels, SURFACE);
    }
    for mark in marks {
        stamp(mark.branch_pixels, BRANCH);
    }
    for (pixel, kind) in kinds.iter().enumerate().filter(|(_, kind)| **kind > 0) {
        let (x, y) = ((pixel % width) as i32, (pixel / width) as i32);
        if *kind == SURFACE {
            canvas.blend(x, y, palette::SURFACE, SURFACE_OPACITY);
        } else {
            canvas.blend(x, y, palette::BRANCH, BRANCH_OPACITY);
        }
    }
}
