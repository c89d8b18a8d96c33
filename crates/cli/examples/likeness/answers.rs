//! What the methods do.

use crate::source::Source;
use pomona::{Config, Method, Picker};
use pomona_cloud::{PixelBox, PixelWindow};
use pomona_evaluate::{
    PickMethod, RealFrame, RealOptions, RealResult, RealRow, Verdict, WoodSeen, measure_real,
};
use pomona_segment::CloseUps;
use pomona_statistics::{inverse_cdf, median};
use std::error::Error;
use std::path::PathBuf;

/// How far about an apple wood is told, half sides of its box: as `pomona pick` does.
const REACH: f64 = 3.6;

struct Named {
    name: String,
    picker: Picker,
}

impl PickMethod for Named {
    fn name(&self) -> &str {
        &self.name
    }

    fn answer(
        &self,
        frame: &pomona::CheckedFrame<'_>,
        seed: u64,
    ) -> Result<pomona::FrameAnswer, pomona::PickError> {
        self.picker.pick(frame, seed, None)
    }
}

pub(crate) fn rows(
    source: &mut Source,
    close_ups: &CloseUps,
    variants: &[PathBuf],
) -> Result<Vec<(String, String)>, Box<dyn Error>> {
    let mut methods = Vec::new();
    for method in [Method::Paper, Method::Robust] {
        methods.push(Named {
            name: method.name().to_owned(),
            picker: Picker::new(Config::default().with(|c| c.method = method))?,
        });
    }
    for path in variants {
        methods.push(Named {
            name: path
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            picker: Picker::new(Config::read(path)?)?,
        });
    }
    let methods: Vec<&dyn PickMethod> = methods.iter().map(|m| m as &dyn PickMethod).collect();
    let mut options = RealOptions::default();
    options.apples.clone_from(&source.apples);
    let mut rows = Vec::new();
    let report = measure_real(&source.frames, &methods, &options, &|| ())?;
    for result in &report.results {
        rows.extend(of(source, result, "depth alone"));
        rows.push((
            format!("{}: bias of the radius", result.method),
            radius_bias(source, result),
        ));
    }
    for frame in &mut source.frames {
        let windows = windows(frame);
        frame.wood = Some(close_ups.wood(&frame.frame.color, &windows)?);
    }
    let report = measure_real(&source.frames, &methods[1..], &options, &|| ())?;
    for result in &report.results {
        rows.extend(of(source, result, "with colour"));
    }
    Ok(rows)
}

fn windows(frame: &RealFrame) -> Vec<PixelWindow> {
    let (width, height) = (frame.frame.color.width, frame.frame.color.height);
    let window = |b: &PixelBox| {
        let (x, y) = (0.5 * (b.x_min + b.x_max), 0.5 * (b.y_min + b.y_max));
        let reach = REACH * 0.5 * (b.x_max - b.x_min).max(b.y_max - b.y_min);
        PixelWindow::clamped(x - reach, y - reach, x + reach, y + reach, width, height)
    };
    let windows = frame.boxes().iter().map(window);
    windows.filter(|window| !window.is_empty()).collect()
}

/// Answers of apples whose nearest wood is seen, and the angles in space where the truth is known.
fn of(source: &Source, result: &RealResult, input: &str) -> Vec<(String, String)> {
    let seen: Vec<&RealRow> = result
        .apples
        .iter()
        .filter(|row| row.wood == WoodSeen::Seen)
        .collect();
    let count = |verdict: Verdict| seen.iter().filter(|row| row.verdict == verdict).count();
    let (right, elsewhere) = (count(Verdict::Right), count(Verdict::Elsewhere));
    let answered = right + elsewhere;
    let percent = |part: usize, all: usize| 100.0 * part as f64 / all.max(1) as f64;
    let name = format!("{}, {input}: ", result.method);
    let mut rows = vec![(
        format!("{name}answered, right of these"),
        format!(
            "{:.0} % of {}, {:.0} %",
            percent(answered, seen.len()),
            seen.len(),
            percent(right, answered)
        ),
    )];
    let mut angles: Vec<f64> = result
        .apples
        .iter()
        .filter_map(|row| angle_deg(source, row))
        .collect();
    if !angles.is_empty() {
        let all = angles.len();
        let beyond = |limit: f64| angles.iter().filter(|a| **a > limit).count();
        let (within, far) = (all - beyond(20.0), beyond(50.0));
        let mean = angles.iter().sum::<f64>() / all as f64;
        let half = inverse_cdf(&mut angles, 0.5).unwrap_or(f64::NAN);
        rows.push((
            format!("{name}angle to the truth, mean and median; within 20°, beyond 50°"),
            format!(
                "{mean:.1}°, {half:.1}°; {:.0} %, {:.0} %",
                percent(within, all),
                percent(far, all)
            ),
        ));
    }
    rows
}

/// The angle between an answer and the truth.
fn angle_deg(source: &Source, row: &RealRow) -> Option<f64> {
    let truth = source
        .frames
        .iter()
        .zip(&source.truths)
        .find(|(frame, _)| frame.frame.id == row.frame)?
        .1;
    let apple = truth
        .apples
        .iter()
        .find(|apple| apple.bounds.name == row.box_name)?;
    let (direction, foot, center) = (apple.direction?, row.foot?, row.center?);
    let way: [f64; 3] = std::array::from_fn(|i| foot[i] - center[i]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    let dot: f64 = way.iter().zip(direction).map(|(a, b)| a * b).sum();
    Some((dot / length).clamp(-1.0, 1.0).acos().to_degrees())
}

/// The median of fitted less true radius, shares of the true one.
fn radius_bias(source: &Source, result: &RealResult) -> String {
    let biases = result.apples.iter().filter_map(|row| {
        let truth = source
            .radii
            .get(&(row.frame.clone(), row.box_name.clone()))?;
        Some(row.radius? / truth - 1.0)
    });
    let mut biases: Vec<f64> = biases.collect();
    median(&mut biases).map_or(String::new(), |bias| format!("{:+.0} %", 100.0 * bias))
}
