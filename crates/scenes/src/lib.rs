//! Synthetic RGB-D frames of apples on branches, with ground truth.
//!
//! ```
//! use pomona_scenes::Suite;
//!
//! // The first of the paper's fifteen lab orientations, in memory.
//! let scene = Suite::named("lab15")?.scenes().next().expect("fifteen of them");
//! let apple = &scene.truth.apples[0];
//! assert_eq!(scene.frame.id, "lab-x-90-s0");
//! assert_eq!(apple.radius, 0.025_78);
//!
//! // Its branch passes behind the apple: the true picking direction is forward.
//! let direction = apple.direction.expect("the lab apple has a branch");
//! assert!((direction[2] - 1.0).abs() < 1e-12);
//!
//! // Or as a folder with color.png, depth.png, camera.json, boxes and truth.json.
//! # let folder = std::env::temp_dir().join(format!("pomona-scenes-doc-{}", std::process::id()));
//! scene.write(&folder)?;
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Concepts
//!
//! - A [`World`] contains objects in the camera frame (x right, y down, z forward; metres): [`Apple`]s, [`Branch`]es
//!   along smooth [`Curve`]s, twigs (which are not branches), [`Leaf`]s, and perhaps a backdrop.
//! - A [`Shot`] takes a [`Scene`] of it: the ray of every pixel stops at the
//!   first surface, so that objects occlude one another; a
//!   [`Sensor`] turns the exact depths into readings.
//! - A [`Truth`] says, for every apple with a box, where it is, which branch is
//!   nearest, in which direction to pick, and how much of apple and branch the
//!   camera sees: enough to decide whether a refusal is right.
//! - A [`Suite`] is a named, reproducible list of scenes: all randomness comes from explicit seeds, and the bytes do
//!   not depend on the number of threads. `lab15` and `lab150` are the paper's laboratory, `repeat474` its repeats
//!   (`-none`, `-light`, `-dense` with fewer or more leaves), `orchard` random branches, `rivals` the same where
//!   thicker branches pass near the right one, `harsh` the orchard with a real sensor's faults (`-kinect`,
//!   `-azure-kinect`, `-d400` with other cameras), `dense` foliage as dense as in real trees, `row` whole trees, `demo` a
//!   demonstration.
//!
//! A scene of your own, seen by a camera without noise:
//!
//! ```
//! use nalgebra::Point3;
//! use pomona_scenes::{Apple, Branch, Curve, Light, Sensor, Shot, World};
//!
//! let mut world = World::new(Light::default());
//! world.add_apple(Apple::sphere(Point3::new(0.0, 0.0, 0.8), 0.04));
//! world.add_branch(Branch {
//!     curve: Curve::straight(Point3::new(-0.2, -0.05, 0.8), Point3::new(0.2, -0.05, 0.8)),
//!     start_radius: 0.006,
//!     end_radius: 0.004,
//! });
//! let scene = Shot::new("own", Shot::paper_camera(), Sensor::perfect(), 0).take(&world);
//! // The central pixel measures the front of the apple: 0.76 m.
//! let reading = scene.frame.depth.get(640, 480).expect("inside the image");
//! assert!((f64::from(reading) * scene.frame.camera.depth_scale - 0.76).abs() < 1e-4);
//! ```
//!
//! # Not here
//!
//! Anything that finds apples: the pipeline is measured by this crate and
//! must stay unknown to it. Lens distortion, motion blur and photographic
//! realism: the colours serve detectors of coloured objects and human viewers.
//!
//! # References
//!
//! - Gao, Zhou, Cao, Jiang 2022, "An Algorithm for Calculating Apple Picking
//!   Direction Based on 3D Vision", Agriculture 12(8), 1170,
//!   doi 10.3390/agriculture12081170: the laboratory set-up and the repeats.

mod apple;
mod attempts;
mod cameras;
mod curve;
mod demo;
mod dense;
mod error;
mod foliage;
mod grow;
mod lab;
mod leaf;
mod light;
mod limb;
mod orchard;
mod random;
mod ray;
mod raycast;
mod repeat;
mod rivals;
mod row;
mod scene;
mod scenery;
mod sensing;
mod sensor;
mod shade;
mod shadow;
mod shot;
mod suite;
mod time_of_flight;
mod truth;
mod visibility;
mod wood_seen;
mod world;

pub use apple::{Apple, Variety};
pub use cameras::Make;
pub use curve::Curve;
pub use dense::Dense;
pub use error::SceneError;
pub use lab::{CameraAxis, Lab, Orientation};
pub use leaf::Leaf;
pub use light::Light;
pub use orchard::Orchard;
pub use repeat::{Density, Repeat};
pub use row::Row;
pub use scene::{CLASSES_FILE, Scene, SceneClass, VisibleWood};
pub use sensor::{Axial, Bias, Dropout, Edges, Sensor, Sunlight, Thin, TimeOfFlight};
pub use shot::Shot;
pub use suite::{Case, Suite};
pub use truth::{AppleTruth, BranchTruth, TRUTH_FILE, TRUTH_SCHEMA, Truth};
pub use world::{Bark, Branch, World};
