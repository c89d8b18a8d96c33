use super::*;

fn file(fields: &str, sizes: &str, types: &str, points: u64, kind: &str, body: &[u8]) -> Vec<u8> {
    let header = format!(
        "# .PCD v0.7\r\n# a comment\r\nVERSION 0.7\r\nFIELDS {fields}\r\nSIZE {sizes}\r\nTYPE {types}\r\nWIDTH {points}\r\nHEIGHT 1\r\nPOINTS {points}\r\nDATA {kind}\n"
    );
    [header.as_bytes(), body].concat()
}

#[test]
fn reads_packed_colours_however_they_are_typed() {
    // 0xff8040c0 as an integer; the PCL tutorials' float 4.2108e+06 is 0x4a8080e0.
    for (kind, token, color) in [
        ("U", "4286595264", [0x80, 0x40, 0xc0]),
        ("I", "-8372032", [0x80, 0x40, 0xc0]),
        ("F", "4286595264", [0x80, 0x40, 0xc0]),
        ("F", "4.2108e+06", [0x80, 0x80, 0xe0]),
    ] {
        let body = format!("1 2 3 {token}\n");
        let bytes = file(
            "x y z rgb",
            "4 4 4 4",
            &format!("F F F {kind}"),
            1,
            "ascii",
            body.as_bytes(),
        );
        let cloud = parse(&bytes).unwrap();
        assert_eq!(cloud.colors.unwrap(), [color], "{kind} {token}");
    }
    let body = [
        1.0f32.to_le_bytes(),
        2.0f32.to_le_bytes(),
        3.0f32.to_le_bytes(),
        [0xc0, 0x40, 0x80, 0xff],
    ];
    for kind in ["F F F F", "F F F U"] {
        let bytes = file(
            "x y z rgba",
            "4 4 4 4",
            kind,
            1,
            "binary",
            body.as_flattened(),
        );
        assert_eq!(parse(&bytes).unwrap().colors.unwrap(), [[0x80, 0x40, 0xc0]]);
    }
}

#[test]
fn reads_any_order_of_fields_with_extra_ones_and_doubles() {
    let mut body = Vec::new();
    body.extend(7u16.to_le_bytes());
    body.extend(3.5f64.to_le_bytes());
    body.extend((-2.0f32).to_le_bytes());
    body.extend(1.0f32.to_le_bytes());
    let bytes = file("ring z y x", "2 8 4 4", "U F F F", 1, "binary", &body);
    let cloud = parse(&bytes).unwrap();
    assert_eq!((cloud.x[0], cloud.y[0], cloud.z[0]), (1.0, -2.0, 3.5));
    assert_eq!(cloud.colors, None);
}

#[test]
fn reads_nan_blank_lines_and_carriage_returns() {
    let bytes = file(
        "x y z",
        "4 4 4",
        "F F F",
        2,
        "ascii",
        b"nan NaN -nan\r\n\r\n1e-3 .5 -2.\r\n",
    );
    let cloud = parse(&bytes).unwrap();
    assert!(cloud.x[0].is_nan() && cloud.y[0].is_nan() && cloud.z[0].is_nan());
    assert_eq!((cloud.x[1], cloud.y[1], cloud.z[1]), (0.001, 0.5, -2.0));
}

#[test]
fn a_header_that_claims_a_million_million_points_is_refused() {
    for kind in ["ascii", "binary", "binary_compressed"] {
        let bytes = file(
            "x y z",
            "4 4 4",
            "F F F",
            1_000_000_000_000,
            kind,
            b"12345678901234567890",
        );
        let fault = parse(&bytes).unwrap_err();
        assert!(fault.problem.contains("1000000000000"), "{fault:?}");
    }
    let huge = file("x y z", "4 4 4", "F F F", u64::MAX, "binary", b"");
    assert!(parse(&huge).is_err());
}

#[test]
fn compressed_sizes_that_lie_are_refused() {
    // Two points are 24 bytes; four bytes of LZF cannot hold 3 GB.
    for (points, compressed, raw) in [
        (2, 4, 20),
        (2, 400, 24),
        (250_000_000, 4, 3_000_000_000_u32),
    ] {
        let body = [
            &u32::to_le_bytes(compressed)[..],
            &raw.to_le_bytes(),
            &[0, 1, 0, 1],
        ]
        .concat();
        let bytes = file(
            "x y z",
            "4 4 4",
            "F F F",
            points,
            "binary_compressed",
            &body,
        );
        assert_eq!(parse(&bytes).unwrap_err().place, "compressed data");
    }
}

#[test]
fn faults_name_the_point_or_the_field() {
    let cut = file(
        "x y z",
        "4 4 4",
        "F F F",
        2,
        "ascii",
        b"1.00 2.00 3.00\n1.00\n",
    );
    let fault = parse(&cut).unwrap_err();
    assert!(
        fault.place.contains("point 2 of 2") && fault.problem.contains("`y`"),
        "{fault:?}"
    );
    let word = file("x y z", "4 4 4", "F F F", 1, "ascii", b"1 two 3\n");
    assert!(parse(&word).unwrap_err().problem.contains("`two`"));
    let flat = file("x y", "4 4", "F F", 1, "ascii", b"1 2\n");
    assert!(parse(&flat).unwrap_err().problem.contains("`z`"));
    assert!(
        parse(b"# .PCD v0.7\nVERSION 0.7\n")
            .unwrap_err()
            .place
            .contains("header")
    );
}

#[test]
fn rows_that_do_not_make_up_the_points_are_refused() {
    let bytes = file(
        "x y z",
        "4 4 4",
        "F F F",
        3,
        "ascii",
        b"1 2 3\n1 2 3\n1 2 3\n",
    );
    let text = String::from_utf8(bytes).unwrap();
    let organised = text.replace("WIDTH 3\r\nHEIGHT 1", "WIDTH 1\r\nHEIGHT 3");
    assert_eq!(parse(organised.as_bytes()).unwrap().size, Some((1, 3)));
    let wrong = text.replace("HEIGHT 1", "HEIGHT 2");
    assert!(
        parse(wrong.as_bytes())
            .unwrap_err()
            .problem
            .contains("HEIGHT 2")
    );
}

#[test]
fn separate_channels_are_colours_whatever_their_type() {
    let colors = |types: &str, body: &str| {
        let bytes = file(
            "x y z r g b",
            "4 4 4 4 4 4",
            types,
            1,
            "ascii",
            body.as_bytes(),
        );
        parse(&bytes).unwrap().colors.unwrap()
    };
    assert_eq!(colors("F F F F F F", "1 2 3 1 0 0.5\n"), [[255, 0, 128]]);
    assert_eq!(colors("F F F F F F", "1 2 3 255 0 7\n"), [[255, 0, 7]]);
    assert_eq!(colors("F F F U U U", "1 2 3 255 0 7\n"), [[255, 0, 7]]);
    let range = file("x y z r", "4 4 4 4", "F F F F", 1, "ascii", b"1 2 3 9\n");
    assert_eq!(parse(&range).unwrap().colors, None);
}
