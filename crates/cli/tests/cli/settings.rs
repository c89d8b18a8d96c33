use crate::binary::pomona;
use crate::scene::Bench;

#[test]
fn printed_settings_change_nothing() {
    let bench = Bench::new();
    let printed = pomona(&["config"]).succeeded().out;
    bench.write("pomona.toml", &printed);
    let config = bench.text("pomona.toml");
    assert_eq!(
        pomona(&["config", "--config", &config]).succeeded().out,
        printed
    );
    for part in [
        "method = \"robust\"",
        "[paper]",
        "[robust]",
        "radius_max_m = 0.05",
        "Unit: metres",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
}

#[test]
fn flags_win_over_the_file() {
    let bench = Bench::new();
    bench.write(
        "pomona.toml",
        "[fruit]\nradius_max_m = 0.06\n[paper]\nline_iterations = 7\n",
    );
    let config = bench.text("pomona.toml");
    let flags = [
        "config",
        "--config",
        &config,
        "--radius-max-mm",
        "70",
        "--set",
        "paper.shell_outer=2",
    ];
    let out = pomona(&flags).succeeded().out;
    for part in [
        "radius_max_m = 0.07",
        "line_iterations = 7",
        "shell_outer = 2.0",
        "default 3000",
    ] {
        assert!(out.contains(part), "{part}: {out}");
    }
}

#[test]
fn settings_reach_the_method() {
    let bench = Bench::new();
    let run = |radius: &str| {
        let out = bench.text("out");
        let arguments = [
            "pick",
            &bench.text("a"),
            "--json",
            "--out",
            &out,
            "--radius-min-mm",
            radius,
        ];
        pomona(&arguments).succeeded().json()["picks"][0]["status"].clone()
    };
    assert_eq!(run("20"), "picked");
    assert_ne!(run("45"), "picked");
}
