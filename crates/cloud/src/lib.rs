//! RGB-D frames and point clouds, and the files in which they are stored.
//!
//! ```
//! use pomona_cloud::{
//!     Camera, CloudFormat, ColorImage, DepthImage, DepthPoints, Frame, PixelBox, PointCloud,
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A wall 0.9 m away, seen by a small camera, and a box drawn on it.
//! let camera = Camera::new([64, 48], [60.0, 60.0], [31.5, 23.5]);
//! let color = ColorImage::filled(64, 48, [180, 30, 40]);
//! let depth = DepthImage { width: 64, height: 48, readings: vec![900; 64 * 48] };
//! let mut frame = Frame::new("row-7", camera, color, depth);
//! frame.boxes = Some(vec![PixelBox {
//!     name: "2118".to_owned(),
//!     x_min: 20.0,
//!     y_min: 10.0,
//!     x_max: 30.0,
//!     y_max: 20.0,
//!     score: 1.0,
//! }]);
//!
//! // Written to a folder and read back.
//! # let parent = tempfile::tempdir()?;
//! # let dir = parent.path().join("row-7");
//! frame.write(&dir)?;
//! let frame = Frame::read(&dir)?;
//!
//! // The points of each box, in reused buffers.
//! let mut points = DepthPoints::new();
//! for pixel_box in frame.boxes.iter().flatten() {
//!     let window = pixel_box.window(frame.depth.width, frame.depth.height)?;
//!     points.fill(&frame.depth, &frame.camera, window)?;
//!     assert_eq!(points.len(), 100);
//!     assert_eq!(points.z[0], 0.9);
//! }
//!
//! // The whole frame as an organised, coloured cloud.
//! let cloud = PointCloud::from_frame(&frame)?;
//! cloud.write(dir.join("cloud.ply"), CloudFormat::PlyBinaryLittleEndian)?;
//! assert_eq!(PointCloud::read(dir.join("cloud.ply"))?, cloud);
//! # Ok(())
//! # }
//! ```
//!
//! # Concepts
//!
//! A [`Frame`] is a colour image, a depth image registered to it, their common [`Camera`], and optionally the
//! bounding boxes of the apples. Its folder contains `color.png` (or `.jpg`), `depth.png` (16-bit grey),
//! `camera.json` (or a camera in the form of ROS, OpenCV, Kalibr, Open3D or `RealSense`), and `boxes.xml`, `.json` or `.txt`
//! (VOC, COCO, YOLO and others, see [`read_boxes`]). Of the classes and images in a box file a [`BoxChoice`] and a
//! [`BoxImage`] take those that are meant. [`read_tum`] reads folders of the TUM RGB-D benchmark. A [`CocoDataset`] has the boxes of many
//! images in one file; a [`LabelledBox`] is a box with its class.
//!
//! Lengths are in metres, in the REP-103 optical camera frame: x right, y down, z forward.
//! Depth is z, not range; a depth of 0 is "no reading". Pixel (0, 0) is the centre of
//! the top-left pixel.
//!
//! Points are kept as separate f32 arrays. [`DepthPoints`] are those of a [`PixelWindow`], each with its
//! pixel, with buffers that are reused; a [`PointCloud`] is what files hold, in one of
//! the [`CloudFormat`]s. An organised cloud has a point for every pixel, NaN where there is
//! no reading.
//!
//! Files are untrusted input: a size that a header claims is compared with the size of the file
//! before memory is taken, whatever is wrong is an error that names the file, the
//! place and the remedy ([`CloudError`]), and a file or a new frame folder is written whole or not at all.
//!
//! # Not here
//!
//! Detecting apples; filtering, normals, neighbours and registration of clouds; rectification of images; video and
//! recordings.
//!
//! # References
//!
//! - PCD: <https://pointclouds.org/documentation/tutorials/pcd_file_format.html>
//! - PLY: Greg Turk, The PLY Polygon File Format, 1994.
//! - Camera frame: REP-103; depth images: REP-118.
//! - Distortion: D. C. Brown, Close-range camera calibration, 1971, in the form of OpenCV's `calib3d`.
//! - TUM RGB-D: Sturm et al., A benchmark for the evaluation of RGB-D SLAM systems, 2012,
//!   doi 10.1109/IROS.2012.6385773.

mod boxes;
mod camera;
mod cloud;
mod color;
mod depth;
mod error;
mod folder;
mod formats;
mod frame;
mod gray;
mod image;
mod points;
mod tum;
mod window;

pub use boxes::{
    BoxChoice, BoxError, BoxFormat, BoxImage, ClassChoice, CocoCategory, CocoDataset, CocoImage,
    CocoResult, ImageKey, LabelKind, LabelledBox, PixelBox, read_boxes, read_coco_results,
    read_labels, write_boxes,
};
pub use camera::{Camera, CameraError, CameraOptions, Distortion, ImageKind, Lens};
pub use cloud::PointCloud;
pub use color::ColorImage;
pub use depth::DepthImage;
pub use error::CloudError;
pub use formats::CloudFormat;
pub use frame::{BoxSource, Frame, FrameOptions};
pub use gray::GrayImage;
pub use image::DepthValues;
pub use points::DepthPoints;
pub use pomona_files::{FileError, Warning, WarningCode, WithWarnings};
pub use tum::{TumEntry, read_tum};
pub use window::PixelWindow;
