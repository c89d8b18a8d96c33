//! Errors of single frames and of their fusion on rendered orchards from three sides.
//!
//! `cargo run --release -p pomona-fusion --example fusion_table -- [FIRST SEED] [SCENES]`

#[path = "../tests/fusion/orchard_views.rs"]
mod orchard_views;

use nalgebra::Vector3;
use orchard_views::{Views, views};
use pomona_fusion::{FusedApple, FusionConfig, PosedAnswer, fuse};
use pomona_transforms::{Direction, RobotFrame};

/// Errors of the apples that several frames show.
#[derive(Default)]
struct Errors {
    centers: Vec<f64>,
    directions: Vec<f64>,
}

impl Errors {
    fn print(&self, name: &str) {
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len().max(1) as f64;
        let off = self.directions.iter().filter(|d| **d > 20.0).count();
        println!(
            "{name}: centre {:.2} mm (n {}), direction {:.2} deg (n {}), over 20 deg: {off}",
            mean(&self.centers) * 1e3,
            self.centers.len(),
            mean(&self.directions),
            self.directions.len()
        );
    }

    fn add(
        &mut self,
        views: &Views,
        apple: usize,
        center: Vector3<f64>,
        direction: Option<Direction<RobotFrame>>,
    ) {
        self.centers.push((center - views.centers[apple]).norm());
        if let Some((d, truth)) = direction.zip(views.directions[apple]) {
            self.directions.push(d.vector().angle(&truth).to_degrees());
        }
    }
}

fn nearest(views: &Views, apple: &FusedApple) -> Option<usize> {
    let center = apple.center.position.point().coords;
    (0..views.centers.len())
        .filter(|&i| (views.centers[i] - center).norm() < 0.03)
        .min_by(|&a, &b| {
            let distance = |i: usize| (views.centers[i] - center).norm();
            distance(a).total_cmp(&distance(b))
        })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let first: u64 = arguments.next().map_or(Ok(4000), |a| a.parse())?;
    let scenes: u64 = arguments.next().map_or(Ok(40), |a| a.parse())?;
    let (mut single, mut fused) = (Errors::default(), Errors::default());
    let (mut moved, mut apples, mut shared, mut contradictions) = (0, 0, 0, 0);
    let mut split = 0;
    for seed in first..first + scenes {
        let views = views(seed);
        let posed: Vec<PosedAnswer<'_>> = views
            .frames
            .iter()
            .map(|(answer, robot_from_camera)| PosedAnswer::new(answer, robot_from_camera))
            .collect();
        let tree = fuse(&posed, &FusionConfig::default())?;
        let mut known = vec![0; views.centers.len()];
        for apple in &tree.apples {
            apples += 1;
            if let Some(movement) = &apple.movement {
                moved += 1;
                println!(
                    "scene {seed}: moved {:.1} ± {:.1} mm: {}",
                    movement.by.norm() * 1e3,
                    movement.sd_m * 1e3,
                    apple.reason
                );
                for s in &apple.observations {
                    let own = views.frames[s.frame].0.apples[s.pick].apple.as_ref();
                    let radius = own.map_or(0.0, |a| a.radius_m);
                    let visible = own.and_then(|a| a.visible_share).unwrap_or(0.0);
                    let sd = own.and_then(|a| a.radius_sd_m).unwrap_or(0.0);
                    println!(
                        "  frame {}: radius {radius:.4} ± {sd:.4}, visible {visible:.2}",
                        s.frame
                    );
                }
            }
            contradictions +=
                usize::from(apple.status == pomona_fusion::FusedStatus::Contradiction);
            let Some(truth) = nearest(&views, apple) else {
                continue;
            };
            known[truth] += 1;
            if apple.observations.len() < 2 {
                continue;
            }
            shared += 1;
            fused.add(
                &views,
                truth,
                apple.center.position.point().coords,
                apple.direction.map(|d| d.direction),
            );
            for s in &apple.observations {
                let (answer, pose) = &views.frames[s.frame];
                let own = &answer.apples[s.pick];
                let Some(apple) = &own.apple else { continue };
                let center = pose.transform.position(&apple.center).point();
                let direction = own
                    .pick
                    .map(|pick| pose.transform.direction(&pick.direction));
                single.add(&views, truth, center.coords, direction);
            }
        }
        split += known.iter().filter(|n| **n > 1).count();
    }
    single.print("single");
    fused.print("fused ");
    println!(
        "{apples} apples, {shared} of them shared; false moved {moved}, split {split}, contradictions {contradictions}"
    );
    Ok(())
}
