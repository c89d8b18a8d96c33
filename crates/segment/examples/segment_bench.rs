//! How long the built-in segmenter takes in both runtimes: one line of JSON for each measurement, for
//! `cargo xtask bench --segmentation`.
//!
//! `segment_bench ROUNDS [FRAME]`. Each round runs each job in every runtime once, so that what else the machine does
//! meets all alike: a window of the network's size on one thread; and, of a frame with boxes, the whole image and the
//! windows of 3 radii about its apples, on two threads.

#[path = "../../detect/examples/network_bench/timing.rs"]
mod timing;

use pomona_cloud::{ColorImage, Frame, PixelBox, PixelWindow};
use pomona_segment::{Segmenter, SegmenterOptions};
use std::path::Path;
use std::process::ExitCode;
use timing::{Clock, Line, RUNTIMES};

/// Side of the network's input, pixels.
const SIDE: usize = 416;

/// What is run.
struct Job {
    name: String,
    threads: usize,
    image: ColorImage,
    windows: Vec<PixelWindow>,
}

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
    let rounds: usize = arguments
        .next()
        .ok_or("segment_bench ROUNDS [FRAME]")?
        .parse()?;
    let jobs = jobs(arguments.next().as_ref().map(Path::new))?;
    let mut lines = Vec::new();
    let mut runs: Vec<(Box<dyn Segmenter>, &Job, rayon::ThreadPool, usize)> = Vec::new();
    for job in &jobs {
        for (runtime, choice) in RUNTIMES {
            let mut line = Line::new(&job.name, runtime, job.threads);
            let mut options = SegmenterOptions::default();
            options.runtime = choice;
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(job.threads)
                .build()?;
            match options.open() {
                Ok(segmenter) => runs.push((segmenter, job, pool, lines.len())),
                Err(error) => line.absent = Some(error.to_string()),
            }
            lines.push(line);
        }
    }
    // The first round fills caches and is not counted.
    for round in 0..=rounds {
        for (segmenter, job, pool, index) in &runs {
            let clock = Clock::start();
            match pool.install(|| segmenter.segment_windows(&job.image, &job.windows)) {
                Ok(_) if round >= 1 => lines[*index].record(&clock),
                Ok(_) => (),
                Err(error) => lines[*index].absent = Some(error.to_string()),
            }
        }
    }
    for line in lines {
        println!("{}", serde_json::to_string(&line)?);
    }
    Ok(())
}

fn jobs(frame: Option<&Path>) -> Result<Vec<Job>, Box<dyn std::error::Error>> {
    let whole = |image: &ColorImage| vec![PixelWindow::full(image.width, image.height)];
    let (image, boxes) = match frame {
        Some(folder) => {
            let frame = Frame::read(folder)?;
            (frame.color, frame.boxes.unwrap_or_default())
        }
        None => (ColorImage::filled(1920, 1080, [90, 110, 70]), Vec::new()),
    };
    let mut one = ColorImage::filled(SIDE, SIDE, [0; 3]);
    for (v, row) in one.pixels.chunks_exact_mut(SIDE).enumerate() {
        row.copy_from_slice(&image.pixels[v * image.width..v * image.width + SIDE]);
    }
    let size = format!("{}x{}", image.width, image.height);
    let mut jobs = vec![
        Job {
            name: format!("a window of {SIDE}x{SIDE}"),
            threads: 1,
            windows: whole(&one),
            image: one,
        },
        Job {
            name: format!("a frame of {size}"),
            threads: 2,
            windows: whole(&image),
            image: image.clone(),
        },
    ];
    if !boxes.is_empty() {
        jobs.push(Job {
            name: format!("windows about {} apples of it", boxes.len()),
            threads: 2,
            windows: boxes.iter().map(|b| about(b, &image)).collect(),
            image,
        });
    }
    Ok(jobs)
}

/// Three radii about an apple's box, inside the image.
fn about(bounds: &PixelBox, image: &ColorImage) -> PixelWindow {
    let radius = (bounds.x_max - bounds.x_min).max(bounds.y_max - bounds.y_min) / 2.0;
    let range = |low: f64, high: f64, size: usize| {
        let middle = f64::midpoint(low, high);
        let start = (middle - 3.0 * radius).clamp(0.0, size as f64 - 1.0) as usize;
        let end = (middle + 3.0 * radius)
            .ceil()
            .clamp(start as f64 + 1.0, size as f64) as usize;
        (start, end)
    };
    let (x0, x1) = range(bounds.x_min, bounds.x_max, image.width);
    let (y0, y1) = range(bounds.y_min, bounds.y_max, image.height);
    PixelWindow { x0, y0, x1, y1 }
}
