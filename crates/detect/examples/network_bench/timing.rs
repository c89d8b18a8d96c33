//! What is measured of a network, and how: shared by the benchmarks of detectors and segmenters.

use pomona_network::RuntimeChoice;
use serde::Serialize;
use std::time::Instant;

/// What was measured, or why not.
#[derive(Serialize)]
pub(crate) struct Line {
    /// The network, or the job.
    pub(crate) name: String,
    pub(crate) runtime: String,
    pub(crate) threads: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) absent: Option<String>,
    /// Each round's time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) milliseconds: Vec<f64>,
    /// Each round's time on the processor, of all threads together: what a busy machine adds is not in it. Empty
    /// where the system does not tell.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) processor_milliseconds: Vec<f64>,
    /// What came out, for the frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) detections: Option<usize>,
    /// How often the network is run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) windows: Option<usize>,
    /// How far the probabilities are from those in the middle of the network's input, in the mean.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) mean_difference: Option<f64>,
}

impl Line {
    pub(crate) fn new(name: &str, runtime: &str, threads: usize) -> Self {
        Self {
            name: name.to_owned(),
            runtime: runtime.to_owned(),
            threads,
            absent: None,
            milliseconds: Vec::new(),
            processor_milliseconds: Vec::new(),
            detections: None,
            windows: None,
            mean_difference: None,
        }
    }

    pub(crate) fn record(&mut self, clock: &Clock) {
        self.milliseconds
            .push(clock.start.elapsed().as_secs_f64() * 1e3);
        let processor = processor_time().zip(clock.processor);
        self.processor_milliseconds
            .extend(processor.map(|(now, before)| now - before));
    }
}

/// When a run began.
pub(crate) struct Clock {
    start: Instant,
    processor: Option<f64>,
}

impl Clock {
    pub(crate) fn start() -> Self {
        let processor = processor_time();
        Self {
            start: Instant::now(),
            processor,
        }
    }
}

/// Milliseconds that this process's living threads have been on a processor, where Linux tells.
fn processor_time() -> Option<f64> {
    let mut nanoseconds = 0.0;
    for thread in std::fs::read_dir("/proc/self/task").ok()?.flatten() {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        nanoseconds += text.split(' ').next()?.parse::<f64>().ok()?;
    }
    Some(nanoseconds / 1e6)
}

pub(crate) const RUNTIMES: [(&str, RuntimeChoice); 2] = [
    ("onnxruntime", RuntimeChoice::OnnxRuntime),
    ("embedded", RuntimeChoice::Embedded),
];
