//! What is written reads back, in every format and in every shape of cloud.

use super::*;
use pomona_files::FileError;
use proptest::prelude::*;

/// The same numbers, NaN being equal to NaN.
fn assert_same(read: &PointCloud, written: &PointCloud, format: CloudFormat) {
    let bits = |values: &[f32]| -> Vec<Option<u32>> {
        values
            .iter()
            .map(|v| (!v.is_nan()).then(|| v.to_bits()))
            .collect()
    };
    assert_eq!(bits(&read.x), bits(&written.x), "{format:?}");
    assert_eq!(bits(&read.y), bits(&written.y), "{format:?}");
    assert_eq!(bits(&read.z), bits(&written.z), "{format:?}");
    assert_eq!(read.colors, written.colors, "{format:?}");
    assert_eq!(read.size, written.size, "{format:?}");
}

fn any_coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -10.0..10.0f32,
        1 => Just(f32::NAN),
        1 => prop::sample::select(vec![0.0, -0.0, f32::MIN_POSITIVE, f32::MAX, 1e-40, f32::INFINITY]),
    ]
}

fn any_cloud() -> impl Strategy<Value = PointCloud> {
    let sizes = (1..9usize, 2..7usize, any::<bool>(), any::<bool>());
    sizes.prop_flat_map(|(width, height, organised, colored)| {
        let count = width * height;
        let axis = || prop::collection::vec(any_coordinate(), count);
        let colors = prop::collection::vec(any::<[u8; 3]>(), count);
        (axis(), axis(), axis(), colors).prop_map(move |(x, y, z, colors)| PointCloud {
            x,
            y,
            z,
            colors: colored.then_some(colors),
            size: organised.then_some((width, height)),
        })
    })
}

proptest! {
    #[test]
    fn every_format_keeps_points_colours_and_size(cloud in any_cloud()) {
        for format in CloudFormat::ALL {
            let bytes = format_as(&cloud, format).unwrap();
            assert_same(&parse(&bytes, Some(format)).unwrap(), &cloud, format);
        }
    }
}

#[test]
fn an_empty_cloud_reads_back_empty() {
    for format in CloudFormat::ALL {
        for colors in [None, Some(Vec::new())] {
            let empty = PointCloud {
                colors,
                ..PointCloud::new()
            };
            let bytes = format_as(&empty, format).unwrap();
            let back = parse(&bytes, Some(format)).unwrap();
            assert!(back.is_empty() && back.size.is_none(), "{format:?}");
        }
    }
}

#[test]
fn compression_is_read_back_where_it_shrinks_and_where_it_cannot() {
    let count = 20_000;
    let plane = PointCloud {
        x: vec![1.0; count],
        y: vec![2.0; count],
        z: vec![3.0; count],
        ..PointCloud::new()
    };
    let bytes = format_as(&plane, CloudFormat::PcdBinaryCompressed).unwrap();
    assert!(bytes.len() < count, "{} bytes", bytes.len());
    assert_same(
        &parse(&bytes, None).unwrap(),
        &plane,
        CloudFormat::PcdBinaryCompressed,
    );
    let noise = |step: u32| {
        (0..count as u32)
            .map(|i| f32::from_bits(i.wrapping_mul(step) >> 2))
            .collect()
    };
    let noisy = PointCloud {
        x: noise(2_654_435_761),
        y: noise(40_503),
        z: noise(97),
        ..PointCloud::new()
    };
    let bytes = format_as(&noisy, CloudFormat::PcdBinaryCompressed).unwrap();
    assert_same(
        &parse(&bytes, None).unwrap(),
        &noisy,
        CloudFormat::PcdBinaryCompressed,
    );
}

#[test]
fn files_are_recognised_by_content_before_their_names() {
    let dir = tempfile::tempdir().unwrap();
    let mut cloud = PointCloud::new();
    cloud.push(nalgebra::Point3::new(1.0, 2.0, 3.0), Some([1, 2, 3]));
    for format in CloudFormat::ALL {
        let name = if format == CloudFormat::Xyz {
            "cloud.txt"
        } else {
            "cloud.bin"
        };
        let path = dir.path().join(name);
        cloud.write(&path, format).unwrap();
        assert_same(&PointCloud::read(&path).unwrap(), &cloud, format);
    }
    let unknown = dir.path().join("cloud.las");
    std::fs::write(&unknown, b"LASF....").unwrap();
    assert!(
        PointCloud::read(&unknown)
            .unwrap_err()
            .to_string()
            .contains("cloud.las")
    );
    let empty = dir.path().join("cloud.xyz");
    std::fs::write(&empty, b"").unwrap();
    assert!(
        PointCloud::read(&empty)
            .unwrap_err()
            .to_string()
            .contains("an empty file")
    );
    assert!(matches!(
        PointCloud::read(dir.path().join("no.pcd")),
        Err(CloudError::File(FileError::Read { .. }))
    ));
    assert_eq!(
        CloudFormat::from_path("a/b.PLY"),
        Some(CloudFormat::PlyBinaryLittleEndian)
    );
    assert_eq!(CloudFormat::from_path("b"), None);
}

#[test]
fn arrays_of_different_lengths_are_not_written() {
    let base = PointCloud {
        x: vec![0.0; 2],
        y: vec![0.0; 2],
        z: vec![0.0; 2],
        ..PointCloud::new()
    };
    let bad = [
        PointCloud {
            y: vec![0.0],
            ..base.clone()
        },
        PointCloud {
            colors: Some(vec![[0; 3]]),
            ..base.clone()
        },
        PointCloud {
            size: Some((2, 2)),
            ..base.clone()
        },
    ];
    for format in CloudFormat::ALL {
        assert!(bad.iter().all(|cloud| format_as(cloud, format).is_err()));
    }
}
