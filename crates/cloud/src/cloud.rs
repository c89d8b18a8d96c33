/// A point cloud in separate coordinate arrays, in metres, as f32.
///
/// All arrays have the same length. An organised cloud (`width` and `height`
/// set, `width * height` points, row by row) keeps pixels without a reading as NaN points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// x coordinates.
    pub x: Vec<f32>,
    /// y coordinates.
    pub y: Vec<f32>,
    /// z coordinates.
    pub z: Vec<f32>,
    /// Colours, as many as points, where the cloud has them.
    pub colors: Option<Vec<[u8; 3]>>,
    /// Width and height of an organised cloud.
    pub size: Option<(usize, usize)>,
}
