//! Our own benchmarks, with the accuracy that each prints beside its time.

use crate::workspace::{Package, Workspace, cargo};
use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::{
    collections::BTreeMap,
    fs,
    io::{BufRead, BufReader},
    path::Path,
    process::Stdio,
    time::SystemTime,
};

/// Runs every benchmark of the workspace, or those whose name holds `filter`, and prints one table.
pub(super) fn run(workspace: &Workspace, filter: Option<&str>) -> Result<()> {
    let start = SystemTime::now();
    let results = workspace.target_directory.join("criterion");
    let mut accuracy = BTreeMap::new();
    for package in &workspace.packages {
        for bench in package
            .targets
            .iter()
            .filter(|target| target.kind.iter().any(|k| k == "bench"))
        {
            run_one(package, &bench.name, filter, &results, &mut accuracy)?;
        }
    }
    let times = times_since(&results, start)?;
    let width = times.keys().map(String::len).max().unwrap_or(0);
    println!(
        "\n{:width$}  {:>12}  {:>27}  accuracy",
        "benchmark", "median", "95 % interval"
    );
    for (name, estimate) in &times {
        let [low, high] = estimate.interval;
        let interval = format!("{} – {}", duration(low), duration(high));
        let accuracy = accuracy.get(name).map_or("not stated", String::as_str);
        println!(
            "{name:width$}  {:>12}  {interval:>27}  {accuracy}",
            duration(estimate.median)
        );
    }
    Ok(())
}

/// Runs a bench target; what it says goes on to the terminal.
fn run_one(
    package: &Package,
    bench: &str,
    filter: Option<&str>,
    results: &Path,
    accuracy: &mut BTreeMap<String, String>,
) -> Result<()> {
    let mut command = cargo();
    command.args(["bench", "--package", &package.name, "--bench", bench]);
    // What a feature brings, threads say, is measured too.
    command.arg("--all-features");
    command
        .env("CRITERION_HOME", results)
        .stdout(Stdio::piped());
    if let Some(filter) = filter {
        command.args(["--", filter]);
    }
    let mut child = command.spawn().context("cannot start cargo")?;
    if let Some(output) = child.stdout.take() {
        for line in BufReader::new(output).lines() {
            let line = line?;
            println!("{line}");
            let stated = line
                .strip_prefix("accuracy ")
                .and_then(|rest| rest.split_once(' '));
            accuracy.extend(stated.map(|(name, text)| (name.to_owned(), text.to_owned())));
        }
    }
    ensure!(
        child.wait()?.success(),
        "benchmark `{bench}` of `{}` failed",
        package.name
    );
    Ok(())
}

/// Nanoseconds.
struct Estimate {
    median: f64,
    interval: [f64; 2],
}

/// The results that criterion wrote after `start`, by benchmark.
fn times_since(folder: &Path, start: SystemTime) -> Result<BTreeMap<String, Estimate>> {
    let mut times = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(&folder) else {
            continue;
        };
        for entry in entries {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            }
        }
        let estimates = folder.join("estimates.json");
        let new = fs::metadata(&estimates)
            .and_then(|m| m.modified())
            .is_ok_and(|time| time >= start);
        if new && folder.ends_with("new") {
            times.extend([read_estimate(&folder)?]);
        }
    }
    Ok(times)
}

fn read_estimate(folder: &Path) -> Result<(String, Estimate)> {
    #[derive(Deserialize)]
    struct Benchmark {
        full_id: String,
    }
    #[derive(Deserialize)]
    struct Estimates {
        median: Median,
    }
    #[derive(Deserialize)]
    struct Median {
        point_estimate: f64,
        confidence_interval: Confidence,
    }
    #[derive(Deserialize)]
    struct Confidence {
        lower_bound: f64,
        upper_bound: f64,
    }

    let read = |name: &str| {
        let path = folder.join(name);
        fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
    };
    let benchmark: Benchmark = serde_json::from_str(&read("benchmark.json")?)?;
    let Median {
        point_estimate,
        confidence_interval,
    } = serde_json::from_str::<Estimates>(&read("estimates.json")?)?.median;
    let interval = [
        confidence_interval.lower_bound,
        confidence_interval.upper_bound,
    ];
    Ok((
        benchmark.full_id,
        Estimate {
            median: point_estimate,
            interval,
        },
    ))
}

fn duration(nanoseconds: f64) -> String {
    match nanoseconds {
        n if n < 1e3 => format!("{n:.1} ns"),
        n if n < 1e6 => format!("{:.2} µs", n / 1e3),
        n if n < 1e9 => format!("{:.3} ms", n / 1e6),
        n => format!("{:.3} s", n / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_units() {
        assert_eq!(duration(12.34), "12.3 ns");
        assert_eq!(duration(12_345.0), "12.35 µs");
        assert_eq!(duration(1.5e6), "1.500 ms");
        assert_eq!(duration(2.0e9), "2.000 s");
    }
}
