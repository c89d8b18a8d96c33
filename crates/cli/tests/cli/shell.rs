//! The program among others: help, colours, pipes.

use crate::binary::{pomona, run};
use crate::scene::Bench;
use std::process::{Command, Stdio};

#[test]
fn help_and_version() {
    let version = pomona(&["--version"]).succeeded();
    assert_eq!(
        version.out,
        concat!("pomona ", env!("CARGO_PKG_VERSION"), "\n")
    );
    for command in [
        "pick",
        "detect",
        "scenes",
        "convert",
        "inspect",
        "config",
        "completions",
    ] {
        let help = pomona(&[command, "--help"]).succeeded();
        assert!(
            help.out.contains(&format!("pomona {command} ")),
            "{}",
            help.out
        );
    }
    assert!(pomona(&["--help"]).succeeded().out.contains("Examples:"));
}

#[test]
fn wrong_usage_ends_with_2() {
    for arguments in [
        &["pick"][..],
        &["pick", "a"],
        &["prune"],
        &[],
        &["--threads", "0", "config"],
    ] {
        let run = pomona(arguments);
        assert_eq!((run.code, &*run.out), (2, ""), "{arguments:?}");
        assert!(
            run.err.contains("Usage") || run.err.contains("--help"),
            "{}",
            run.err
        );
    }
}

#[test]
fn colours_only_where_they_are_wanted() {
    let bench = Bench::new();
    let pick = |more: &[&str]| {
        let (frame, out) = (bench.text("a"), bench.text("out"));
        pomona(&[&["pick", &frame, "--out", &out], more].concat())
            .succeeded()
            .out
    };
    assert!(!pick(&[]).contains('\x1b'), "piped");
    assert!(pick(&["--color", "always"]).contains("\x1b[32mpicked"));
    let gone = pomona(&["pick", "gone", "--out", "x", "--color", "always"]);
    assert!(gone.err.starts_with("\x1b["), "{}", gone.err);
}

#[test]
fn the_log_goes_to_standard_error() {
    let bench = Bench::new();
    let (frame, out) = (bench.text("a"), bench.text("out"));
    let log = pomona(&["pick", &frame, "--out", &out, "-v", "--json"]);
    assert!(
        log.err.contains("a: picked in") && !log.err.contains("PaperConfig"),
        "{}",
        log.err
    );
    log.json();
    let more = pomona(&["pick", &frame, "--out", &out, "-vv"]);
    assert!(more.err.contains("PaperConfig"), "{}", more.err);
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pomona"))
        .args(["completions", "bash"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(
        output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn completions_for_every_shell() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = pomona(&["completions", shell]).succeeded().out;
        assert!(
            script.contains("pomona") && script.contains("radius-max-mm"),
            "{shell}"
        );
    }
}

#[test]
fn a_frame_may_be_the_current_folder() {
    let bench = Bench::new();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pomona"));
    command
        .current_dir(bench.path("a"))
        .args(["pick", ".", "--out", ".", "--json"]);
    let here = run(&mut command).succeeded();
    assert_eq!(here.json()["frame"]["id"], "a");
    assert_eq!(bench.read_json("a/picks.json"), here.json());
}
