use crate::binary::pomona;
use crate::scene::Bench;
use pomona_cloud::{Frame, PointCloud};

const FORMATS: [(&str, &str); 7] = [
    ("pcd-ascii", "pcd"),
    ("pcd-binary", "pcd"),
    ("pcd-binary-compressed", "pcd"),
    ("ply-ascii", "ply"),
    ("ply-binary", "ply"),
    ("ply-binary-be", "ply"),
    ("xyz", "xyz"),
];

/// Equal, with NaN equal to itself.
fn same(a: &PointCloud, b: &PointCloud) -> bool {
    let bits = |v: &[f32]| {
        v.iter()
            .map(|c| if c.is_nan() { 0 } else { c.to_bits() })
            .collect::<Vec<_>>()
    };
    let coordinates = |c: &PointCloud| [bits(&c.x), bits(&c.y), bits(&c.z)];
    coordinates(a) == coordinates(b) && a.colors == b.colors && a.size == b.size
}

#[test]
fn a_frame_comes_back_through_every_format() {
    let bench = Bench::new();
    let expected = PointCloud::from_frame(&Frame::read(bench.path("a")).unwrap()).unwrap();
    let mut from = bench.text("a");
    for (format, extension) in FORMATS {
        let to = bench.text(&format!("{format}.{extension}"));
        let run = pomona(&["convert", &from, &to, "--format", format]).succeeded();
        assert!(
            run.out
                .contains("76800 points, organised 320x240, with colours"),
            "{}",
            run.out
        );
        assert!(same(&PointCloud::read(&to).unwrap(), &expected), "{format}");
        from = to;
    }
}

#[test]
fn the_extension_chooses_the_format() {
    let bench = Bench::new();
    bench.write("c.xyz", "0 0 1\n0.5 0 1\n");
    for (name, magic) in [
        ("c.pcd", "# .PCD"),
        ("c.ply", "ply\nformat binary_little_endian"),
    ] {
        pomona(&["convert", &bench.text("c.xyz"), &bench.text(name)]).succeeded();
        assert!(bench.read(name).starts_with(magic.as_bytes()), "{name}");
    }
    // A file may be replaced by itself in another format.
    pomona(&[
        "convert",
        &bench.text("c.ply"),
        &bench.text("c.ply"),
        "--format",
        "ply-ascii",
    ])
    .succeeded();
    assert!(bench.read("c.ply").starts_with(b"ply\nformat ascii"));
}
