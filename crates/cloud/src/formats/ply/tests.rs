use super::*;

const FACES_FIRST: &str = "ply
format ascii 1.0
comment made by hand
element face 2
property list uchar int vertex_indices
element vertex 2
property double z
property float y
property float x
property uchar red
property uchar green
property uchar blue
property list uchar float weights
end_header
3 0 1 2
4 0 1 2 3
3 2 1 255 128 0 2 0.5 0.5

nan inf .5 1 2 3 0
";

#[test]
fn reads_text_with_faces_lists_any_order_and_odd_numbers() {
    for text in [
        FACES_FIRST.to_owned(),
        FACES_FIRST.replace('\n', "\r\n"),
        FACES_FIRST.replace('\n', "\r"),
    ] {
        let cloud = parse(text.as_bytes()).unwrap();
        assert_eq!((cloud.x[0], cloud.y[0], cloud.z[0]), (1.0, 2.0, 3.0));
        assert!(cloud.x[1] == 0.5 && cloud.y[1].is_infinite() && cloud.z[1].is_nan());
        assert_eq!(cloud.colors.unwrap(), [[255, 128, 0], [1, 2, 3]]);
    }
}

#[test]
fn reads_binary_behind_faces_in_both_orders() {
    for (name, big) in [("binary_big_endian", true), ("binary_little_endian", false)] {
        let header = format!(
            "ply\nformat {name} 1.0\ncomment caf\u{e9}\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 1\nproperty double x\nproperty short y\nproperty float z\nproperty float red\nproperty float green\nproperty float blue\nend_header\n"
        );
        // The comment in Latin-1, as older programs write it.
        let mut bytes: Vec<u8> = header.chars().map(|c| c as u8).collect();
        let order = |le: &[u8]| -> Vec<u8> {
            if big {
                le.iter().rev().copied().collect()
            } else {
                le.to_vec()
            }
        };
        bytes.push(2);
        for index in [0i32, 7] {
            bytes.extend(order(&index.to_le_bytes()));
        }
        bytes.extend(order(&1.5f64.to_le_bytes()));
        bytes.extend(order(&(-2i16).to_le_bytes()));
        for value in [3.0f32, 1.0, 0.5, 0.0] {
            bytes.extend(order(&value.to_le_bytes()));
        }
        let cloud = parse(&bytes).unwrap();
        assert_eq!((cloud.x[0], cloud.y[0], cloud.z[0]), (1.5, -2.0, 3.0));
        assert_eq!(cloud.colors.unwrap(), [[255, 128, 0]]);
    }
}

fn simple(format: &str, count: u64, properties: &str, body: &str) -> String {
    format!("ply\nformat {format} 1.0\nelement vertex {count}\n{properties}end_header\n{body}")
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";

#[test]
fn a_header_that_claims_a_million_million_points_is_refused() {
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for count in [1_000_000_000_000, u64::MAX] {
            let fault = parse(simple(format, count, XYZ, "1 2 3\n").as_bytes()).unwrap_err();
            assert!(fault.problem.contains(&count.to_string()), "{fault:?}");
        }
    }
    let nothing = "ply\nformat ascii 1.0\nelement nothing 1000000000000\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    assert!(
        parse(nothing.as_bytes())
            .unwrap_err()
            .problem
            .contains("`nothing`")
    );
}

#[test]
fn faults_name_the_line_or_the_property() {
    let fault = parse(simple("ascii", 2, XYZ, "1.0 2.0 3.0\n1.0 2.0\n").as_bytes()).unwrap_err();
    assert!(
        fault.place == "line 9" && fault.problem.contains("`z`"),
        "{fault:?}"
    );
    let fault = parse(simple("ascii", 1, XYZ, "1 two 3\n").as_bytes()).unwrap_err();
    assert!(fault.problem.contains("`two`"), "{fault:?}");
    let fault = parse(simple("ascii", 2, XYZ, "1.000 2.000 3.000\n").as_bytes()).unwrap_err();
    assert!(fault.problem.contains("vertex 2 of 2"), "{fault:?}");
    let twice = format!("{XYZ}property float x\n");
    assert!(
        parse(simple("ascii", 0, &twice, "").as_bytes())
            .unwrap_err()
            .problem
            .contains("twice")
    );
    let flat = "property float x\nproperty float y\n";
    assert!(
        parse(simple("ascii", 0, flat, "").as_bytes())
            .unwrap_err()
            .problem
            .contains("`z`")
    );
    assert!(
        parse(b"ply\nformat ascii 1.0\n")
            .unwrap_err()
            .problem
            .contains("end_header")
    );
    assert!(parse(b"ply\nend_header\n").is_err());
    let list_x = XYZ.replace("float x", "list uchar float x");
    assert!(parse(simple("ascii", 0, &list_x, "").as_bytes()).is_err());
}

#[test]
fn a_range_scanner_s_size_is_kept_where_it_fits() {
    let text = simple("ascii", 2, XYZ, "1 2 3\n1 2 3\n");
    let with = |rows: u32| {
        let info = format!("obj_info num_cols 1\nobj_info num_rows {rows}\nelement vertex");
        parse(text.replace("element vertex", &info).as_bytes())
            .unwrap()
            .size
    };
    assert_eq!(with(2), Some((1, 2)));
    assert_eq!(with(3), None);
}

#[test]
fn numbers_are_read_by_words_and_lines_may_break_anywhere_between_elements() {
    let colored = format!("{XYZ}property uchar red\nproperty uchar green\nproperty uchar blue\n");
    let expected = [[255, 0, 7], [1, 128, 254]];
    for body in [
        "0.1 0.2 0.3 \n255 0 7 \n-1.5 2.5 3.5 \n1 128 254 \n",
        "0.1 0.2 0.3 255 0 7 -1.5 2.5 3.5 1 128 254",
        "0.1\n0.2\n0.3\n255\n0\n7\n\n-1.5\t2.5\t3.5\n1 128 254\n",
    ] {
        let cloud = parse(simple("ascii", 2, &colored, body).as_bytes()).unwrap();
        assert_eq!(
            (cloud.x[1], cloud.colors.unwrap()),
            (-1.5, expected.to_vec()),
            "{body:?}"
        );
    }
    // A number that no property stands for is not the next point's.
    for body in ["1 2 3 9\n4 5 6 9\n", "1 2 3\n4 5 6 9\n"] {
        let fault = parse(simple("ascii", 2, XYZ, body).as_bytes()).unwrap_err();
        assert!(
            fault
                .problem
                .contains("more numbers than the properties of vertex: x, y, z"),
            "{fault:?}"
        );
    }
}

#[test]
fn headers_with_tabs_and_capitals_are_read() {
    let text = "PLY\nFORMAT ASCII 1.0\nComment By Hand\nelement\tvertex\t1\nproperty\tFLOAT\tX\nPROPERTY float y\n\
        property float  z\nproperty uchar Red\nproperty uchar Green\nproperty uchar Blue\nend_header\n1\t2\t3\t9\t8\t7\n";
    let cloud = parse(text.as_bytes()).unwrap();
    assert_eq!(
        (cloud.x[0], cloud.z[0], cloud.colors.unwrap()),
        (1.0, 3.0, vec![[9, 8, 7]])
    );
}

#[test]
fn colours_in_floating_point_are_fractions_or_bytes() {
    let colored = format!("{XYZ}property float red\nproperty float green\nproperty float blue\n");
    let colors = |body: &str| {
        parse(simple("ascii", 1, &colored, body).as_bytes())
            .unwrap()
            .colors
            .unwrap()
    };
    assert_eq!(colors("1 2 3 255 0 7\n"), [[255, 0, 7]]);
    assert_eq!(colors("1 2 3 1 0 0.5\n"), [[255, 0, 128]]);
    let one = format!("{XYZ}property float red\n");
    assert_eq!(
        parse(simple("ascii", 1, &one, "1 2 3 4\n").as_bytes())
            .unwrap()
            .colors,
        None
    );
}
