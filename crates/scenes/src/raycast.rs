use crate::ray::Ray;
use crate::world::{Owner, Part, World};
use pomona_cloud::Camera;
use rayon::prelude::*;

/// The first intersection of each pixel's ray.
#[derive(Clone, Debug)]
pub(crate) struct Raycast {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Exact depth z, metres; 0 where the ray meets nothing.
    pub(crate) depth: Vec<f32>,
    /// Index of the part met; `NOTHING` where there is none.
    pub(crate) part: Vec<u32>,
}

/// The part index of a ray that meets nothing.
pub(crate) const NOTHING: u32 = u32::MAX;

/// Pixels that a part may cover: columns `x.0..x.1`, rows `y.0..y.1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    pub(crate) x: (usize, usize),
    pub(crate) y: (usize, usize),
}

/// The pixels that `part` may cover; `None` where it lies outside the image.
pub(crate) fn extent(part: &Part, camera: &Camera) -> Option<Extent> {
    let everywhere = Extent {
        x: (0, camera.width),
        y: (0, camera.height),
    };
    let Some(hull) = part.hull() else {
        return Some(everywhere);
    };
    if hull.iter().all(|p| p.z <= 0.0) {
        return None;
    }
    // A hull that reaches behind the lens has no bounded image.
    if hull.iter().any(|p| p.z < 1e-3) {
        return Some(everywhere);
    }
    let span = |focal: f64, center: f64, size: usize, axis: usize| {
        let image = hull.iter().map(|p| focal * p[axis] / p.z + center);
        let (low, high) = image.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x), b.max(x))
        });
        let low = low.floor().max(0.0) as usize;
        let high = (high.ceil() + 1.0).clamp(0.0, size as f64) as usize;
        (low < high).then_some((low, high))
    };
    let x = span(camera.fx, camera.cx, camera.width, 0)?;
    let y = span(camera.fy, camera.cy, camera.height, 1)?;
    Some(Extent { x, y })
}

/// Casts the ray of every pixel, row by row; only pixels that a part may cover are tested against it.
pub(crate) fn raycast(world: &World, camera: &Camera) -> Raycast {
    let (width, height) = (camera.width, camera.height);
    let extents: Vec<Option<Extent>> = world.parts.iter().map(|p| extent(p, camera)).collect();
    let mut by_row: Vec<Vec<u32>> = vec![Vec::new(); height];
    for (index, extent) in (0u32..).zip(&extents) {
        if let Some(extent) = extent {
            for row in &mut by_row[extent.y.0..extent.y.1] {
                row.push(index);
            }
        }
    }
    let mut depth = vec![0.0f32; width * height];
    let mut part = vec![NOTHING; width * height];
    depth
        .par_chunks_mut(width)
        .zip(part.par_chunks_mut(width))
        .zip(by_row.par_iter())
        .enumerate()
        .for_each(|(y, ((depth, part), candidates))| {
            for &index in candidates {
                let Some(extent) = extents[index as usize] else {
                    continue;
                };
                let shape = &world.parts[index as usize];
                for x in extent.x.0..extent.x.1 {
                    let ray = Ray::of_pixel(camera, x as f64, y as f64);
                    let Some(z) = shape.hit(&ray) else { continue };
                    let z = z as f32;
                    if part[x] == NOTHING || z < depth[x] {
                        depth[x] = z;
                        part[x] = index;
                    }
                }
            }
        });
    Raycast {
        width,
        height,
        depth,
        part,
    }
}

impl Raycast {
    /// Whose pixel it is; `None` for the sky.
    pub(crate) fn owner(&self, world: &World, pixel: usize) -> Option<Owner> {
        world.parts.get(self.part[pixel] as usize).map(|p| p.owner)
    }
}
