use crate::{ViewError, Viewpoint, palette};
use nalgebra::Point3;
use pomona_cloud::{ColorImage, PointCloud};

/// How [`render_cloud`] draws.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RenderOptions {
    /// Width of the picture, pixels.
    pub width: usize,
    /// Height of the picture, pixels.
    pub height: usize,
    /// Diameter of a point's disc, pixels; 0 counts as 1.
    pub point_size: usize,
    /// Background colour.
    pub background: [u8; 3],
    /// How strongly edges of depth are darkened (eye-dome lighting), so that
    /// shapes of one colour are seen; 0 leaves the points' colours as they are.
    pub edge_shading: f64,
}

impl Default for RenderOptions {
    /// 960 × 720 on near-white, discs of 3 px, edges moderately darkened.
    fn default() -> Self {
        let background = [248, 248, 246];
        Self {
            width: 960,
            height: 720,
            point_size: 3,
            background,
            edge_shading: 1.0,
        }
    }
}

/// The largest disc drawn, pixels.
const LARGEST_POINT: usize = 64;
/// The largest picture drawn, pixels.
const LARGEST_PICTURE: usize = 1 << 28;

/// A picture of a cloud: each point a disc of a fixed size on the screen, the
/// nearest one seen.
///
/// A cloud without colours is drawn grey. Points behind the eye or not finite
/// are passed over; of two at the same depth the first one is seen.
///
/// # Errors
///
/// [`ViewError::Size`] for a picture without pixels or with more than 2²⁸.
pub fn render_cloud(
    cloud: &PointCloud,
    view: &Viewpoint,
    options: &RenderOptions,
) -> Result<ColorImage, ViewError> {
    let &RenderOptions { width, height, .. } = options;
    let pixel_count = width
        .checked_mul(height)
        .filter(|n| (1..=LARGEST_PICTURE).contains(n));
    let pixel_count = pixel_count.ok_or(ViewError::Size { width, height })?;
    let mut pixels = vec![options.background; pixel_count];
    let mut depths = vec![f32::INFINITY; pixel_count];

    let disc = disc_offsets(options.point_size.clamp(1, LARGEST_POINT));
    let colors = cloud.colors.as_deref().unwrap_or(&[]);
    let coordinates = cloud.x.iter().zip(&cloud.y).zip(&cloud.z);
    for (i, ((x, y), z)) in coordinates.enumerate() {
        let point = Point3::new(f64::from(*x), f64::from(*y), f64::from(*z));
        let Some((u, v, depth)) = view.project(&point, width, height) else {
            continue;
        };
        let color = colors.get(i).copied().unwrap_or(palette::REST);
        for (dx, dy) in &disc {
            let (column, row) = ((u + dx).floor(), (v + dy).floor());
            let inside =
                column >= 0.0 && row >= 0.0 && column < width as f64 && row < height as f64;
            if !inside {
                continue;
            }
            let at = row as usize * width + column as usize;
            if (depth as f32) < depths[at] {
                depths[at] = depth as f32;
                pixels[at] = color;
            }
        }
    }
    if options.edge_shading > 0.0 {
        shade_edges(&mut pixels, &depths, width, options.edge_shading);
    }
    Ok(ColorImage {
        width,
        height,
        pixels,
    })
}

/// Offsets from a disc's centre to the pixels it covers.
fn disc_offsets(diameter: usize) -> Vec<(f64, f64)> {
    let middle = (diameter as f64 - 1.0) / 2.0;
    let along = (0..diameter).map(|i| i as f64 - middle);
    // A quarter pixel more than the radius rounds small discs off without thinning them.
    let reach = (diameter as f64 / 2.0 + 0.25).powi(2);
    let square = along
        .clone()
        .flat_map(|dy| along.clone().map(move |dx| (dx, dy)));
    square
        .filter(|(dx, dy)| dx * dx + dy * dy <= reach)
        .collect()
}

/// Darkens a pixel by how far it lies behind its neighbours, in the logarithm
/// of depth (eye-dome lighting: Boucheny 2009, `PhD` thesis, Université
/// Joseph Fourier, chapter 4).
fn shade_edges(pixels: &mut [[u8; 3]], depths: &[f32], width: usize, strength: f64) {
    let height = depths.len() / width;
    let logarithms: Vec<f32> = depths.iter().map(|d| d.ln()).collect();
    for row in 0..height {
        for column in 0..width {
            let own = logarithms[row * width + column];
            if !own.is_finite() {
                continue;
            }
            let columns = [column.checked_sub(2), Some(column + 2)];
            let rows = [row.checked_sub(2), Some(row + 2)];
            let beside = columns
                .into_iter()
                .flatten()
                .filter(|c| *c < width)
                .map(|c| row * width + c);
            let above = rows
                .into_iter()
                .flatten()
                .filter(|r| *r < height)
                .map(|r| r * width + column);
            let behind: f32 = beside
                .chain(above)
                .map(|i| (own - logarithms[i]).max(0.0))
                .filter(|d| d.is_finite())
                .sum();
            let light = (-25.0 * strength * f64::from(behind) / 4.0).exp().max(0.45);
            for channel in &mut pixels[row * width + column] {
                *channel = (f64::from(*channel) * light).round() as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Projection;
    use nalgebra::Vector3;

    fn view() -> Viewpoint {
        let projection = Projection::Orthographic { field_height: 1.0 };
        Viewpoint::new(
            Point3::origin(),
            Point3::new(0.0, 0.0, 1.0),
            -Vector3::y(),
            projection,
        )
        .unwrap()
    }

    fn options() -> RenderOptions {
        RenderOptions {
            width: 21,
            height: 21,
            point_size: 3,
            background: [0; 3],
            edge_shading: 0.0,
        }
    }

    fn cloud(points: &[([f32; 3], [u8; 3])]) -> PointCloud {
        let axis = |i: usize| points.iter().map(|(p, _)| p[i]).collect();
        let mut cloud = PointCloud::from_coordinates(axis(0), axis(1), axis(2));
        cloud.colors = Some(points.iter().map(|(_, c)| *c).collect());
        cloud
    }

    #[test]
    fn the_nearest_point_is_seen_whatever_the_order() {
        let (near, far) = (
            ([0.0, 0.0, 1.0], [200, 0, 0]),
            ([0.0, 0.0, 2.0], [0, 200, 0]),
        );
        for points in [[near, far], [far, near]] {
            let image = render_cloud(&cloud(&points), &view(), &options()).unwrap();
            assert_eq!(image.pixels[10 * 21 + 10], [200, 0, 0]);
            assert_eq!(image.pixels.iter().filter(|p| **p != [0; 3]).count(), 9);
        }
    }

    #[test]
    fn edges_of_depth_are_darkened_and_the_front_is_not() {
        let mut points = Vec::new();
        for i in 0..21u8 {
            for j in 0..21u8 {
                let [x, y] = [i, j].map(|k| (f32::from(k) - 10.0) / 21.0);
                points.push(([x, y, if i < 10 { 1.0 } else { 1.2 }], [200; 3]));
            }
        }
        let options = RenderOptions {
            point_size: 1,
            edge_shading: 1.0,
            ..options()
        };
        let image = render_cloud(&cloud(&points), &view(), &options).unwrap();
        assert_eq!(image.pixels[10 * 21 + 5], [200; 3]);
        assert!(image.pixels[10 * 21 + 10][0] < 150);
        assert_eq!(image.pixels[10 * 21 + 18], [200; 3]);
    }

    #[test]
    fn bad_input_is_an_error_or_an_empty_picture() {
        let (nan, behind) = (([f32::NAN, 0.0, 1.0], [9; 3]), ([0.0, 0.0, -1.0], [9; 3]));
        let image = render_cloud(&cloud(&[nan, behind]), &view(), &options()).unwrap();
        assert!(image.pixels.iter().all(|p| *p == [0; 3]));
        for (width, height) in [(0, 5), (5, 0), (usize::MAX, 2), (1 << 20, 1 << 20)] {
            let options = RenderOptions {
                width,
                height,
                ..options()
            };
            assert!(matches!(
                render_cloud(&PointCloud::default(), &view(), &options),
                Err(ViewError::Size { .. })
            ));
        }
    }
}
