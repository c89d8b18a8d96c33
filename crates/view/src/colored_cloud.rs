use crate::basis::perpendiculars;
use crate::palette;
use nalgebra::{Point3, Vector3};
use pomona_cloud::PointCloud;
use std::f64::consts::{PI, TAU};

/// What is shown of one apple in its cloud; every part may be absent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CloudMark<'a> {
    /// Points of the apple's surface, as indices into the cloud; those beyond it are passed over.
    pub surface: &'a [u32],
    /// Points of the branch, likewise.
    pub branch: &'a [u32],
    /// Picking direction from the apple's centre O to the foot C on the
    /// branch, metres in the cloud's frame.
    pub arrow: Option<(Point3<f64>, Point3<f64>)>,
}

impl<'a> CloudMark<'a> {
    /// A mark without a direction.
    pub fn new(surface: &'a [u32], branch: &'a [u32]) -> Self {
        Self {
            surface,
            branch,
            arrow: None,
        }
    }
}

/// Distance between neighbouring rings of points on an arrow, as a fraction of its length.
const RING_SPACING: f64 = 1.0 / 120.0;
/// Length of an arrow's shaft, radius of the shaft and of the head's base, and radius of the balls at its ends, as
/// fractions of its length.
const SHAFT: f64 = 0.75;
const SHAFT_RADIUS: f64 = 0.02;
const HEAD_RADIUS: f64 = 0.09;
const BALL_RADIUS: f64 = 0.04;
/// Points on a ring around an arrow.
const RING_POINTS: u32 = 12;
/// Points on a ball.
const BALL_POINTS: u32 = 160;

/// The cloud with surface points pink, branch points green and the rest grey,
/// and for each mark a red arrow made of points, with small red balls at O and C.
///
/// The grey follows the brightness of the cloud's own colours where it has
/// them. Points that are not finite are dropped, so that the result is not
/// organised; missing coordinates count as not finite. An arrow without
/// length or with a number that is not finite is left out. A point in
/// several marks takes the branch's green first, then pink.
pub fn colored_cloud(cloud: &PointCloud, marks: &[CloudMark<'_>]) -> PointCloud {
    let count = cloud.x.len().min(cloud.y.len()).min(cloud.z.len());
    let own = cloud.colors.as_deref().unwrap_or(&[]);
    let mut colors: Vec<[u8; 3]> = (0..count)
        .map(|i| own.get(i).copied().map_or(palette::REST, grey))
        .collect();
    let mut dye = |indices: &[u32], color: [u8; 3]| {
        for index in indices {
            if let Some(own) = colors.get_mut(*index as usize) {
                *own = color;
            }
        }
    };
    for mark in marks {
        dye(mark.surface, palette::SURFACE);
    }
    for mark in marks {
        dye(mark.branch, palette::BRANCH);
    }

    let mut painted = Painted::default();
    for (i, color) in colors.into_iter().enumerate() {
        painted.push([cloud.x[i], cloud.y[i], cloud.z[i]], color);
    }
    for (start, end) in marks.iter().filter_map(|mark| mark.arrow) {
        painted.arrow(start, end);
    }
    let Painted { x, y, z, colors } = painted;
    let mut colored = PointCloud::from_coordinates(x, y, z);
    colored.colors = Some(colors);
    colored
}

/// Luminance (ITU-R BT.601), kept away from black and white so that it recedes.
fn grey([r, g, b]: [u8; 3]) -> [u8; 3] {
    let luminance = 0.299 * f32::from(r) + 0.587 * f32::from(g) + 0.114 * f32::from(b);
    [(60.0 + luminance * 150.0 / 255.0).round() as u8; 3]
}

#[derive(Default)]
struct Painted {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    colors: Vec<[u8; 3]>,
}

impl Painted {
    fn push(&mut self, [x, y, z]: [f32; 3], color: [u8; 3]) {
        if x.is_finite() && y.is_finite() && z.is_finite() {
            self.x.push(x);
            self.y.push(y);
            self.z.push(z);
            self.colors.push(color);
        }
    }

    fn push_red(&mut self, p: Point3<f64>) {
        self.push([p.x as f32, p.y as f32, p.z as f32], palette::DIRECTION);
    }

    /// Shaft, head with its tip at `end`, and a ball at each end.
    fn arrow(&mut self, start: Point3<f64>, end: Point3<f64>) {
        let direction = end - start;
        let length = direction.norm();
        // Written so that NaN is refused.
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let axis = direction / length;
        let (right, down) = perpendiculars(&axis);
        let rings = (1.0 / RING_SPACING) as u32;
        for ring in 0..=rings {
            let fraction = f64::from(ring) / f64::from(rings);
            let radius = if fraction < SHAFT {
                SHAFT_RADIUS
            } else {
                HEAD_RADIUS * (1.0 - fraction) / (1.0 - SHAFT)
            };
            for i in 0..RING_POINTS {
                let (sine, cosine) = (TAU * f64::from(i) / f64::from(RING_POINTS)).sin_cos();
                let aside = (right * cosine + down * sine) * (radius * length);
                self.push_red(start + direction * fraction + aside);
            }
        }
        for center in [start, end] {
            self.ball(center, BALL_RADIUS * length);
        }
    }

    /// Points spread evenly over a sphere along a spiral of golden angles.
    fn ball(&mut self, center: Point3<f64>, radius: f64) {
        let golden_angle = PI * (3.0 - 5.0_f64.sqrt());
        for i in 0..BALL_POINTS {
            let height = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(BALL_POINTS);
            let around = (1.0 - height * height).sqrt();
            let (sine, cosine) = (golden_angle * f64::from(i)).sin_cos();
            self.push_red(center + Vector3::new(around * cosine, around * sine, height) * radius);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> PointCloud {
        let x = vec![0.0, 1.0, f32::NAN, 3.0];
        let mut cloud = PointCloud::from_coordinates(x, vec![0.0; 4], vec![1.0; 4]);
        cloud.colors = Some(vec![[255, 255, 255], [0, 0, 0], [9, 9, 9], [0, 255, 0]]);
        cloud.size = Some((2, 2));
        cloud
    }

    #[test]
    fn points_take_the_papers_colours() {
        let mark = CloudMark {
            surface: &[0, 1, 99],
            branch: &[1, 2],
            arrow: None,
        };
        let painted = colored_cloud(&cloud(), &[mark]);
        assert_eq!(painted.x, [0.0, 1.0, 3.0]);
        assert_eq!(painted.size, None);
        assert_eq!(
            painted.colors.unwrap(),
            [palette::SURFACE, palette::BRANCH, [148; 3]]
        );
    }

    #[test]
    fn the_arrow_is_red_and_spans_both_ends() {
        let (o, c) = (Point3::new(0.0, 0.0, 1.0), Point3::new(0.0, -0.1, 1.0));
        let painted = colored_cloud(
            &PointCloud::default(),
            &[CloudMark {
                arrow: Some((o, c)),
                ..CloudMark::default()
            }],
        );
        assert!(
            painted
                .colors
                .unwrap()
                .iter()
                .all(|color| *color == palette::DIRECTION)
        );
        let (low, high) = painted
            .y
            .iter()
            .fold((0.0f32, 0.0f32), |(l, h), y| (l.min(*y), h.max(*y)));
        assert!((low + 0.104).abs() < 1e-3 && (high - 0.004).abs() < 1e-3);
    }

    #[test]
    fn what_is_no_arrow_or_no_cloud_adds_nothing() {
        let o = Point3::new(0.0, 0.0, 1.0);
        for end in [
            o,
            Point3::new(f64::NAN, 0.0, 0.0),
            Point3::new(f64::INFINITY, 0.0, 0.0),
        ] {
            let mark = CloudMark {
                surface: &[7],
                arrow: Some((o, end)),
                ..CloudMark::default()
            };
            assert!(colored_cloud(&PointCloud::default(), &[mark]).x.is_empty());
        }
        let ragged = PointCloud::from_coordinates(vec![1.0, 2.0], vec![1.0], vec![1.0, 2.0, 3.0]);
        assert_eq!(
            colored_cloud(&ragged, &[]).colors,
            Some(vec![palette::REST])
        );
    }
}
