//! Draws made-up marks on the boxes of a frame, to look at the drawing itself:
//! `overlay_demo FRAME OVERLAY.png [CLOUD.png]`.
//!
//! FRAME is a folder with `color.png`, `depth.png`, `camera.json` and
//! `boxes.xml`. Radii, directions and refusals are invented; no apple is fitted.

use nalgebra::{Point3, Vector3};
use pomona_cloud::{Camera, ColorImage, DepthImage, Frame, PixelBox, PointCloud};
use pomona_geometry::Sphere;
use pomona_statistics::upper_median;
use pomona_view::{
    AppleMark, CloudMark, Overlay, Projection, RenderOptions, Viewpoint, colored_cloud,
    render_cloud,
};
use std::error::Error;
use std::path::Path;

/// What is invented for one box.
struct Fake {
    surface: Vec<u32>,
    branch: Vec<u32>,
    arrow: (Point3<f64>, Point3<f64>),
    sphere: Sphere,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, overlay_path, rest @ ..] = arguments.as_slice() else {
        return Err("usage: overlay_demo FRAME OVERLAY.png [CLOUD.png]".into());
    };
    let folder = Path::new(folder);
    let color = ColorImage::read(folder.join("color.png"))?;
    let depth = DepthImage::read(folder.join("depth.png"))?;
    let camera = Camera::read(folder.join("camera.json"))?;
    let boxes = Frame::read(folder)?.boxes.unwrap_or_default();

    let fakes: Vec<Option<Fake>> = boxes
        .iter()
        .enumerate()
        .map(|(i, bounds)| fake(i, bounds, &depth, &camera))
        .collect();
    let mut marks = Vec::new();
    for (number, (bounds, fake)) in boxes.iter().zip(&fakes).enumerate() {
        let mut mark = AppleMark::new(number, bounds.clone());
        match fake {
            None => mark.refused = Some("no_depth".into()),
            Some(fake) => {
                mark.surface_pixels = &fake.surface;
                mark.sphere = Some(fake.sphere);
                mark.caption = Some(format!("r {:.0} mm", fake.sphere.radius * 1000.0));
                if number % 7 == 3 {
                    mark.refused = Some("no_branch".into());
                } else {
                    mark.branch_pixels = &fake.branch;
                    mark.arrow = Some(fake.arrow);
                }
            }
        }
        marks.push(mark);
    }
    Overlay::new(&color, &camera)
        .draw(&marks)?
        .write(overlay_path)?;

    if let [cloud_path] = rest
        && let Some(fake) = fakes.iter().flatten().next()
    {
        let cloud = deproject(&depth, &color, &camera);
        let mut mark = CloudMark::new(&fake.surface, &fake.branch);
        mark.arrow = Some(fake.arrow);
        let target = fake.sphere.center;
        let eye = target + Vector3::new(0.25, -0.1, -0.4);
        let projection = Projection::Perspective {
            vertical_angle: 0.9,
        };
        let view = Viewpoint::new(eye, target, -Vector3::y(), projection)?;
        let picture = render_cloud(
            &colored_cloud(&cloud, &[mark]),
            &view,
            &RenderOptions::default(),
        )?;
        picture.write(cloud_path)?;
    }
    Ok(())
}

fn fake(number: usize, bounds: &PixelBox, depth: &DepthImage, camera: &Camera) -> Option<Fake> {
    let (u0, v0) = bounds.center();
    let half = 0.5 * bounds.width().min(bounds.height());
    let metres = |u: usize, v: usize| {
        let reading = depth.get(u, v).filter(|r| *r > 0)?;
        Some(f64::from(reading) * camera.depth_scale)
    };
    let reach = 2.0 * half;
    let pixels = |low: f64, high: f64| (low.max(0.0) as usize)..(high.max(0.0) as usize);
    let mut surface = Vec::new();
    let mut branch = Vec::new();
    let mut depths = Vec::new();
    // An invented branch crosses above the apple, sloping by a third.
    for v in pixels(v0 - reach, v0 + half) {
        for u in pixels(u0 - reach, u0 + reach) {
            let Some(z) = metres(u, v) else { continue };
            let (x, y) = (u as f64 - u0, v as f64 - v0);
            let pixel = (v * depth.width + u) as u32;
            if x.hypot(y) < 0.9 * half {
                surface.push(pixel);
                depths.push(z);
            } else if (y + 1.3 * half - x / 3.0).abs() < 0.12 * half {
                branch.push(pixel);
            }
        }
    }
    let z = upper_median(&mut depths)?;
    let radius = half * z / camera.fx;
    let center = camera.deproject(u0, v0, z + 0.5 * radius);
    let angle = 0.35 * number as f64 - 1.0;
    let direction = match number % 9 {
        4 => Vector3::new(0.05, 0.0, -1.0),
        8 => Vector3::new(0.0, 0.05, 1.0),
        _ => Vector3::new(angle.sin(), -angle.cos().abs(), 0.4),
    };
    let arrow = (center, center + direction.normalize() * (1.6 * radius));
    Some(Fake {
        surface,
        branch,
        arrow,
        sphere: Sphere::new(center, radius)?,
    })
}

fn deproject(depth: &DepthImage, color: &ColorImage, camera: &Camera) -> PointCloud {
    let mut cloud = PointCloud::new();
    cloud.colors = Some(color.pixels.clone());
    for (i, reading) in depth.readings.iter().enumerate() {
        let (u, v) = ((i % depth.width) as f64, (i / depth.width) as f64);
        let z = if *reading == 0 {
            f64::NAN
        } else {
            f64::from(*reading) * camera.depth_scale
        };
        let p = camera.deproject(u, v, z);
        cloud.x.push(p.x as f32);
        cloud.y.push(p.y as f32);
        cloud.z.push(p.z as f32);
    }
    cloud
}
