//! Fitted radii against measured diameters.

use super::arguments::EvaluateArguments;
use super::calipers_text;
use super::results::{REPORT, json};
use crate::terminal::Terminal;
use pomona_cloud::Frame;
use pomona_evaluate::{CALIPER_SCHEMA, PickMethod, caliper_page, measure_calipers, read_calipers};
use std::path::Path;

const CALIPERS: &str = "calipers.json";

pub(super) fn run(
    arguments: &EvaluateArguments,
    calipers: &Path,
    methods: &[&dyn PickMethod],
    terminal: Terminal,
) -> anyhow::Result<()> {
    let output = arguments
        .results
        .claim(CALIPERS, CALIPER_SCHEMA, |_| false)?;
    let calipers = read_calipers(calipers)?;
    let frames: Vec<Frame> = arguments
        .subjects
        .iter()
        .map(Frame::read)
        .collect::<Result<_, _>>()?;
    let report = measure_calipers(&frames, &calipers, methods, arguments.seed)?;
    let files = output.stage()?;
    files.write_text(CALIPERS, &json(&report)?)?;
    files.write_text(REPORT, &caliper_page(&report)?)?;
    files.publish()?;
    arguments
        .results
        .print(&report, &calipers_text::tables(&report, terminal))
}
