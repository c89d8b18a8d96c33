//! How long networks take in both runtimes: one line of JSON for each measurement, for `cargo xtask bench --detection`.
//!
//! `network_bench ROUNDS NAME=MODEL... [--frame IMAGE]`. Each round runs every network in every runtime once, on
//! one thread, so that what else the machine does meets all alike. The network `yolov3-tiny` of noise is always
//! among them. A frame is run as a detector runs it, tiled on two threads, with the first model given.

mod timing;

#[path = "../../../network/tests/network/onnx.rs"]
#[expect(
    dead_code,
    reason = "the tests of pomona-network write more kinds of networks"
)]
mod onnx;

use pomona_cloud::ColorImage;
use pomona_detect::{Detector, DetectorOptions};
use pomona_network::{ModelSource, Network, Port, Tensor, open_network};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use timing::{Clock, Line, RUNTIMES};

/// Side of the square that networks with an open size are fed, in pixels.
const SIDE: usize = 416;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let usage = "network_bench ROUNDS NAME=MODEL... [--frame IMAGE]";
    let rounds: usize = arguments.next().ok_or(usage)?.parse()?;
    let (mut models, mut frame) = (Vec::new(), None);
    while let Some(argument) = arguments.next() {
        if argument == "--frame" {
            frame = Some(PathBuf::from(arguments.next().ok_or(usage)?));
        } else {
            let (name, path) = argument.split_once('=').ok_or(usage)?;
            models.push((name.to_owned(), PathBuf::from(path)));
        }
    }
    let mut lines = networks(rounds, &models);
    lines.extend(frames(rounds, &models, frame.as_deref())?);
    for line in lines {
        println!("{}", serde_json::to_string(&line)?);
    }
    Ok(())
}

/// One image through every network, in turns.
fn networks(rounds: usize, models: &[(String, PathBuf)]) -> Vec<Line> {
    let mut sources: Vec<(&str, ModelSource)> = models
        .iter()
        .map(|(name, path)| (name.as_str(), ModelSource::File(path.clone())))
        .collect();
    let bytes: &'static [u8] = onnx::yolov3_tiny(SIDE as i64, 80).to_bytes().leak();
    let tiny = ModelSource::BuiltIn {
        name: "yolov3-tiny",
        bytes,
    };
    sources.push(("yolov3-tiny of noise", tiny));

    let mut lines = Vec::new();
    let mut runs: Vec<(Box<dyn Network>, Vec<Tensor>, usize)> = Vec::new();
    for (name, source) in &sources {
        for (runtime, choice) in &RUNTIMES {
            let mut line = Line::new(name, runtime, 1);
            match open_network(source, choice, 1) {
                Ok(network) => {
                    let inputs = noise(network.as_ref());
                    runs.push((network, inputs, lines.len()));
                }
                Err(error) => line.absent = Some(error.to_string()),
            }
            lines.push(line);
        }
    }
    // The first two rounds fill caches and are not counted.
    for round in 0..rounds + 2 {
        for (network, inputs, index) in &runs {
            let clock = Clock::start();
            match network.run(inputs) {
                Ok(_) if round >= 2 => lines[*index].record(&clock),
                Ok(_) => (),
                Err(error) => lines[*index].absent = Some(error.to_string()),
            }
        }
    }
    lines
}

/// A whole frame, tiled on two threads, in both runtimes in turns.
fn frames(
    rounds: usize,
    models: &[(String, PathBuf)],
    frame: Option<&Path>,
) -> Result<Vec<Line>, Box<dyn std::error::Error>> {
    let Some((name, model)) = models.iter().find(|(_, path)| path.exists()) else {
        return Ok(Vec::new());
    };
    let image = match frame {
        Some(path) => ColorImage::read(path)?,
        None => speckled(1920, 1080),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build()?;
    let name = format!("{}x{} frame, tiled, {name}", image.width, image.height);
    let mut lines = Vec::new();
    let mut detectors: Vec<(Box<dyn Detector>, usize)> = Vec::new();
    for (runtime, choice) in RUNTIMES {
        let mut line = Line::new(&name, runtime, 2);
        let options = DetectorOptions::default().with(|o| {
            o.model = Some(model.clone());
            o.runtime = choice;
        });
        match options.open() {
            Ok(detector) => detectors.push((detector, lines.len())),
            Err(error) => line.absent = Some(error.to_string()),
        }
        lines.push(line);
    }
    for round in 0..=rounds {
        for (detector, index) in &detectors {
            let clock = Clock::start();
            match pool.install(|| detector.detect(&image)) {
                Ok(found) if round >= 1 => {
                    lines[*index].record(&clock);
                    lines[*index].detections = Some(found.len());
                }
                Ok(_) => (),
                Err(error) => lines[*index].absent = Some(error.to_string()),
            }
        }
    }
    Ok(lines)
}

/// Inputs as of an image, 0 to 1.
fn noise(network: &dyn Network) -> Vec<Tensor> {
    let mut noise = onnx::Noise(1);
    let fill = |port: &Port| {
        let open = |index: usize| if index == 0 { 1 } else { SIDE };
        let axes = port.shape.iter().enumerate();
        let shape: Vec<usize> = axes
            .map(|(index, axis)| axis.unwrap_or_else(|| open(index)))
            .collect();
        let data = (0..shape.iter().product()).map(|_| noise.even()).collect();
        Tensor {
            name: port.name.clone(),
            shape,
            data,
        }
    };
    network.inputs().iter().map(fill).collect()
}

/// An image of noise, for a machine without a recorded one.
fn speckled(width: usize, height: usize) -> ColorImage {
    let mut noise = onnx::Noise(2);
    let mut image = ColorImage::filled(width, height, [0; 3]);
    for pixel in &mut image.pixels {
        *pixel = [0; 3].map(|_: u8| (noise.even() * 255.0) as u8);
    }
    image
}
