//! The clouds that all engines fit, what is asked of them, and what is true.

use anyhow::{Context, Result};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Two clouds of one apple and the truth, as `peer_bench export` wrote them.
#[derive(Deserialize)]
pub(super) struct Cloud {
    pub suite: String,
    #[serde(rename = "box")]
    crop: PathBuf,
    box_points: usize,
    shell: PathBuf,
    shell_points: usize,
    center: [f64; 3],
    radius: f64,
    branch: Branch,
}

#[derive(Deserialize)]
struct Branch {
    direction: [f64; 3],
}

#[derive(Deserialize)]
struct Clouds {
    clouds: Vec<Cloud>,
}

/// What is fitted.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Primitive {
    /// The apple, in the points of its box.
    Sphere,
    /// The branch, in the points of the shell about the apple.
    Line,
}

/// When the search ends.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Mode {
    /// After a fixed number of hypotheses.
    Full,
    /// By the engine's own rule, at a confidence of 0.99 where it can be set.
    Adaptive,
}

const CONFIDENCE: f64 = 0.99;

/// Reads `clouds.json`; paths become absolute.
pub(super) fn read(folder: &Path) -> Result<Vec<Cloud>> {
    let path = folder.join("clouds.json");
    let what = || format!("cannot read {}", path.display());
    let text = std::fs::read_to_string(&path).with_context(what)?;
    let mut clouds = serde_json::from_str::<Clouds>(&text)
        .with_context(what)?
        .clouds;
    for cloud in &mut clouds {
        cloud.crop = folder.join(&cloud.crop);
        cloud.shell = folder.join(&cloud.shell);
    }
    Ok(clouds)
}

impl Primitive {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Line => "line",
        }
    }

    /// As many as the method of Gao et al. 2022 draws (doi 10.3390/agriculture12081170).
    pub(super) fn hypotheses(self) -> u32 {
        match self {
            Self::Sphere => 1000,
            Self::Line => 3000,
        }
    }

    /// Largest distance of an inlier in metres: three times the noise for the sphere, the paper's 5 mm for the line.
    fn threshold(self) -> f64 {
        match self {
            Self::Sphere => 0.003,
            Self::Line => 0.005,
        }
    }

    pub(super) fn error_name(self) -> &'static str {
        match self {
            Self::Sphere => "centre off, mm",
            Self::Line => "axis off, deg",
        }
    }
}

impl Cloud {
    pub(super) fn points(&self, primitive: Primitive) -> usize {
        match primitive {
            Primitive::Sphere => self.box_points,
            Primitive::Line => self.shell_points,
        }
    }

    /// A job as `xtask/peers/README.md` describes it.
    pub(super) fn job(&self, primitive: Primitive, mode: Mode, seed: u32) -> String {
        let (file, bounds) = match primitive {
            Primitive::Sphere => (&self.crop, [0.015, 0.06]),
            Primitive::Line => (&self.shell, [0.5 * self.radius, 1.5 * self.radius]),
        };
        let confidence = match mode {
            Mode::Full => 0.0,
            Mode::Adaptive => CONFIDENCE,
        };
        let mut job = format!(
            "{} {} {} {confidence} {} {} {} {seed}",
            primitive.name(),
            file.display(),
            primitive.hypotheses(),
            primitive.threshold(),
            bounds[0],
            bounds[1],
        );
        if primitive == Primitive::Line {
            job.extend(self.center.map(|coordinate| format!(" {coordinate}")));
        }
        job
    }

    /// Millimetres between the centres, or degrees between the axes.
    ///
    /// `None` where the model has not as many numbers as its primitive, or one that is not finite.
    pub(super) fn error(&self, primitive: Primitive, model: &[f64]) -> Option<f64> {
        let error = match (primitive, model) {
            (Primitive::Sphere, &[x, y, z, _]) => {
                let [a, b, c] = self.center;
                (x - a).hypot(y - b).hypot(z - c) * 1e3
            }
            (Primitive::Line, &[_, _, _, x, y, z]) => {
                let [a, b, c] = self.branch.direction;
                let cross = (y * c - z * b).hypot(z * a - x * c).hypot(x * b - y * a);
                cross.atan2((x * a + y * b + z * c).abs()).to_degrees()
            }
            _ => return None,
        };
        error.is_finite().then_some(error)
    }
}

#[cfg(test)]
impl Cloud {
    /// An apple of 40 mm under a branch along x.
    pub(super) fn example() -> Self {
        Self {
            suite: "lab15".into(),
            crop: "box.f32".into(),
            box_points: 500,
            shell: "shell.f32".into(),
            shell_points: 300,
            center: [0.0, 0.0, 0.8],
            radius: 0.04,
            branch: Branch {
                direction: [1.0, 0.0, 0.0],
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_distances_and_angles() {
        let cloud = Cloud::example();
        let off = cloud
            .error(Primitive::Sphere, &[0.003, 0.004, 0.8, 0.04])
            .unwrap();
        assert!((off - 5.0).abs() < 1e-9);
        // A line has no sense of direction.
        let off = cloud
            .error(Primitive::Line, &[0.0, 0.0, 0.0, -2.0, 2.0, 0.0])
            .unwrap();
        assert!((off - 45.0).abs() < 1e-9);
        assert_eq!(cloud.error(Primitive::Sphere, &[]), None);
        assert_eq!(
            cloud.error(Primitive::Sphere, &[f64::NAN, 0.0, 0.0, 1.0]),
            None
        );
    }

    #[test]
    fn jobs_are_written_as_described() {
        let cloud = Cloud::example();
        assert_eq!(
            cloud.job(Primitive::Line, Mode::Adaptive, 7),
            "line shell.f32 3000 0.99 0.005 0.02 0.06 7 0 0 0.8"
        );
        assert_eq!(
            cloud.job(Primitive::Sphere, Mode::Full, 7),
            "sphere box.f32 1000 0 0.003 0.015 0.06 7"
        );
    }
}
