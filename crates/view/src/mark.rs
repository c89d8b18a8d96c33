use nalgebra::Point3;
use pomona_cloud::PixelBox;
use pomona_geometry::{Capsule, Sphere};

/// What is drawn for one apple; everything but number and box may be absent.
///
/// ```
/// use pomona_cloud::PixelBox;
/// use pomona_view::AppleMark;
///
/// let name = String::from("apple");
/// let bounds = PixelBox { name, x_min: 10.0, y_min: 10.0, x_max: 60.0, y_max: 60.0, score: 1.0 };
/// let mut mark = AppleMark::new(7, bounds);
/// mark.refused = Some("no_branch".into());
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AppleMark<'a> {
    /// The apple's number, drawn on its label.
    pub number: usize,
    /// Its box, pixels; the part inside the image is drawn. An inverted box
    /// or one that is not finite is not drawn.
    pub bounds: PixelBox,
    /// Pixels of its surface, each v · width + u; those beyond the image are passed over.
    pub surface_pixels: &'a [u32],
    /// Pixels of its branch, likewise.
    pub branch_pixels: &'a [u32],
    /// Picking direction from the apple's centre O to the foot C on the
    /// branch, metres in the camera's frame. C may be moved outwards for a
    /// longer arrow.
    pub arrow: Option<(Point3<f64>, Point3<f64>)>,
    /// The fitted sphere, metres in the camera's frame.
    pub sphere: Option<Sphere>,
    /// Positions along the gripper's path, metres in the camera's frame.
    pub path: Vec<Point3<f64>>,
    /// The gripper's parts at the apple, likewise.
    pub gripper: Vec<Capsule>,
    /// A short text on the label, such as `r 36 mm`.
    pub caption: Option<String>,
    /// Why the apple was refused; its box is then hatched.
    pub refused: Option<String>,
}

impl AppleMark<'_> {
    /// A mark with only a number and a box.
    pub fn new(number: usize, bounds: PixelBox) -> Self {
        Self {
            number,
            bounds,
            surface_pixels: &[],
            branch_pixels: &[],
            arrow: None,
            sphere: None,
            path: Vec::new(),
            gripper: Vec::new(),
            caption: None,
            refused: None,
        }
    }

    /// The words beside the number: caption, then reason of refusal.
    pub(crate) fn words(&self) -> String {
        let parts = [&self.caption, &self.refused];
        let parts: Vec<&str> = parts.into_iter().flatten().map(String::as_str).collect();
        parts.join(", ")
    }
}
