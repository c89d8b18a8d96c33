//! Apples turned into pictures of apples.

use crate::boxes::{Draw, Made};
use pomona_cloud::Frame;

/// The picture is wider than the box by this share.
const FRAME: f64 = 0.3;

/// The most by which it is turned away, as the tangent of the angle, about 35 degrees.
const TILT: f64 = 0.7;

/// Standard deviation of its readings, metres.
const NOISE_M: f64 = 0.0015;

/// The frame with the depth about each box replaced by that of a tilted plane, where the boxes have depth.
pub(crate) fn with_posters(frame: &Frame, boxes: &[Made], seed: u64) -> Frame {
    let mut frame = frame.clone();
    let mut draw = Draw::new(seed, 77);
    let (camera, depth) = (&frame.camera, &mut frame.depth);
    let original = depth.clone();
    for made in boxes {
        let b = &made.detection;
        let (u, v) = (
            f64::midpoint(b.x_min, b.x_max),
            f64::midpoint(b.y_min, b.y_max),
        );
        let (a, c) = (draw.between(-TILT, TILT), draw.between(-TILT, TILT));
        let Some(reading) = original.get(u as usize, v as usize) else {
            continue;
        };
        let z = f64::from(reading) * camera.depth_scale;
        let (w, h) = (
            (0.5 + FRAME) * (b.x_max - b.x_min),
            (0.5 + FRAME) * (b.y_max - b.y_min),
        );
        for y in (v - h).max(0.0) as usize..((v + h).max(0.0) as usize).min(depth.height) {
            for x in (u - w).max(0.0) as usize..((u + w).max(0.0) as usize).min(depth.width) {
                let i = y * depth.width + x;
                if depth.readings[i] == 0 {
                    continue;
                }
                // The plane through the middle with slopes a and c; a tilt of a ray is small beside it.
                let (dx, dy) = (
                    (x as f64 - u) / camera.fx * z,
                    (y as f64 - v) / camera.fy * z,
                );
                let plane = z + a * dx + c * dy + NOISE_M * draw.normal();
                let reading = (plane / camera.depth_scale).round();
                depth.readings[i] = reading.clamp(1.0, f64::from(u16::MAX)) as u16;
            }
        }
    }
    frame
}
