//! Coloured clouds and their pictures.

use nalgebra::{Point3, Vector3};
use pomona_cloud::PointCloud;
use pomona_view::{
    CloudMark, Projection, RenderOptions, Viewpoint, colored_cloud, palette, render_cloud,
};
use proptest::prelude::*;

#[test]
fn a_pick_is_seen_in_the_picture_of_its_cloud() {
    let mut cloud = PointCloud::default();
    for i in 0..400u16 {
        let (column, row) = (f32::from(i % 20), f32::from(i / 20));
        cloud.x.push((column - 9.5) * 0.01);
        cloud.y.push((row - 9.5) * 0.01);
        cloud.z.push(1.0);
    }
    let surface: Vec<u32> = (200..400).collect();
    let branch: Vec<u32> = (0..40).collect();
    let arrow = Some((Point3::new(0.0, 0.05, 0.9), Point3::new(0.0, -0.08, 0.9)));
    let mut mark = CloudMark::new(&surface, &branch);
    mark.arrow = arrow;
    let painted = colored_cloud(&cloud, &[mark]);
    let projection = Projection::Perspective {
        vertical_angle: 0.3,
    };
    let view = Viewpoint::new(
        Point3::origin(),
        Point3::new(0.0, 0.0, 1.0),
        -Vector3::y(),
        projection,
    )
    .unwrap();
    let mut options = RenderOptions::default();
    (options.width, options.height) = (200, 200);
    options.edge_shading = 0.0;
    let picture = render_cloud(&painted, &view, &options).unwrap();
    for color in [
        palette::SURFACE,
        palette::BRANCH,
        palette::DIRECTION,
        palette::REST,
        options.background,
    ] {
        assert!(
            picture.pixels.iter().filter(|p| **p == color).count() > 100,
            "{color:?}"
        );
    }
    assert_eq!(picture.pixels[100 * 200 + 100], palette::DIRECTION);
}

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![8 => -3.0..3.0f32, 1 => any::<f32>()]
}

proptest! {
    #[test]
    fn no_cloud_panics_and_the_picture_is_the_same_twice(
        points in prop::collection::vec((number(), number(), number()), 0..60),
        indices in prop::collection::vec(0u32..80, 0..20),
        ends in prop::array::uniform6(number()),
        (size, shading) in (0usize..9, -1.0..5.0f64),
        (width, height) in (1usize..80, 1usize..80),
    ) {
        let axis = |pick: fn(&(f32, f32, f32)) -> f32| points.iter().map(pick).collect();
        let cloud = PointCloud::from_coordinates(axis(|p| p.0), axis(|p| p.1), axis(|p| p.2));
        let ends = ends.map(f64::from);
        let arrow = Some((Point3::new(ends[0], ends[1], ends[2]), Point3::new(ends[3], ends[4], ends[5])));
        let mut mark = CloudMark::new(&indices, &indices);
        mark.arrow = arrow;
        let painted = colored_cloud(&cloud, &[mark]);
        prop_assert!(painted.x.iter().chain(&painted.y).chain(&painted.z).all(|c| c.is_finite()));
        prop_assert_eq!(painted.colors.as_ref().map(Vec::len), Some(painted.x.len()));
        let projection = Projection::Orthographic { field_height: 4.0 };
        let eye = Point3::new(0.0, 0.0, -4.0);
        let view = Viewpoint::new(eye, Point3::origin(), Vector3::y(), projection).unwrap();
        let mut options = RenderOptions::default();
        (options.width, options.height) = (width, height);
        (options.point_size, options.edge_shading) = (size, shading);
        let picture = render_cloud(&painted, &view, &options).unwrap();
        prop_assert_eq!(picture.pixels.len(), width * height);
        prop_assert_eq!(render_cloud(&painted, &view, &options).unwrap(), picture);
    }
}
