//! Clouds of synthetic apples as plain files, with the truth beside them.

use nalgebra::Point3;
use pomona_cloud::{DepthPoints, PixelWindow};
use pomona_scenes::{AppleTruth, Scene, Suite};
use serde_json::{Value, json};
use std::error::Error;
use std::fs;
use std::path::Path;

/// The branch is sought between these many radii from the centre (Gao et al. 2022, section 2.2.4,
/// doi 10.3390/agriculture12081170).
const SHELL: std::ops::RangeInclusive<f64> = 1.2..=3.0;

/// The first scenes of a suite.
pub(crate) struct Choice {
    suite: Suite,
    count: usize,
}

impl Choice {
    /// Reads `SUITE=COUNT`.
    pub(crate) fn parse(text: &str) -> Result<Self, Box<dyn Error>> {
        let (name, count) = text
            .split_once('=')
            .ok_or_else(|| format!("'{text}': give SUITE=COUNT"))?;
        Ok(Self {
            suite: Suite::named(name)?,
            count: count.parse()?,
        })
    }
}

/// Writes two clouds for each target apple whose branch is known, and `clouds.json`, which names them.
pub(crate) fn export(folder: &Path, choices: &[Choice]) -> Result<(), Box<dyn Error>> {
    let mut clouds = Vec::new();
    for choice in choices {
        let suite = choice.suite.name();
        fs::create_dir_all(folder.join(suite))?;
        for case in choice.suite.cases_to(choice.count) {
            let scene = case.scene();
            let targets = scene.truth.apples.iter();
            for (number, apple) in targets.enumerate().filter(|(_, a)| a.target != Some(false)) {
                let stem = format!("{suite}/{}-{number}", case.name);
                clouds.extend(export_apple(folder, suite, &stem, &scene, apple)?);
            }
        }
    }
    let text = serde_json::to_string_pretty(&json!({ "clouds": clouds }))?;
    fs::write(folder.join("clouds.json"), text)?;
    Ok(())
}

fn export_apple(
    folder: &Path,
    suite: &str,
    stem: &str,
    scene: &Scene,
    apple: &AppleTruth,
) -> Result<Option<Value>, Box<dyn Error>> {
    let Some(branch) = &apple.branch else {
        return Ok(None);
    };
    let frame = &scene.frame;
    let (width, height) = (frame.depth.width, frame.depth.height);
    let b = &apple.bounds;
    let mut points = DepthPoints::new();

    let window = PixelWindow::clamped(b.x_min, b.y_min, b.x_max, b.y_max, width, height);
    points.fill(&frame.depth, &frame.camera, window)?;
    let crop = format!("{stem}-box.f32");
    fs::write(folder.join(&crop), bytes(&points))?;
    let crop_points = points.len();

    points.fill(
        &frame.depth,
        &frame.camera,
        PixelWindow::full(width, height),
    )?;
    let center = Point3::from(apple.center);
    points.retain(|p| SHELL.contains(&((p - center).norm() / apple.radius)));
    let shell = format!("{stem}-shell.f32");
    fs::write(folder.join(&shell), bytes(&points))?;

    Ok(Some(json!({
        "suite": suite,
        "box": crop, "box_points": crop_points,
        "shell": shell, "shell_points": points.len(),
        "center": apple.center, "radius": apple.radius,
        "branch": { "point": branch.point, "direction": branch.direction },
    })))
}

/// x y z of each point, little-endian.
fn bytes(points: &DepthPoints) -> Vec<u8> {
    let coordinates = points.x.iter().zip(&points.y).zip(&points.z);
    coordinates
        .flat_map(|((x, y), z)| [x, y, z].map(|c| c.to_le_bytes()))
        .flatten()
        .collect()
}
