//! Clouds that other programs wrote: pypcd4 1.5 and plyfile 1.1, the latter with faces before the vertices.

use pomona_cloud::PointCloud;
use std::path::Path;

/// Every file begins with these points; those of pypcd4 have a third.
const POINTS: [[f32; 3]; 3] = [[1.5, 2.0, 3.25], [f32::NAN, 1.0, 2.0], [1e-7, 5.0, 6.0]];
const COLORS: [[u8; 3]; 3] = [[255, 128, 7], [0, 0, 0], [1, 2, 3]];

#[test]
fn clouds_of_other_programs_read_alike() {
    for (name, count) in [
        ("pypcd4_binary.pcd", 3),
        ("pypcd4_binary_compressed.pcd", 3),
        ("plyfile_ascii.ply", 2),
        ("plyfile_little_endian.ply", 2),
        ("plyfile_big_endian.ply", 2),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("tests/data")
            .join(name);
        let cloud = PointCloud::read(path).unwrap();
        assert_eq!((cloud.len(), cloud.size), (count, None), "{name}");
        assert_eq!(cloud.colors.as_deref(), Some(&COLORS[..count]), "{name}");
        for (i, [x, y, z]) in POINTS.iter().take(count).enumerate() {
            assert!(
                cloud.x[i] == *x || (cloud.x[i].is_nan() && x.is_nan()),
                "{name}"
            );
            assert_eq!((cloud.y[i], cloud.z[i]), (*y, *z), "{name}");
        }
    }
}
