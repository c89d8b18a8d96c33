use crate::program::Program;
use crate::workspace::root;
use anyhow::{Context, Result, ensure};
use serde_json::Value;
use std::path::Path;
use std::time::Instant;
use xtask_gate::{Finding, RealLimits, judge};

/// Measures methods on real frames, with the files in `folder`, and holds the figures against their limits; nothing where
/// the frames are not at hand.
pub(super) fn findings(program: &Program, run: &RealLimits, folder: &Path) -> Result<Vec<Finding>> {
    let missing = run.frames.iter().find(|frame| !root().join(frame).is_dir());
    if let Some(missing) = missing {
        println!("{}: skipped, there is no {}", run.name, missing.display());
        return Ok(Vec::new());
    }
    let start = Instant::now();
    let out = folder.join(&run.name);
    let mut command = program.command();
    command
        .args(["evaluate", "--real"])
        .args(&run.frames)
        .arg("--strokes")
        .arg(&run.strokes)
        .arg("--apples")
        .arg(&run.apples)
        .args(["--segmenter", &run.segmenter])
        .args(["--repeats", &run.repeats.to_string()])
        .arg("--out")
        .arg(&out);
    let variants: Vec<String> = run.variants.iter().map(|path| stem(path)).collect();
    for path in &run.variants {
        command.arg("--variant").arg(path);
    }
    for own in run
        .methods
        .iter()
        .filter(|own| !variants.contains(&own.method))
    {
        command.args(["--method", &own.method]);
    }
    let ended = command.output().context("cannot start the program")?;
    let errors = String::from_utf8_lossy(&ended.stderr);
    ensure!(
        ended.status.success(),
        "{}: {}",
        run.name,
        errors.trim_end()
    );
    let path = root().join(out).join("real.json");
    let what = || path.display().to_string();
    let report: Value = serde_json::from_str(&std::fs::read_to_string(&path).with_context(what)?)
        .with_context(what)?;
    println!("{}: {:.1} s", run.name, start.elapsed().as_secs_f64());
    let mut findings = Vec::new();
    for own in &run.methods {
        let results = report.get("results").and_then(Value::as_array);
        let result = results
            .into_iter()
            .flatten()
            .find(|entry| entry.get("method").and_then(Value::as_str) == Some(&own.method));
        let result = result.with_context(|| format!("no result of {}", own.id()))?;
        findings.extend(judge(result, own, None));
    }
    Ok(findings)
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}
