//! Clouds and documents that are damaged or of another kind.

use crate::binary::{pomona, tree};
use crate::scene::Bench;
use pomona_cloud::{CloudFormat, PointCloud};

fn cloud(points: &[[f32; 3]]) -> PointCloud {
    let axis = |i: usize| points.iter().map(|p| p[i]).collect();
    PointCloud::from_coordinates(axis(0), axis(1), axis(2))
}

const FOUR: [[f32; 3]; 4] = [
    [0.0, 0.0, 1.0],
    [0.1, 0.0, 1.0],
    [0.0, 0.1, 1.0],
    [0.1, 0.1, 1.5],
];

/// Converts the file `name` of `bench` and checks that it is refused and nothing is written.
#[track_caller]
fn convert_refused(bench: &Bench, name: &str, words: &[&str]) {
    let before = tree(bench.root());
    let run = pomona(&["convert", &bench.text(name), &bench.text("out.ply")]);
    run.refused(words);
    assert_eq!(tree(bench.root()), before);
}

#[test]
fn truncated_clouds() {
    let bench = Bench::new();
    for (format, name) in [
        (CloudFormat::PcdAscii, "ascii.pcd"),
        (CloudFormat::PcdBinary, "binary.pcd"),
        (CloudFormat::PcdBinaryCompressed, "compressed.pcd"),
        (CloudFormat::PlyAscii, "ascii.ply"),
        (CloudFormat::PlyBinaryLittleEndian, "little.ply"),
        (CloudFormat::PlyBinaryBigEndian, "big.ply"),
    ] {
        cloud(&FOUR).write(bench.path(name), format).unwrap();
        let bytes = bench.read(name);
        bench.write(name, &bytes[..bytes.len() - 14]);
        convert_refused(&bench, name, &[name]);
        pomona(&["inspect", &bench.text(name)]).refused(&[name]);
    }
}

#[test]
fn headers_that_claim_more_than_there_is() {
    let bench = Bench::new();
    let claim = 1_000_000_000_000_u64;
    for data in ["ascii", "binary", "binary_compressed"] {
        let header = format!(
            "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {claim}\nHEIGHT 1\n\
             VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {claim}\nDATA {data}\n"
        );
        bench.write("big.pcd", header);
        convert_refused(
            &bench,
            "big.pcd",
            &["big.pcd", "this file is cut short or damaged"],
        );
    }
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let header = format!(
            "ply\nformat {encoding} 1.0\nelement vertex {claim}\nproperty float x\nproperty float y\n\
             property float z\nend_header\n"
        );
        bench.write("big.ply", header);
        convert_refused(&bench, "big.ply", &["big.ply", "1000000000000"]);
        pomona(&["inspect", &bench.text("big.ply")]).refused(&["1000000000000"]);
    }
}

#[test]
fn points_that_are_not_finite() {
    let bench = Bench::new();
    let mut holes = cloud(&FOUR);
    holes.x[1] = f32::NAN;
    holes.z[2] = f32::INFINITY;
    holes
        .write(bench.path("holes.pcd"), CloudFormat::PcdBinary)
        .unwrap();
    convert_refused(
        &bench,
        "holes.pcd",
        &["holes.pcd", "2 of 4 points", "index 1", "--drop-nan"],
    );
    let out = bench.text("out.ply");
    pomona(&["convert", &bench.text("holes.pcd"), &out, "--drop-nan"]).succeeded();
    assert_eq!(PointCloud::read(&out).unwrap().len(), 2);

    // In an organised cloud NaN stands for a pixel without a reading.
    holes.z[2] = f32::NAN;
    holes.size = Some((2, 2));
    holes
        .write(bench.path("organised.pcd"), CloudFormat::PcdBinary)
        .unwrap();
    let run = pomona(&["convert", &bench.text("organised.pcd"), &out]).succeeded();
    assert!(
        run.out.contains("organised 2x2, 2 without a reading"),
        "{}",
        run.out
    );
    assert_eq!(PointCloud::read(&out).unwrap().size, Some((2, 2)));

    holes.x.fill(f32::NAN);
    holes
        .write(bench.path("none.pcd"), CloudFormat::PcdBinary)
        .unwrap();
    pomona(&["convert", &bench.text("none.pcd"), &bench.text("x.ply")])
        .refused(&["no point of 4 is finite"]);
}

#[test]
fn empty_clouds() {
    let bench = Bench::new();
    for (format, name) in [
        (CloudFormat::PcdBinary, "empty.pcd"),
        (CloudFormat::PlyAscii, "empty.ply"),
        (CloudFormat::Xyz, "empty.xyz"),
    ] {
        cloud(&[]).write(bench.path(name), format).unwrap();
        convert_refused(&bench, name, &[name, "empty"]);
        bench.write(name, "");
        convert_refused(&bench, name, &[name, "empty"]);
    }
}

#[test]
fn targets_that_cannot_be_written() {
    let bench = Bench::new();
    cloud(&FOUR)
        .write(bench.path("c.pcd"), CloudFormat::PcdBinary)
        .unwrap();
    let run = |out: &str| pomona(&["convert", &bench.text("c.pcd"), &bench.text(out)]);
    run("c.las").refused(&["c.las", "--format"]);
    run("a").refused(&["--format"]);
    run("nowhere/c.ply").refused(&["nowhere", "check that the folder exists"]);
    pomona(&["convert", &bench.text("gone.pcd"), &bench.text("c.ply")])
        .refused(&["gone.pcd", "check the path"]);
}

#[test]
fn documents_of_the_wrong_schema() {
    let bench = Bench::new();
    for (name, content, words) in [
        (
            "p.json",
            r#"{"schema": "pomona.picks/2"}"#,
            &["pomona.picks/2", "pomona.picks/1"][..],
        ),
        (
            "p.json",
            r#"{"schema": "pomona.picks/1", "picks": 3}"#,
            &["p.json"],
        ),
        (
            "p.json",
            r#"{"schema": "pomona.truth/1"}"#,
            &["p.json", "apples"],
        ),
        ("p.json", r#"{"schema": "pomona.transform/1"}"#, &["p.json"]),
        ("p.json", r#"{"schema": 7}"#, &["p.json", "schema"]),
        ("p.json", "[1, 2", &["p.json"]),
        ("p.json", r#"{"hello": 1}"#, &["p.json"]),
        ("p.toml", "colour = 1", &["p.toml", "colour"]),
        (
            "p.bin",
            "what is this",
            &["p.bin", "not a file that this program knows"],
        ),
    ] {
        bench.write(name, content);
        let run = pomona(&["inspect", &bench.text(name), "--json"]);
        assert_eq!((run.code, &*run.out), (2, ""), "{content}: {}", run.err);
        for word in words {
            assert!(run.err.contains(word), "{content}: {}", run.err);
        }
    }
}
