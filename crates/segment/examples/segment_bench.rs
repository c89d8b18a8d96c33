//! How long the built-in segmenter takes in both runtimes: one line of JSON for each measurement, for
//! `cargo xtask bench --segmentation`.
//!
//! `segment_bench ROUNDS [FRAME]`. Each round runs each job in every runtime once, so that what else the machine does
//! meets all alike: a window of the network's size on one thread; and, of a frame with boxes, the whole image, the
//! windows of 3 radii about its apples, and the same as places, on two threads. After the rounds it measures once how
//! much the probability of wood depends on where the tiles and the places lie in the network's input.

#[path = "../../detect/examples/network_bench/timing.rs"]
mod timing;

use pomona_cloud::{ColorImage, Frame, PixelBox, PixelWindow};
use pomona_segment::{
    OnnxSegmenter, Role, SegmentError, Segmentation, Segmenter, SegmenterOptions,
};
use std::path::Path;
use std::process::ExitCode;
use timing::{Clock, Line, RUNTIMES};

/// Side of the network's input, pixels.
const SIDE: usize = 416;

/// Pixels from the middle of one window to that of the next where each pixel is seen in the middle of one.
const STEP: usize = SIDE / 4;

/// What is run.
struct Job {
    name: String,
    threads: usize,
    image: ColorImage,
    windows: Vec<PixelWindow>,
    /// Whether they are asked for as places.
    are_places: bool,
}

impl Job {
    fn run(&self, segmenter: &OnnxSegmenter) -> Result<Segmentation, SegmentError> {
        if self.are_places {
            segmenter.segment_places(&self.image, &self.windows)
        } else {
            segmenter.segment_windows(&self.image, &self.windows)
        }
    }

    fn runs(&self, segmenter: &OnnxSegmenter) -> usize {
        let size = [self.image.width, self.image.height];
        if self.are_places {
            segmenter.runs_for_places(size, &self.windows)
        } else {
            segmenter.runs_for_windows(size, &self.windows)
        }
    }
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
    let mut runs: Vec<(OnnxSegmenter, &Job, rayon::ThreadPool, usize)> = Vec::new();
    for job in &jobs {
        for (runtime, choice) in RUNTIMES {
            let mut line = Line::new(&job.name, runtime, job.threads);
            let mut options = SegmenterOptions::default();
            options.runtime = choice;
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(job.threads)
                .build()?;
            match options.open_at(1.0) {
                Ok(segmenter) => {
                    line.windows = Some(job.runs(&segmenter));
                    runs.push((segmenter, job, pool, lines.len()));
                }
                Err(error) => line.absent = Some(error.to_string()),
            }
            lines.push(line);
        }
    }
    // The first round fills caches and is not counted.
    for round in 0..=rounds {
        for (segmenter, job, pool, index) in &runs {
            let clock = Clock::start();
            match pool.install(|| job.run(segmenter)) {
                Ok(_) if round >= 1 => lines[*index].record(&clock),
                Ok(_) => (),
                Err(error) => lines[*index].absent = Some(error.to_string()),
            }
        }
    }
    if let Some((segmenter, job, ..)) = runs.iter().find(|(_, job, ..)| job.threads > 1) {
        let reference = in_the_middle(segmenter, &job.image)?;
        for (_, job, _, index) in &runs {
            if job.image.width == reference.width && job.image.height == reference.height {
                let seen = job.run(segmenter)?.role(Role::Wood);
                lines[*index].mean_difference =
                    Some(reference.mean_difference(&seen, &job.windows));
            }
        }
    }
    for line in lines {
        println!("{}", serde_json::to_string(&line)?);
    }
    Ok(())
}

/// Probabilities of wood.
struct Wood {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

/// Those of an image, each pixel's from the window whose middle is nearest to it.
fn in_the_middle(segmenter: &OnnxSegmenter, image: &ColorImage) -> Result<Wood, SegmentError> {
    let (width, height) = (image.width, image.height);
    // The middle that the pixels of a step belong to, and where its window starts.
    let start = |middle: usize, size: usize| middle.saturating_sub(SIDE / 2).min(size - SIDE);
    let mut values = vec![f32::NAN; width * height];
    for y in (0..height).step_by(STEP) {
        for x in (0..width).step_by(STEP) {
            let (x0, y0) = (start(x + STEP / 2, width), start(y + STEP / 2, height));
            let mut window = ColorImage::filled(SIDE, SIDE, [0; 3]);
            for (v, row) in window.pixels.chunks_exact_mut(SIDE).enumerate() {
                row.copy_from_slice(&image.pixels[(y0 + v) * width + x0..][..SIDE]);
            }
            let seen = segmenter.segment(&window)?.role(Role::Wood);
            let columns = STEP.min(width - x);
            for v in y..(y + STEP).min(height) {
                values[v * width + x..][..columns]
                    .copy_from_slice(&seen[(v - y0) * SIDE + x - x0..][..columns]);
            }
        }
    }
    Ok(Wood {
        width,
        height,
        values,
    })
}

impl Wood {
    /// The mean difference of other probabilities from these, over the pixels of the windows.
    fn mean_difference(&self, other: &[f32], windows: &[PixelWindow]) -> f64 {
        let mut counts = vec![false; self.values.len()];
        for window in windows {
            for v in window.y0..window.y1 {
                counts[v * self.width + window.x0..v * self.width + window.x1].fill(true);
            }
        }
        let pairs = self.values.iter().zip(other).zip(&counts);
        let differences: Vec<f64> = pairs
            .filter(|(_, counts)| **counts)
            .map(|((a, b), _)| f64::from((a - b).abs()))
            .collect();
        differences.iter().sum::<f64>() / differences.len().max(1) as f64
    }
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
            are_places: false,
        },
        Job {
            name: format!("a frame of {size}"),
            threads: 2,
            windows: whole(&image),
            image: image.clone(),
            are_places: false,
        },
    ];
    if !boxes.is_empty() {
        let windows: Vec<PixelWindow> = boxes.iter().map(|b| about(b, &image)).collect();
        for (kind, are_places) in [("windows", false), ("places", true)] {
            jobs.push(Job {
                name: format!("{kind} about {} apples of it", boxes.len()),
                threads: 2,
                windows: windows.clone(),
                image: image.clone(),
                are_places,
            });
        }
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
