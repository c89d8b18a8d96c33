use crate::binary::{pomona, tree};
use crate::scene::Bench;
use pomona_cloud::Frame;
use pomona_scenes::Suite;

#[test]
fn suites_and_their_scenes_are_listed() {
    let run = pomona(&["scenes", "--list"]).succeeded();
    assert_eq!(run.out.lines().count(), Suite::ALL.len());
    for suite in Suite::ALL {
        assert!(run.out.contains(suite.name()), "{}", run.out);
    }
    let lab = pomona(&["scenes", "lab15", "--list"]).succeeded();
    assert_eq!(lab.out.lines().count(), 15);
    let again = pomona(&["scenes", "lab15", "--list", "--seed", "3", "--count", "2"]).succeeded();
    assert_eq!(again.out, "lab-x-90-s3\nlab-x-45-s3\n");
}

#[test]
fn scenes_are_written_and_never_over_other_things() {
    let bench = Bench::new();
    let out = bench.text("scenes");
    let write = || pomona(&["scenes", "lab15", "--count", "1", "--out", &out]);
    write().succeeded();
    let folder = "scenes/lab-x-90-s0";
    let frame = Frame::read(bench.path(folder)).unwrap();
    assert_eq!(
        (frame.id.as_str(), frame.boxes.unwrap().len()),
        ("lab-x-90-s0", 1)
    );
    let first = bench.read("scenes/lab-x-90-s0/depth.png");
    write().succeeded();
    assert_eq!(bench.read("scenes/lab-x-90-s0/depth.png"), first);

    std::fs::remove_dir_all(bench.path(folder)).unwrap();
    std::fs::create_dir(bench.path(folder)).unwrap();
    bench.write("scenes/lab-x-90-s0/thesis.txt", "mine");
    write().refused(&[
        "lab-x-90-s0",
        "thesis.txt",
        "is not part of a scene and would be lost",
    ]);
    assert_eq!(tree(&bench.path("scenes")).len(), 2);
    pomona(&["scenes", "orchards", "--out", &out]).refused(&["orchards", "lab15", "demo"]);
    assert_eq!(pomona(&["scenes", "demo"]).code, 2);
}
