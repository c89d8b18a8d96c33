//! Pictures of picks: marks drawn over the colour image, coloured clouds, and rendered
//! pictures of clouds for those without a viewer at hand.
//!
//! ```
//! use nalgebra::Point3;
//! use pomona_cloud::{Camera, ColorImage, PixelBox};
//! use pomona_view::{AppleMark, Overlay};
//!
//! let image = ColorImage { width: 640, height: 480, pixels: vec![[90, 120, 80]; 640 * 480] };
//! let camera = Camera::new([640, 480], [600.0, 600.0], [319.5, 239.5]);
//!
//! let name = String::from("apple");
//! let bounds = PixelBox { name, x_min: 290.0, y_min: 210.0, x_max: 350.0, y_max: 270.0, score: 1.0 };
//! let mut mark = AppleMark::new(1, bounds);
//! // From the apple's centre upwards to the branch.
//! mark.arrow = Some((Point3::new(0.0, 0.0, 0.8), Point3::new(0.0, -0.06, 0.8)));
//! mark.caption = Some("r 36 mm".into());
//!
//! let picture = Overlay::new(&image, &camera).draw(&[mark])?;
//! assert_ne!(picture.pixels, image.pixels);
//! // `picture.write("picks.png")` puts it on the disk.
//! # Ok::<(), pomona_view::ViewError>(())
//! ```
//!
//! # Concepts
//!
//! An [`AppleMark`] holds what is known of one apple: a box, and perhaps the
//! pixels of its surface and branch, its sphere, its picking direction, a
//! gripper's path and the gripper at the apple, a caption, a reason of refusal. [`Overlay`] draws marks over the image;
//! colours are those of the paper ([`palette`]). A picking direction along
//! the line of sight has no length in the picture and is drawn as in physics:
//! ⊙ points towards the camera, ⊗ away from it.
//!
//! [`draw_boxes`] draws only boxes, each a [`BoxMark`], and [`contact_sheet`] arranges such pictures on a contact
//! sheet.
//!
//! An [`Enlargement`] is a part of an image, enlarged, with lines and circles.
//!
//! [`tint`] mixes a colour into pixels, such as those of a mask.
//!
//! [`colored_cloud`] colours the points of a cloud in the same way and adds the direction as points, so that any PLY
//! viewer shows it; [`render_cloud`] renders a cloud from a [`Viewpoint`].
//!
//! Pixels are counted from the centre of the top-left one, which is (0, 0),
//! as [`pomona_cloud::Camera`] does; a box spans whole pixels,
//! `x_min <= x < x_max`. Lengths are metres, angles radians. The same input
//! gives the same picture. Input that cannot be shown is left out of the
//! picture; only an invalid image or viewpoint is a [`ViewError`].
//!
//! # Not here
//!
//! Finding apples, branches and directions: this crate only draws. Files: [`pomona_cloud::ColorImage`] and
//! [`pomona_cloud::PointCloud`] have their own writers.
//!
//! # References
//!
//! Gao, Zhou, Cao, Jiang, *An Algorithm for Calculating Apple Picking Direction
//! Based on 3D Vision*, Agriculture 2022, 12(8), 1170,
//! doi 10.3390/agriculture12081170 (the colours of its figures).

mod arrow;
mod basis;
mod box_picture;
mod boxes;
mod canvas;
mod colored_cloud;
mod enlargement;
mod error;
mod gripper;
mod label;
mod layout;
mod legend;
mod mark;
mod occupancy;
mod overlay;
pub mod palette;
mod points;
mod projection;
mod render;
mod sheet;
mod text;
mod tint;
mod viewpoint;

pub use box_picture::{BoxKind, BoxMark, draw_boxes};
pub use colored_cloud::{CloudMark, colored_cloud};
pub use enlargement::Enlargement;
pub use error::ViewError;
pub use mark::AppleMark;
pub use overlay::Overlay;
pub use render::{RenderOptions, render_cloud};
pub use sheet::{ContactSheetImage, contact_sheet};
pub use tint::tint;
pub use viewpoint::{Projection, Viewpoint};
